#include "support/material_meshes.h"

#include "scene/scene_mesh.h"
#include "support/meshes.h"

namespace cloth::test {

Scene material_mesh_sheet(int columns, int rows, double width, double height, double disorder,
                          const Material& material, Random& random, int straight) {
  const double a = width / (columns - 1), b = height / (rows - 1);
  TriangleMesh surface;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      Vec3 place(a * column, -b * row, 0);
      if (column >= straight && column + 1 < columns) place.x() += disorder * a * random.uniform(-1, 1);
      if (row > 0 && row + 1 < rows) place.y() += disorder * b * random.uniform(-1, 1);
      surface.vertices.push_back(place);
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const int p = row * columns + column, q = p + 1, s = p + columns, r = s + 1;
      if (disorder > 0 && random.coin()) {
        surface.triangles.push_back({p, s, q});
        surface.triangles.push_back({q, s, r});
      } else {
        surface.triangles.push_back({p, s, r});
        surface.triangles.push_back({p, r, q});
      }
    }
  Scene scene;
  scene.cloth.mesh = made_mesh("made.obj", surface);
  scene.cloth.rows = 1;
  scene.cloth.columns = static_cast<int>(surface.vertices.size());
  scene.cloth.origin = Vec3::Zero();
  scene.material = material;
  return scene;
}

std::vector<Scene> meshes_of_a_sheet(double width, double height, const Material& material, Random& random) {
  return {material_mesh_sheet(4, 3, width, height, 0, material, random),
          material_mesh_sheet(7, 9, width, height, 0.3, material, random),
          material_mesh_sheet(13, 9, width, height, 0.3, material, random)};
}

}  // namespace cloth::test
