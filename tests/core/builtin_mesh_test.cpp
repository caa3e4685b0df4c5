// The meshes of our own making, and how a mesh is drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/builtin_meshes.h"
#include "geometry/bunny.h"
#include "geometry/mesh_look.h"
#include "geometry/mesh_repair.h"

namespace cloth::test::builtin_mesh_test {
namespace {

double volume_of(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t k) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(t[k])];
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return volume;
}

TriangleMesh made(const std::string& name) {
  const BuiltinMesh* mesh = find_builtin_mesh(name);
  EXPECT_NE(mesh, nullptr) << name;
  return mesh ? weld(mesh->make(), 0).mesh : TriangleMesh{};
}

void expect_closed_and_facing_out(const TriangleMesh& mesh) {
  for (const MeshFinding& finding : inspect(mesh)) ADD_FAILURE() << finding.message;
  EXPECT_GT(volume_of(mesh), 0);
  const auto euler = static_cast<long>(mesh.vertices.size() + mesh.triangles.size()) -
                     static_cast<long>(unique_edges(mesh).size());
  EXPECT_EQ(euler, 2) << "a ball without handles";
}

TEST(BuiltinMesh, TheBunnyIsAClosedBallOfAtLeastFiftyThousandTriangles) {
  const TriangleMesh bunny = made("bunny.obj");
  EXPECT_GE(bunny.triangles.size(), 50'000U);
  expect_closed_and_facing_out(bunny);
  Eigen::AlignedBox3d bounds;
  for (const Vec3& vertex : bunny.vertices) bounds.extend(vertex);
  EXPECT_NEAR(bounds.max().y(), 1, 0.02);
  EXPECT_NEAR(bounds.min().y(), 0, 0.02);
}

TEST(BuiltinMesh, NoTriangleOfTheBunnyIsDegenerate) {
  const TriangleMesh bunny = make_bunny(0.0078);
  for (const Triangle& t : bunny.triangles) {
    const auto at = [&](std::size_t k) -> const Vec3& {
      return bunny.vertices[static_cast<std::size_t>(t[k])];
    };
    const double doubled = (at(1) - at(0)).cross(at(2) - at(0)).norm();
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (at(k) - at((k + 1) % 3)).squaredNorm());
    ASSERT_GT(doubled, 0.02 * longest);
  }
}

TEST(BuiltinMesh, EveryVertexOfTheBunnyLiesNearItsSurface) {
  constexpr double cell = 0.02;
  double farthest = 0;
  for (const Vec3& vertex : make_bunny(cell).vertices)
    farthest = std::max(farthest, std::abs(bunny_distance(vertex)));
  EXPECT_LT(farthest, 0.4 * cell);
}

TEST(BuiltinMesh, TheBunnyIsItsOwnMirrorImage) {
  const Vec3 x(0.1, 0.4, 0.17);
  EXPECT_EQ(bunny_distance(x), bunny_distance({x.x(), x.y(), -x.z()}));
}

TEST(BuiltinMesh, TheConeBedIsClosedAndHasASharpTipForEachCone) {
  const TriangleMesh bed = made("cone-bed.obj");
  expect_closed_and_facing_out(bed);
  const auto tips =
      std::count_if(bed.vertices.begin(), bed.vertices.end(), [](const Vec3& v) { return v.y() > 0; });
  EXPECT_EQ(tips, 64);
}

TEST(BuiltinMesh, TheDiscLiesFlatFacesUpAndHasOneBorder) {
  const TriangleMesh disc = made("disc.obj");
  for (const Triangle& t : disc.triangles) {
    const auto at = [&](std::size_t k) -> const Vec3& {
      return disc.vertices[static_cast<std::size_t>(t[k])];
    };
    EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).y(), 0);
  }
  const std::vector<MeshFinding> findings = inspect(disc);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().fault, MeshFault::open_edge);
  EXPECT_EQ(findings.front().count, 144);
  EXPECT_EQ(disc.vertices.size() + disc.triangles.size() - unique_edges(disc).size(), 1U);
}

TEST(BuiltinMesh, IsTheSameEveryTime) {
  for (const BuiltinMesh& mesh : builtin_meshes()) {
    const TriangleMesh once = mesh.make(), again = mesh.make();
    EXPECT_EQ(once.vertices, again.vertices);
    EXPECT_EQ(once.triangles, again.triangles);
  }
}

TEST(MeshLook, NormalsAreSmoothOnABallAndSharpOnAnEdge) {
  const TriangleMesh roof{{{0, 0, -1}, {0, 0, 1}, {1, -1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  const std::vector<Vec3> normals = corner_normals(roof);
  EXPECT_NEAR((normals[0] - Vec3(1, 1, 0).normalized()).norm(), 0, 1e-12);
  EXPECT_NEAR((normals[3] - Vec3(-1, 1, 0).normalized()).norm(), 0, 1e-12);
}

TEST(MeshLook, AFlatSheetKeepsItsLengths) {
  const TriangleMesh sheet{{{0, 0, 0}, {0, 0, 3}, {0, 2, 3}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const FlatPattern flat = flat_pattern(sheet);
  EXPECT_NEAR(flat.size.minCoeff(), 2, 1e-12);
  EXPECT_NEAR(flat.size.maxCoeff(), 3, 1e-12);
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {0, 2}})
    EXPECT_NEAR(
        (flat.at[static_cast<std::size_t>(a)] - flat.at[static_cast<std::size_t>(b)]).norm(),
        (sheet.vertices[static_cast<std::size_t>(a)] - sheet.vertices[static_cast<std::size_t>(b)]).norm(),
        1e-12);
}

}  // namespace
}  // namespace cloth::test::builtin_mesh_test
