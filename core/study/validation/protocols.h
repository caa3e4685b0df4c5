// The protocols of the validation: what each expects, and how it is measured on one grid.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/validation/validation.h"

namespace cloth {

struct ValidationReading {
  double value = 0;
  double distance = 0;  ///< as ValidationValue has it
  std::string failure{};
  std::vector<Eigen::Vector2d> points{};  ///< beside the row's curve
  std::optional<DrapeFacts> drape{};
};

struct ValidationProtocol {
  std::string name;
  std::string parameter_name;  ///< empty: none
  std::vector<double> parameters;
  std::function<ValidationRow(double parameter)> expect;  ///< all but the name, the parameter and the grids
  /// Asks `stop` often; after true what it returns is worth nothing.
  std::function<ValidationReading(const ValidationRow& row, int cells, const StopTest& stop)> measure;
  std::vector<int> cells{validation_cells.begin(), validation_cells.end()};
  /// Other rests on the row's seed_cells, where it has some; false where it was stopped.
  std::function<bool(ValidationRow& row, const StopTest& stop)> measure_seeds = nullptr;
  /// Where there is a curve: the strip, and how the value is read off points from its first end to its last,
  /// in its length; null: it cannot be.
  std::function<StripCase(double parameter, int cells)> strip = nullptr;
  double (*value)(const std::vector<Eigen::Vector2d>& points) = nullptr;
};

const ValidationProtocol* find_protocol(const std::string& name);

/// In the order of the table.
const std::vector<ValidationProtocol>& protocols();

/// Shapes of strips at rest; loads at which they buckle; what moves or pushes; what shears; how fabrics
/// drape.
std::vector<ValidationProtocol> shape_protocols();
std::vector<ValidationProtocol> buckling_protocols();
std::vector<ValidationProtocol> force_protocols();
std::vector<ValidationProtocol> shear_protocols();
std::vector<ValidationProtocol> drape_protocols();

}  // namespace cloth
