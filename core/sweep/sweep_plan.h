// A sweep: one scene run at many points of its parameters, and what is kept of each run. The plan is a value,
// read from a file (*.sweep.json) and written whole into the sweep's folder.
//
//     { "format": "clothlab/sweep/1", "scene": "corners-free", "set": { "duration": 0.2 },
//       "vary": [ { "path": "springs.structural", "from": 50, "to": 200, "count": 4, "scale": "log" },
//                 { "paths": ["springs.shear", "springs.flexion"], "values": [[10, 1], [20, 2]] } ],
//       "design": "grid", "seed": 1,
//       "outputs": [ { "name": "peak", "of": "max_strain", "reduce": "max" } ],
//       "limits": { "wall_s": 60 } }
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "report/axis.h"
#include "scene/scene_json.h"
#include "study/run_output.h"

namespace cloth {

inline constexpr const char* sweep_format = "clothlab/sweep/1";

/// One parameter, or several that take their values together: those of a list, or a range.
struct SweepAxis {
  std::vector<std::string> paths{};
  std::vector<std::vector<ParameterValue>> values{};  ///< of a list: rows with a value for each path
  std::vector<double> from{}, to{};                   ///< of a range: of each path
  int count = 0;                                      ///< of a range in a grid: values from end to end
  AxisScale scale = AxisScale::linear;                ///< of a range

  bool is_list() const { return !values.empty(); }
};

/// `grid`: every combination; `points`: the rows of a table, which are one axis; the others take a sample of
/// the ranges.
enum class SweepDesign { grid, points, latin_hypercube, sobol, saltelli, morris };
const std::vector<std::string>& sweep_design_names();
const std::string& name_of(SweepDesign design);

/// 0: no limit.
struct SweepLimits {
  std::int64_t steps = 0;
  double wall = 0;  ///< s
};

struct SweepPlan {
  std::string title{};
  Scene scene{};  ///< with what "set" changes
  std::vector<SweepAxis> axes{};
  SweepDesign design = SweepDesign::grid;
  /// Points of latin-hypercube and sobol, base points of saltelli, trajectories of morris.
  std::int64_t samples = 0;
  std::uint64_t seed = 1;
  std::vector<RunOutput> outputs{};
  SweepLimits limits{};
};

/// More points than this are refused.
inline constexpr std::int64_t most_sweep_points = 10'000'000;

/// A plan, or why there is none: exactly one of the two is there.
struct SweepReading {
  std::optional<SweepPlan> plan{};
  std::vector<Problem> problems{};
};

/// `place` names the text in messages. Its folder is that of the files which the plan names, if no other is
/// given: scene, points, measured curves.
SweepReading read_sweep(const std::string& text, const std::string& place,
                        const std::optional<std::filesystem::path>& folder = {});

/// The whole plan: scene, points and measured curves in full, with numbers that read back to the same bits.
/// A plan for a folder goes through moved_to_folder() first.
std::string write_sweep(const SweepPlan& plan);

/// JSON Schema (draft 7) of the file.
std::string sweep_schema();

/// Of write_sweep and of what is in the scene's meshes: 16 hexadecimal digits.
std::string plan_hash(const SweepPlan& plan);

/// The paths of all axes, in their order.
std::vector<std::string> paths_of(const SweepPlan& plan);

}  // namespace cloth
