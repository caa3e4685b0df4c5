// Points that somebody measured, as a scene names them in its block `measured`, and what of a cloth they are
// held against.
//
//     const MeasuredReading reading = read_measured(scene);
//     if (!reading.problems.empty()) ...  // place, value and rule, the file's line too
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "cloth/cloth_system.h"
#include "params/problem.h"
#include "scene/scene.h"

namespace cloth {

enum class MeasuredKind {
  profile,  ///< points of a line of particles
  history,  ///< a quantity at times
  value     ///< a quantity, once
};

struct MeasuredData {
  MeasuredKind kind = MeasuredKind::value;
  std::array<bool, 3> has_axis{};  ///< which of x, y and z the points have
  std::vector<Vec3> points;        ///< m, of a profile; 0 along an axis that the file does not have
  std::vector<double> times;       ///< s, ascending, of a history
  std::vector<double> values;      ///< of a history or a value
};

struct MeasuredReading {
  MeasuredData data;
  std::vector<Problem> problems;
};

/// The file of scene.measured, and whether the scene has what it is about. Preconditions: scene.measured is
/// there, and find_problems(scene) is empty.
MeasuredReading read_measured(const Scene& scene);

/// That file. Precondition: scene.measured is there.
std::filesystem::path measured_path(const Scene& scene);

/// "top-row", "middle-row", ..., "right-column".
const std::vector<std::string>& measured_lines();
bool is_line(const std::string& output);

/// The particles of a line from left to right or from top to bottom, m; in the middle between two rows or
/// columns where none is in the middle of the sheet.
std::vector<Vec3> points_of_line(const std::string& line, const ClothSystem& system,
                                 const Vec3Field& position);

/// The line's length at rest, m.
double length_of_line(const std::string& line, const ClothSheet& cloth);

}  // namespace cloth
