#include "kernels/slider_grid.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

std::size_t middle_of(const BendingSlider& s) {
  return static_cast<std::size_t>(s.particle[0]);
}

double share_of_slider(const ClothSystem& system, const BendingSlider& s, bool is_across) {
  const int row = s.particle[0] / system.columns, column = s.particle[0] % system.columns;
  const int index = is_across ? row : column, count = is_across ? system.rows : system.columns;
  return index == 0 || index == count - 1 ? 0.5 : 1;
}

bool is_along_row(const BendingSlider& s) {
  return s.particle[2] == s.particle[0] + 1;
}

bool lies_in(const ClothSystem& system, const BendingSlider& s) {
  const int row = s.particle[0] / system.columns, column = s.particle[0] % system.columns;
  const int offset = is_along_row(s) ? 1 : system.columns;
  if (s.points != 3 || s.normal_points != 1) return false;
  if (s.particle[1] != s.particle[0] - offset || s.particle[2] != s.particle[0] + offset) return false;
  if (s.coefficient[0] != -2 * s.coefficient[1] || s.coefficient[2] != s.coefficient[1]) return false;
  return offset == 1 ? column > 0 && column + 1 < system.columns : row > 0 && row + 1 < system.rows;
}

/// Places one slider; false where it is not like the others of its direction.
bool place(const ClothSystem& system, const BendingSlider& s, SlidersAlong& along) {
  constexpr double rounding = 1e-12;
  const double push = s.stiffness * s.area * s.coefficient[1] / share_of_slider(system, s, is_along_row(s));
  const double most = s.yield / s.stiffness;
  double& curvature = along.curvature[middle_of(s)];
  if (curvature != 0 || !(s.coefficient[1] > 0)) return false;
  if (along.push == 0) along.push = push, along.most = most, along.curvature_of_whole = s.coefficient[1];
  curvature = s.coefficient[1];
  along.curvature_of_whole = std::min(along.curvature_of_whole, curvature);
  return std::abs(push - along.push) <= rounding * along.push &&
         std::abs(most - along.most) <= rounding * along.most;
}

SlidersAlong& along_of(SliderGrid& grid, const BendingSlider& s) {
  return is_along_row(s) ? grid.across : grid.down;
}
const SlidersAlong& along_of(const SliderGrid& grid, const BendingSlider& s) {
  return is_along_row(s) ? grid.across : grid.down;
}

}  // namespace

kernels::SliderLine SlidersAlong::line() {
  return {.curvature = curvature.data(),
          .slip = slip.data(),
          .next_slip = next_slip.data(),
          .push = push,
          .most = most,
          .curvature_of_whole = curvature_of_whole};
}

kernels::SliderPass SliderGrid::pass() {
  return {.across = across.line(),
          .down = down.line(),
          .normal = {normal.x(), normal.y(), normal.z()},
          .next_normal = {next_normal.x(), next_normal.y(), next_normal.z()}};
}

void SliderGrid::take_next_normals() {
  std::swap(normal, next_normal);
  ++changes;
}

void SliderGrid::take_next() {
  across.slip.swap(across.next_slip);
  down.slip.swap(down.next_slip);
  take_next_normals();
}

void SliderGrid::put(const BendingSliders& sliders, const SliderState& list) {
  for (std::size_t k = 0; k < sliders.size(); ++k) {
    const std::size_t middle = middle_of(sliders[k]);
    along_of(*this, sliders[k]).slip[middle] = list.slip[k];
    normal.set(middle, list.normal[k]);
  }
}

void SliderGrid::get(const BendingSliders& sliders, SliderState& list) const {
  for (std::size_t k = 0; k < sliders.size(); ++k) {
    const std::size_t middle = middle_of(sliders[k]);
    list.slip[k] = along_of(*this, sliders[k]).slip[middle];
    list.normal.set(k, normal[middle]);
  }
}

std::optional<SliderGrid> slider_grid(const ClothSystem& system) {
  if (system.is_mesh() || system.sliders.empty()) return std::nullopt;
  SliderGrid grid;
  const auto size = static_cast<std::size_t>(system.size());
  for (SlidersAlong* along : {&grid.across, &grid.down})
    for (std::vector<double>* values : {&along->curvature, &along->slip, &along->next_slip})
      values->assign(size, 0);
  grid.normal = grid.next_normal = Vec3Field(size);
  for (const BendingSlider& s : system.sliders)
    if (!lies_in(system, s) || !place(system, s, along_of(grid, s))) return std::nullopt;
  return grid;
}

}  // namespace cloth
