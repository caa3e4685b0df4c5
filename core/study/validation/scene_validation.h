// A scene against points that somebody measured: on its own grid and on refined ones, at rest or at its end.
//
//     const MeasuredReading reading = read_measured(scene);                       // no problems
//     SceneValidation study = plan_scene_validation("flag.scene.json", scene, reading.data);
//     run_scene_validation(study);
//     study.order(), study.holds()
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study_progress.h"
#include "study/validation/measured_points.h"

namespace cloth {

/// What one grid gives.
struct MeasuredRun {
  int cells = 0;              ///< across; 0: a mesh
  int rows = 0, columns = 0;  ///< particles
  double time_step = 0;       ///< s; 0: a rest
  std::string failure{};      ///< why there is nothing to compare
  /// Of a profile the root mean square distance of the measured points from the line, m; of a history the
  /// value at the last measured time; else the value.
  double value = 0;
  /// Of a profile that distance over the line's length, of a history the root mean square difference over the
  /// largest measured value, else the difference over the measured value.
  double error = 0;
  double largest = 0;                     ///< of a point, likewise
  std::vector<Vec3> line{};               ///< m, the particles of a profile
  std::vector<double> times{}, values{};  ///< of a history or value, as recorded
};

struct SceneValidation {
  std::string name;  ///< as it was asked for
  Scene scene;
  MeasuredData data;
  std::vector<int> cells;           ///< of the grids, ascending
  std::string one_grid{};           ///< why there are no others
  std::vector<MeasuredRun> runs{};  ///< as far as they were made

  int own_cells() const { return scene.cloth.columns - 1; }
  bool is_complete() const { return runs.size() == cells.size(); }
  /// In the cells, from the last three grids: how fast what they give, not its error, settles. Not a number
  /// where it does not.
  double order() const;
  /// Complete, nothing failed, and on the scene's own grid and every finer one the error is within the
  /// tolerance.
  bool holds() const;
};

/// What keeps these grids from being taken; empty `cells`: half of the scene's own where that has its pins,
/// its own, and finer ones up to four in all.
std::vector<Problem> find_grid_problems(const Scene& scene, const std::vector<int>& cells);
/// Precondition: no problems of the grids.
SceneValidation plan_scene_validation(const std::string& name, const Scene& scene, MeasuredData data,
                                      const std::vector<int>& cells = {});

struct SceneValidationOptions {
  int threads = 1;                                       ///< that a step may use; no bit depends on it
  std::function<bool(const StudyProgress&)> progress{};  ///< false stops
  StopTest stop{};
};

/// Makes the runs that it lacks.
void run_scene_validation(SceneValidation& study, const SceneValidationOptions& options = {});

}  // namespace cloth
