// A comparison is a value: a scene, and two to four panes that run it side by side, each with values of its
// own where it differs.
//
//     Comparison comparison{.scene = builtin_scene("corners-free")};
//     comparison.panes = panes_for({"verlet", "rk4"});
//     Scene right = scene_of(comparison, 1);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "params/problem.h"
#include "scene/scene.h"

namespace cloth {

inline constexpr std::size_t least_panes = 2, max_panes = 4;

/// The names that panes have, in the order in which they are given. A pane keeps its name, and with it its
/// colour and marker, when others go.
inline constexpr const char* pane_names[max_panes] = {"A", "B", "C", "D"};

/// The value that one parameter has in one pane.
struct OwnValue {
  std::string path;  ///< dotted, of a parameter that the pane's scene has
  ParameterValue value;
  bool operator==(const OwnValue&) const = default;
};

struct Pane {
  std::string name;           ///< one of pane_names; files and tables call the pane by it
  std::string title;          ///< for people; empty: the method's title
  std::vector<OwnValue> own;  ///< each path once; all other parameters are shared
  bool operator==(const Pane&) const = default;
};

/// What errors are measured against, unless it is the name of a pane: the shared scene under error control
/// (see controlled_scenes), or nothing.
inline constexpr const char* controlled_reference = "controlled";
inline constexpr const char* no_reference = "none";

struct Comparison {
  std::string title;  ///< empty: the scene's
  Scene scene;        ///< what all panes share
  std::vector<Pane> panes;
  std::string reference = controlled_reference;
  bool operator==(const Comparison&) const = default;
};

/// One pane for each method, A, B, ..., with nothing else of its own. At most four.
std::vector<Pane> panes_for(const std::vector<std::string>& methods);

/// A scene as a comparison of one pane, A, which no file describes: the window's document of a scene.
Comparison comparison_of_one(Scene scene, const std::string& reference = controlled_reference);
/// Whether it is such a one.
inline bool is_scene(const Comparison& comparison) {
  return comparison.panes.size() == 1;
}

/// The shared scene with the pane's own values. A value for a parameter that the scene lacks is left out.
Scene scene_of(const Comparison& comparison, std::size_t pane);

/// What runs as the controlled reference, and what it is checked by: the shared scene by Dormand-Prince under
/// a tolerance of 1e-11 of the cloth's diagonal for each inner step, and of 1e-10. Where a limiter or contact
/// is at work, the motion is defined by the loop that projects at the end of each step: Verlet, then, with an
/// eighth of the shortest step of the panes and of Verlet's own stable step, and with twice that; a limiter's
/// tolerance is 1e-6 at most. The steps divide the record interval.
struct ControlledScenes {
  Scene reference, check;
};
ControlledScenes controlled_scenes(const Comparison& comparison);

/// "the pane's title", or the method's.
std::string title_of(const Comparison& comparison, std::size_t pane);

/// Index of the pane of this name.
std::optional<std::size_t> find_pane(const Comparison& comparison, const std::string& name);

/// 0 for A, 1 for B, ...: colour and marker by style_of_series(style_of(pane)), everywhere.
int style_of(const Pane& pane);

// --- What is shared and what is own ---

/// The rule against a value of the pane's own at `path`, or nothing: particles must stand for each other
/// (rows, columns), pins act on all panes, and rows of the recordings belong together (duration, interval).
std::optional<std::string> must_be_shared(const std::string& path);

/// The pane's own value, if it has one.
const ParameterValue* own_value(const Pane& pane, const std::string& path);

/// Paths that are own in one pane or more, each once, in the order of a form.
std::vector<std::string> own_paths(const Comparison& comparison);

/// Gives the pane a value of its own. Precondition: must_be_shared(path) is empty.
void set_own(Pane& pane, const std::string& path, ParameterValue value);

/// Takes the pane's own value away: it has the shared one again.
void set_shared(Pane& pane, const std::string& path);

/// Sets the shared value; panes that have their own keep it. A parameter that the shared scene has.
void set_shared_value(Comparison& comparison, const std::string& path, const ParameterValue& value);

/// The same comparison for a file in another folder: files, own ones too, are named as seen from there.
Comparison moved_to_folder(const Comparison& comparison, const std::string& folder);

/// The files that meshes of the shared scene and of the panes were read from, each once.
std::vector<std::string> mesh_files(const Comparison& comparison);

// --- Panes ---

/// A copy of the pane under the first free name, after it; its index. Precondition: less than four panes.
std::size_t duplicate_pane(Comparison& comparison, std::size_t pane);

/// A reference that goes with its pane becomes the controlled one. Precondition: more than one pane.
void remove_pane(Comparison& comparison, std::size_t pane);

/// What is wrong with it. Paths are those of the file: "scene.springs.shear",
/// "panes.1.own.integrator.method".
std::vector<Problem> find_problems(const Comparison& comparison);

/// Of panes whose cloth starts where contact cannot begin; see start_check.h. Precondition: find_problems()
/// is empty.
std::vector<Problem> find_start_problems(const Comparison& comparison);

/// Whether a running comparison can go on as `after` (see LockStep::edit), or must start anew: where a
/// parameter needs it, a new pane is no copy of the one before it, or the reference is one that has not run
/// so far.
bool acts_at_once(const Comparison& before, const Comparison& after);

}  // namespace cloth
