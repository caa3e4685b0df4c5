// The axis of a study: one numeric parameter of a scene and the values it takes.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "params/problem.h"
#include "report/axis.h"
#include "scene/scene.h"

namespace cloth {

inline constexpr const char* time_step_path = "integrator.time_step";

/// Not a parameter of the scene file: the structural stiffness in N/m, with shear and flexion kept in the
/// scene's own ratio to it.
inline constexpr const char* all_stiffnesses_path = "springs.*";

struct StudyAxis {
  std::string path{};
  double low = 0, high = 0;
  int count = 2;
  AxisScale scale = AxisScale::linear;
};

inline constexpr int max_axis_values = 1000;

/// "springs.structural=10:1000:12:log"; the scale may be left out: linear. `option` is the place of a
/// problem.
std::variant<StudyAxis, Problem> parse_axis(const std::string& text, const std::string& option);

/// Ascending, both ends exactly; a logarithmic axis in equal ratios.
std::vector<double> values_of(const StudyAxis& axis);

/// Label and unit as the parameter declares them; the scale is the axis' own.
Axis plot_axis(const StudyAxis& axis, const Scene& scene);

/// Sets the parameter at `path`, whole numbers rounded, or says which rule the value breaks. Rules between
/// parameters are find_problems().
std::optional<Problem> set_number(Scene& scene, const std::string& path, double value,
                                  const std::string& option);

}  // namespace cloth
