#include "study/refined_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "contact/start_check.h"
#include "scene/scene_checks.h"
#include "scene/scene_parameters.h"
#include "simulation/memory_estimate.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

/// Particles from the first row and column to the last ones, all of them.
struct Region {
  int first_row, last_row, first_column, last_column;
};

/// Which particles of a grid are pinned.
class PinnedGrid {
 public:
  explicit PinnedGrid(const ClothSheet& cloth)
      : rows_(cloth.rows),
        columns_(cloth.columns),
        pinned_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_)) {
    ClothSheet whole = cloth;
    whole.cut = "none";  // so that a particle's number says its row and column
    for (const int particle : pinned_particles(whole)) pinned_[static_cast<std::size_t>(particle)] = true;
  }

  /// The regions that the pins fill; nullopt where particles that touch fill none, one of which is `odd`.
  std::optional<std::vector<Region>> regions(PinnedParticle& odd) const {
    std::vector<Region> found;
    std::vector<bool> seen(pinned_.size());
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) {
        if (!is_pinned(row, column) || seen[index(row, column)]) continue;
        const std::vector<PinnedParticle> group = neighbours_of(row, column, seen);
        if (!add_regions(group, found)) {
          odd = {row, column};
          return std::nullopt;
        }
      }
    return found;
  }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  bool is_pinned(int row, int column) const {
    return row >= 0 && row < rows_ && column >= 0 && column < columns_ && pinned_[index(row, column)];
  }

  /// The pinned particles that hang together with this one along rows and columns.
  std::vector<PinnedParticle> neighbours_of(int row, int column, std::vector<bool>& seen) const {
    std::vector<PinnedParticle> group{{row, column}};
    seen[index(row, column)] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const PinnedParticle at = group[k];
      for (const auto& [down, across] : {std::pair{0, 1}, {0, -1}, {1, 0}, {-1, 0}})
        if (is_pinned(at.row + down, at.column + across) && !seen[index(at.row + down, at.column + across)]) {
          seen[index(at.row + down, at.column + across)] = true;
          group.push_back({at.row + down, at.column + across});
        }
    }
    return group;
  }

  bool is_row_pinned(int row) const {
    for (int column = 0; column < columns_; ++column)
      if (!is_pinned(row, column)) return false;
    return true;
  }
  bool is_column_pinned(int column) const {
    for (int row = 0; row < rows_; ++row)
      if (!is_pinned(row, column)) return false;
    return true;
  }

  /// A filled rectangle, or edges that meet in corners.
  bool add_regions(const std::vector<PinnedParticle>& group, std::vector<Region>& found) const {
    Region hull{rows_, -1, columns_, -1};
    for (const PinnedParticle& at : group)
      hull = {std::min(hull.first_row, at.row), std::max(hull.last_row, at.row),
              std::min(hull.first_column, at.column), std::max(hull.last_column, at.column)};
    const auto size = static_cast<std::size_t>(hull.last_row - hull.first_row + 1) *
                      static_cast<std::size_t>(hull.last_column - hull.first_column + 1);
    if (size == group.size()) {
      found.push_back(hull);
      return true;
    }
    const int bottom = rows_ - 1, right = columns_ - 1;
    const bool on_top = is_row_pinned(0), at_bottom = is_row_pinned(bottom);
    const bool at_left = is_column_pinned(0), at_right = is_column_pinned(right);
    for (const PinnedParticle& at : group)
      if (!(on_top && at.row == 0) && !(at_bottom && at.row == bottom) && !(at_left && at.column == 0) &&
          !(at_right && at.column == right))
        return false;
    if (on_top) found.push_back({0, 0, 0, right});
    if (at_bottom) found.push_back({bottom, bottom, 0, right});
    if (at_left) found.push_back({0, bottom, 0, 0});
    if (at_right) found.push_back({0, bottom, right, right});
    return true;
  }

  int rows_, columns_;
  std::vector<bool> pinned_;
};

bool are_of_every_grid(const std::vector<Pin>& pins) {
  return std::none_of(pins.begin(), pins.end(),
                      [](const Pin& pin) { return std::holds_alternative<PinnedParticle>(pin); });
}

/// Those of pins that every grid has, by name or as a disc: none.
std::optional<std::vector<Region>> regions_of(const ClothSheet& cloth, PinnedParticle& odd) {
  if (are_of_every_grid(cloth.pins)) return std::vector<Region>();
  return PinnedGrid(cloth).regions(odd);
}

double most_columns(const Scene& scene) {
  const auto parameter = find_parameter(scene, "cloth.columns");
  return parameter ? parameter->info.maximum : 0;
}

}  // namespace

std::optional<Problem> refinement_problem(const Scene& scene) {
  if (scene.cloth.is_mesh())
    return Problem{"cloth.mesh", '"' + scene.cloth.mesh.file + '"',
                   "has no other grids: a study of convergence needs a cloth of rows and columns"};
  PinnedParticle odd;
  if (regions_of(scene.cloth, odd)) return std::nullopt;
  return Problem{"cloth.pins", fmt::format("[{}, {}]", odd.row, odd.column),
                 "with the pins that touch it fills no rectangle, so that it means another place on another "
                 "grid: pin edges, corners, single particles or filled rectangles"};
}

int cell_unit(const Scene& scene) {
  const ClothSheet& cloth = scene.cloth;
  const int across = cloth.columns - 1, down = cloth.rows - 1;
  int unit = across / std::gcd(across, down);
  PinnedParticle odd;
  const std::vector<Region> regions = regions_of(cloth, odd).value();
  const auto keep_line = [&](int line) {
    if (line > 0) unit = std::lcm(unit, across / std::gcd(across, line));
  };
  for (const Region& region : regions)
    for (const int line : {region.first_row, region.last_row, region.first_column, region.last_column})
      keep_line(line);
  for (const Probe& probe : scene.probes)
    for (const ParticlePlace& at : probe.particles) keep_line(at.row), keep_line(at.column);
  return unit;
}

std::vector<int> default_cells(const Scene& scene) {
  constexpr int coarsest = 8, finest = 64;
  const int unit = cell_unit(scene), first = (coarsest + unit - 1) / unit * unit;
  std::vector<int> cells{first, 2 * first, 4 * first};
  while (2 * cells.back() <= finest) cells.push_back(2 * cells.back());
  return cells;
}

std::optional<std::string> broken_cells_rule(const Scene& scene, const std::vector<int>& cells) {
  const int unit = cell_unit(scene);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (cells[k] < 1 || cells[k] % unit != 0)
      return unit == 1
                 ? fmt::format("{}: must be at least 1", cells[k])
                 : fmt::format(
                       "{}: must be a multiple of {}, so that rows are whole and pins keep their places",
                       cells[k], unit);
    if (k > 0 && cells[k] <= cells[k - 1])
      return fmt::format("{}: must be more than {}, from coarse to fine", cells[k], cells[k - 1]);
    const double rows =
        static_cast<double>(cells[k]) * (scene.cloth.rows - 1) / (scene.cloth.columns - 1) + 1;
    if (const double most = most_columns(scene); cells[k] + 1.0 > most || rows > most)
      return fmt::format("{}: a grid has at most {:g} rows and columns", cells[k], most);
  }
  if (cells.size() < 2) return "must be two grids or more";
  return std::nullopt;
}

Scene refined_scene(const Scene& scene, int cells) {
  Scene refined = scene;
  const int before = scene.cloth.columns - 1;
  if (cells == before) return refined;
  const auto scaled = [&](int line) {
    return static_cast<int>(static_cast<std::int64_t>(line) * cells / before);
  };
  PinnedParticle odd;
  const std::vector<Region> regions = regions_of(scene.cloth, odd).value();
  refined.cloth.columns = cells + 1;
  refined.cloth.rows = scaled(scene.cloth.rows - 1) + 1;
  for (Probe& probe : refined.probes)
    for (ParticlePlace& at : probe.particles) at = {scaled(at.row), scaled(at.column)};
  if (regions.empty()) return refined;
  refined.cloth.pins.clear();
  for (const Region& region : regions)
    for (int row = scaled(region.first_row); row <= scaled(region.last_row); ++row)
      for (int column = scaled(region.first_column); column <= scaled(region.last_column); ++column)
        refined.cloth.pins.emplace_back(PinnedParticle{row, column});
  return refined;
}

std::string refusal_to_run(const Scene& scene) {
  std::vector<Problem> problems = find_problems(scene);
  if (problems.empty()) problems = find_start_problems(scene);
  if (!problems.empty()) return problems.front().text();
  const auto time_step = resolved_time_step(scene);
  if (!time_step) return no_stable_step_text(scene);
  if (const auto rule = too_many_steps(scene.duration, *time_step)) return *rule;
  return memory_problem(scene).value_or("");
}

}  // namespace cloth
