// The points of a sweep, numbered from 0 by a pure function of the plan: of a grid the last axis goes
// fastest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/design.h"
#include "scene/scene_parameters.h"
#include "sweep/sweep_plan.h"

namespace cloth {

/// A parameter of a plan's scene by its path, looked up once; "springs.*" is all stiffnesses in proportion.
class SweptParameter {
 public:
  /// Nothing where the scene has no such parameter, or none that can be varied.
  static std::variant<SweptParameter, Problem> find(const Scene& scene, const std::string& path);

  /// How it is called, its unit and its range.
  const ParameterInfo& info() const { return info_; }

  /// A problem where the value breaks the parameter's own rule: the scene is then as it was.
  std::optional<Problem> set(Scene& scene, const ParameterValue& value) const;

 private:
  std::string path_;
  ParameterInfo info_;
  std::optional<Parameter> parameter_;  ///< none: all stiffnesses
};

/// The rule that the number of samples breaks, of a plan whose design is a sample.
std::optional<Problem> broken_sample(const SweepPlan& plan);

/// The points of a plan whose design is a sample, on the unit cube: a row for each point, a column for each
/// axis. Empty for grids and tables. Precondition: no broken_sample.
UnitPoints unit_points(const SweepPlan& plan);

/// How many points there are.
std::int64_t point_count(const SweepPlan& plan);

class SweepPoints {
 public:
  /// Precondition: the plan was read without problems, and outlives this.
  explicit SweepPoints(const SweepPlan& plan);

  std::int64_t count() const { return count_; }

  /// A value for each path of the plan.
  std::vector<ParameterValue> values(std::int64_t point) const;

  /// The scene of a point, or the problems because of which it cannot be run.
  SceneReading scene(std::int64_t point) const;

 private:
  ParameterValue value(const SweepAxis& axis, std::size_t path, std::size_t of_plan, double unit) const;

  const SweepPlan* plan_;
  std::int64_t count_ = 0;
  std::vector<SweptParameter> parameters_;  ///< of each path
  UnitPoints samples_;                      ///< of a design that is a sample
};

/// A problem where an output is of something that the record of the first point's scene does not have. It
/// assembles that scene.
std::optional<Problem> unknown_output(const SweepPlan& plan);

/// As tables have it: numbers with 17 digits, the components of a vector with spaces between them.
std::string csv_value(const ParameterValue& value);

}  // namespace cloth
