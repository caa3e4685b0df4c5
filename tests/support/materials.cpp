#include "support/materials.h"

#include "support/scenes.h"

namespace cloth::test {

Material any_material() {
  return {.areal_density = 0.18,
          .stretch_warp = 500,
          .stretch_weft = 400,
          .shear = 60,
          .bending_warp = 3e-3,
          .bending_weft = 2e-3,
          .twist = 1.5e-3};
}

Scene material_sheet(int rows, int columns, double across, double down, const Material& material) {
  Scene scene = bare_sheet(rows, columns);
  scene.cloth.width = across * (columns - 1);
  scene.cloth.height = down * (rows - 1);
  scene.material = material;
  return scene;
}

Eigen::MatrixXd bending_hessian(const ClothSystem& system) {
  const Eigen::Index size = 3 * system.size();
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  for (const BendingRun& run : system.bending)
    for (int e = run.first; e < run.first + run.count; ++e) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(system.size());
      for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p)
        sum[e + run.offset[p]] = run.coefficient[p];
      for (int axis = 0; axis < 3; ++axis)
        hessian(Eigen::seqN(axis, system.size(), 3), Eigen::seqN(axis, system.size(), 3)) +=
            run.stiffness * sum * sum.transpose();
    }
  return hessian;
}

}  // namespace cloth::test
