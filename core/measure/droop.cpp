#include "measure/droop.h"

#include <limits>

namespace cloth {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

Vec3 at(const Vec3Field& field, int particle) {
  return {field.x()[particle], field.y()[particle], field.z()[particle]};
}

}  // namespace

double Droop::ratio() const {
  constexpr double straight_below = 1e-9;  // of the drop
  if (drop <= 0) return 0;
  return reach > straight_below * drop ? drop / reach : no_value;
}

Droop measure_droop(const ClothSystem& system, const Vec3Field& position, const Vec3& gravity) {
  const Vec3 up = gravity.norm() > 0 ? Vec3(-gravity.normalized()) : Vec3(0, 1, 0);
  int lowest = 0;
  for (int i = 1; i < system.size(); ++i)
    if (at(position, i).dot(up) < at(position, lowest).dot(up)) lowest = i;
  const Vec3 low = at(position, lowest);
  Droop droop{.lowest = low.dot(up), .drop = no_value, .reach = no_value};
  for (int i = 0; i < system.size(); ++i) {
    if (!system.pinned[static_cast<std::size_t>(i)]) continue;
    const Vec3 away = at(position, i) - low;
    const double drop = away.dot(up), reach = (away - drop * up).norm();
    if (!(reach >= droop.reach)) droop.drop = drop, droop.reach = reach;
  }
  return droop;
}

}  // namespace cloth
