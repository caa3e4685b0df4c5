#include "geometry/mesh_repair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/random.h"

namespace cloth::test::mesh_repair_test {
namespace {

/// A closed surface of four triangles that face outward.
TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Every triangle with vertices of its own, as files of triangles have them.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh loose;
  for (const Triangle& t : mesh.triangles) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const int i : t) loose.vertices.push_back(mesh.vertices[static_cast<std::size_t>(i)]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  return loose;
}

std::string only_message(const TriangleMesh& mesh, MeshFault fault, int count) {
  const auto findings = inspect(mesh);
  EXPECT_EQ(findings.size(), 1U);
  if (findings.empty()) return "";
  EXPECT_EQ(findings[0].fault, fault);
  EXPECT_EQ(findings[0].count, count);
  return findings[0].message;
}

TEST(Weld, JoinsASoupIntoTheSurfaceThatItWas) {
  const Weld result = weld(soup(tetrahedron()), 0);
  EXPECT_EQ(result.mesh.vertices.size(), 4U);
  EXPECT_EQ(result.merged_vertices, 8);
  EXPECT_EQ(result.collapsed_triangles, 0);
  EXPECT_EQ(result.number.size(), 12U);
  EXPECT_TRUE(inspect(result.mesh).empty());
}

TEST(Weld, WithoutToleranceJoinsEqualVerticesAlone) {
  const TriangleMesh mesh{{{0, 0, 0}, {-0.0, 0, 0}, {5e-324, 0, 0}, {1, 0, 0}, {std::nextafter(1, 2), 0, 0}},
                          {}};
  EXPECT_EQ(weld(mesh, 0).number, (std::vector<int>{0, 0, 1, 2, 3}));
}

TEST(Weld, JoinsUpToTheToleranceAndNotBeyond) {
  const TriangleMesh mesh{{{0, 0, 0}, {0.25, 0, 0}, {0, -0.25, 0}, {0, 0, 0.2501}, {-0.1, -0.1, -0.1}}, {}};
  EXPECT_EQ(weld(mesh, 0.25).number, (std::vector<int>{0, 0, 0, 1, 0}));
}

TEST(Weld,
     DoesNotCreepAlongAChain) {  // each joins one that has stayed, so none moves by more than the tolerance
  TriangleMesh chain;
  for (int i = 0; i < 10; ++i) chain.vertices.emplace_back(0.75 * i, 0, 0);
  const Weld result = weld(chain, 1);
  EXPECT_EQ(result.number, (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3, 4, 4}));
  EXPECT_EQ(result.mesh.vertices[1], chain.vertices[2]);
}

TEST(Weld, RemovesTrianglesThatCollapse) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(0.9999, 0, 0);
  mesh.triangles.push_back({1, 4, 2});
  const Weld result = weld(mesh, 1e-3);
  EXPECT_EQ(result.collapsed_triangles, 1);
  EXPECT_EQ(result.mesh.triangles, tetrahedron().triangles);
}

TEST(Weld, IsWhatTheLoopOverAllPairsGives) {
  Random random;
  for (int trial = 0; trial < 20; ++trial) {
    TriangleMesh mesh;
    for (int i = 0; i < 300; ++i) mesh.vertices.push_back(random.vector(1));
    const double tolerance = random.uniform(0, 0.5);
    std::vector<int> number, kept;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      std::size_t k = 0;
      while (k < kept.size() &&
             (mesh.vertices[static_cast<std::size_t>(kept[k])] - mesh.vertices[i]).norm() > tolerance)
        ++k;
      if (k == kept.size()) kept.push_back(static_cast<int>(i));
      number.push_back(static_cast<int>(k));
    }
    EXPECT_EQ(weld(mesh, tolerance).number, number);
  }
}

TEST(UniqueEdges, ListEachEdgeOnceWithWhatLiesAcross) {
  const auto edges = unique_edges(tetrahedron());
  ASSERT_EQ(edges.size(), 6U);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const MeshEdge& edge = edges[k];
    EXPECT_LT(edge.from, edge.to);
    EXPECT_EQ(edge.triangles, 2);
    EXPECT_EQ(edge.forward, 1);
    const std::set<int> all{edge.from, edge.to, edge.opposite[0], edge.opposite[1]};
    EXPECT_EQ(all, (std::set<int>{0, 1, 2, 3}));
    if (k == 0) continue;
    EXPECT_LT(std::pair(edges[k - 1].from, edges[k - 1].to), std::pair(edge.from, edge.to));
  }
}

TEST(UniqueEdges, HaveNothingAcrossWhereTheMeshEnds) {
  const auto edges = unique_edges({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 0, 1}}});
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_EQ(edges[0].opposite, (std::array<int, 2>{2, -1}));
  EXPECT_EQ(edges[0].forward, 1);
  EXPECT_EQ(edges[1].forward, 0);
}

TEST(Inspect, FindsNothingWrongWithAClosedSurface) {
  EXPECT_TRUE(inspect(tetrahedron()).empty());
  EXPECT_TRUE(inspect({}).empty());
}

TEST(Inspect, NamesOpenEdges) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  EXPECT_EQ(only_message(mesh, MeshFault::open_edge, 3),
            "3 open edges, the first between vertices 0 and 2 near (0, 0.5, 0)");
}

TEST(Inspect, NamesTrianglesWithoutArea) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 3, 1});
  EXPECT_EQ(only_message(mesh, MeshFault::degenerate_triangle, 1),
            "1 triangle without area, triangle 4 of vertices 1, 3 and 1 near (1, 0, 0)");
  const TriangleMesh straight{{{0, 0, 0}, {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}}, {{0, 1, 2}}};
  EXPECT_EQ(inspect(straight)[0].fault, MeshFault::degenerate_triangle);
  const TriangleMesh thin{{{0, 0, 0}, {1e-3, 1e-10, 0}, {2e-3, 0, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(inspect(thin)[0].fault, MeshFault::open_edge);
}

TEST(Inspect, NamesTrianglesThatFaceOppositeWays) {
  TriangleMesh mesh = tetrahedron();
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  EXPECT_EQ(only_message(mesh, MeshFault::inconsistent_winding, 3),
            "3 edges whose two triangles face opposite ways, the first between vertices 1 and 2 near (0.5, "
            "0.5, 0)");
}

TEST(Inspect, NamesEdgesOfMoreThanTwoTrianglesAndUnusedVertices) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({0, 2, 1});
  EXPECT_EQ(only_message(mesh, MeshFault::crowded_edge, 3),
            "3 edges of more than two triangles, the first between vertices 0 and 1 near (0.5, 0, 0)");
  mesh = tetrahedron();
  mesh.vertices.emplace_back(7, 8, 9);
  EXPECT_EQ(only_message(mesh, MeshFault::unused_vertex, 1),
            "1 vertex of no triangle, vertex 4 at (7, 8, 9)");
}

}  // namespace
}  // namespace cloth::test::mesh_repair_test
