// Materials against exact solutions: strips at rest, the loads at which they buckle, how they swing; and
// against what was published of fabrics: how they drape. Every protocol is taken on four grids, so that its
// error and its order in the cells are seen.
//
//     validate(validation_rows({"cantilever"}), [&](ValidationRow row) { rows.push_back(std::move(row)); });
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/shard.h"
#include "study/study_progress.h"
#include "study/validation/strip.h"

namespace cloth {

/// Of a drape, beside its coefficient.
struct DrapeFacts {
  int folds = 0;
  double amplitude = 0;    ///< m, of the folds
  double cells_above = 0;  ///< part of the cells that lock, see measure/oblique_locking.h
};

/// Along the strip.
inline constexpr std::array validation_cells{10, 20, 40, 80};

/// What one grid gives.
struct ValidationValue {
  int cells = 0;
  double value = 0;
  double error = 0;  ///< relative to the exact value
  /// Root mean square over the particles of how far they are from the exact curve at their arc, in the
  /// strip's length; 0: no curve.
  double distance = 0;
  double seconds = 0;  ///< on the clock
  std::optional<DrapeFacts> drape{};
};

/// What was published of such cloths; one value: both are that.
struct ValueBand {
  double low = 0, high = 0;
  bool holds(double value) const { return value >= low && value <= high; }
};

/// One of several rests of the same cloth on the same grid.
struct SeedValue {
  std::uint64_t seed = 0;  ///< of the random disturbance that it was found from
  double value = 0;
  DrapeFacts drape{};
};

/// Of an error with 20 cells of at most one per cent, with an order in the cells from 1.8 to 2.2 or without
/// one; or of no error but rounding's on any grid.
enum class Promise { none, error, second_order, exact };
inline constexpr double most_rounding = 1e-9;  ///< relative

struct ValidationRow {
  std::string protocol{};        ///< "cantilever"
  std::string parameter_name{};  ///< "Gamma"; empty: the protocol has none
  double parameter = 0;
  std::string parameter_text{};  ///< in its place: "cotton-broad"
  std::string quantity{};        ///< in words, with its unit
  std::string source{};          ///< author and year of the exact value
  std::string method{};          ///< how the grids' values are found, and the step
  double exact = 0;
  /// In place of an exact value where there is none; a band without a promise.
  std::optional<ValueBand> band{};
  bool is_measured = false;  ///< there is no exact value, whether or not there is a band
  StripCurve curve{};        ///< exact; no points: none
  Promise promise = Promise::second_order;
  std::vector<Eigen::Vector2d> shown{};  ///< points found with 20 cells, in the strip's length; may be empty
  std::vector<int> cells{};              ///< of the grids that it is to be measured on
  std::vector<ValidationValue> grids{};  ///< from coarse to fine, those of strips with twice the cells
  std::vector<SeedValue> seeds{};        ///< other rests on the grid of `seed_cells`
  int seed_cells = 0;
  std::string failure{};  ///< where a value could not be found

  /// From the finest two grids' distances from the curve, and where there is no curve from their errors;
  /// not a number where these change their sign, and where no order is promised. Where there is no exact
  /// value: from the finest three grids, not a number where they do not converge.
  double order() const;
  double seconds() const;  ///< that its grids took on the clock
  /// Nothing failed, and what is promised is so.
  bool holds() const;
};

/// "cantilever", "astm", "heart-loop", ... in the order of the table: those with exact solutions, which take
/// minutes, or all, which take many more.
std::vector<std::string> exact_protocols();
std::vector<std::string> validation_protocols();

/// The rows of these protocols with their exact values, not measured yet.
std::vector<ValidationRow> validation_rows(const std::vector<std::string>& protocols);

/// Measures these rows; each `row` as it is done. False where it was stopped.
bool validate(std::vector<ValidationRow> rows, const std::function<void(ValidationRow)>& row,
              const StopTest& stop = {});

/// Protocols, and what was measured of their rows so far.
struct ValidationStudy {
  std::vector<std::string> protocols;
  std::vector<ValidationRow> expected;  ///< all rows, not measured
  std::vector<ValidationRow> rows;      ///< those that were measured, in this order
  bool is_complete() const { return rows.size() == expected.size(); }

  /// In `expected`; its size where it is not there.
  std::int64_t number_of(const ValidationRow& row) const;
};

struct ValidationOptions {
  std::vector<std::string> protocols{};                  ///< empty: exact_protocols()
  int jobs = 1;                                          ///< rows at once; no bit depends on it
  std::function<bool(const StudyProgress&)> progress{};  ///< false stops the study
  /// The study so far, after every row, from one thread at a time.
  std::function<void(const ValidationStudy&)> partial{};
  StopTest stop{};  ///< asked between steps and iterations; half a row is none
  /// The same study, not whole: its rows are not measured again.
  const ValidationStudy* earlier = nullptr;
  Shard shard{};  ///< whose rows are measured alone, by their place in `expected`
};

/// The study without its rows' values, and with them. Precondition: all protocols are known.
ValidationStudy plan_validation(const ValidationOptions& options);
ValidationStudy run_validation(const ValidationOptions& options);

/// The strip of 20 cells that a row is taken of, straight, with a method that takes long steps; nothing where
/// it is another thing, or would have to start bent, between two clamps.
std::optional<Scene> scene_of(const ValidationRow& row);

/// "heart-loop-50": of its files, and of no other row of a study.
std::string name_of(const ValidationRow& row);

}  // namespace cloth
