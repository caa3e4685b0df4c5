#include "cloth/bending_rows.h"

#include <map>

#include "cloth/cloth_system.h"

namespace cloth {

BendingRows bending_rows(const BendingRuns& runs, std::size_t particles) {
  std::vector<std::map<std::size_t, double>> entries(particles);
  for_each_bending_pair(runs, [&](std::size_t i, std::size_t j, double stiffness) {
    entries[i][j] -= stiffness;
    entries[j][i] -= stiffness;
  });
  BendingRows rows;
  rows.begin.push_back(0);
  for (const auto& row : entries) {
    for (const auto& [j, stiffness] : row) {
      rows.column.push_back(static_cast<std::int32_t>(j));
      rows.stiffness.push_back(stiffness);
    }
    rows.begin.push_back(static_cast<std::uint32_t>(rows.column.size()));
  }
  return rows;
}

void add_bending_product(const BendingRows& rows, double scale, const Vec3Field& field, Vec3Field& result) {
  const double *x = field.x(), *y = field.y(), *z = field.z();
  for (std::size_t i = 0; i + 1 < rows.begin.size(); ++i) {
    double along_x = 0, along_y = 0, along_z = 0;
    for (std::uint32_t e = rows.begin[i]; e < rows.begin[i + 1]; ++e) {
      const std::int32_t j = rows.column[e];
      const double k = rows.stiffness[e];
      along_x += k * (x[j] - x[i]), along_y += k * (y[j] - y[i]), along_z += k * (z[j] - z[i]);
    }
    result.x()[i] += scale * along_x, result.y()[i] += scale * along_y, result.z()[i] += scale * along_z;
  }
}

void add_bending_product(const ClothSystem& system, double scale, const Vec3Field& field, Vec3Field& result) {
  if (system.bending_rows.begin.empty())
    add_bending_product(system.bending, scale, field, result);
  else
    add_bending_product(system.bending_rows, scale, field, result);
}

}  // namespace cloth
