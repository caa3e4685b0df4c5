// Cloths and meshes as OBJ files: what reads back, and what a renderer finds in them.
#include "io/obj_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "cloth/cloth_obj.h"
#include "io/obj_reader.h"
#include "scene/builtin_scenes.h"

namespace cloth::test::obj_writer_test {
namespace {

/// The numbers of the lines that begin with `key`.
std::vector<std::vector<double>> lines_of(const std::string& text, const std::string& key) {
  std::vector<std::vector<double>> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first != key) continue;
    lines.emplace_back();
    for (double value; words >> value;) lines.back().push_back(value);
  }
  return lines;
}

TriangleMesh read(const std::string& text) {
  ObjReading reading = parse_obj(text, "x.obj");
  EXPECT_EQ(reading.problem, "");
  return reading.mesh.value_or(TriangleMesh{});
}

ClothSystem cloth_of(const std::string& scene_name) {
  const Scene scene = builtin_scene(scene_name);
  return make_cloth(scene.cloth, scene.springs.value_or(SpringMaterial{}));
}

/// At rest, but for a gentle wave of awkward numbers.
ClothState wavy(const ClothSystem& system) {
  ClothState state = starting_state(system);
  for (std::size_t i = 0; i < state.position.size(); ++i)
    state.position.y()[i] += 0.1 * std::sin(3.7 * state.position.x()[i]) / 3;
  return state;
}

TEST(ObjWriter, WritesPositionsThatReadBackToTheSameBits) {
  const ClothSystem system = cloth_of("corners-free");
  const ClothState state = wavy(system);
  const TriangleMesh mesh = read(cloth_obj(system, state, "x"));
  ASSERT_EQ(mesh.vertices.size(), state.position.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) ASSERT_EQ(mesh.vertices[i], Vec3(state.position[i]));
  EXPECT_EQ(mesh.triangles, triangles_of(system));
}

TEST(ObjWriter, WritesSinglePrecisionInNoMoreDigitsThanItHas) {
  const std::vector<float> positions{0.1F, 1.0F / 3, -2e-8F};
  ObjSurface<float> surface;
  surface.positions = positions;
  const std::string text = obj_text(surface, "x");
  EXPECT_NE(text.find("v 0.1 0.33333334 -2e-08\n"), std::string::npos) << text;
}

TEST(ObjWriter, NormalsHaveLengthOneAndStandOnTheFrontOfTheTriangles) {
  for (const char* scene : {"corners-free", "disc"}) {
    const ClothSystem system = cloth_of(scene);
    const std::string text = cloth_obj(system, wavy(system), scene);
    const TriangleMesh mesh = read(text);
    const auto normals = lines_of(text, "vn");
    ASSERT_EQ(normals.size(), mesh.vertices.size());
    const auto normal = [&](int i) {
      const auto& n = normals[static_cast<std::size_t>(i)];
      return Vec3(n.at(0), n.at(1), n.at(2));
    };
    for (const Triangle& t : mesh.triangles) {
      const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
      const Vec3 front = (at(1) - at(0)).cross(at(2) - at(0));
      EXPECT_NEAR(normal(t[0]).norm(), 1, 1e-12);
      EXPECT_GT((normal(t[0]) + normal(t[1]) + normal(t[2])).dot(front), 0) << scene;
    }
  }
}

TEST(ObjWriter, TheFirstRowOfAGridIsTheUpperEdgeOfThePicture) {
  const ClothSystem system = cloth_of("corners-free");
  const std::string text = cloth_obj(system, starting_state(system), "x");
  const auto texture = lines_of(text, "vt");
  ASSERT_EQ(texture.size(), static_cast<std::size_t>(system.size()));
  const auto at = [&](int row, int column) {
    return texture[static_cast<std::size_t>(system.index(row, column))];
  };
  const int bottom = system.rows - 1, right = system.columns - 1;
  EXPECT_EQ(at(0, 0), (std::vector<double>{0, 1}));
  EXPECT_EQ(at(0, right), (std::vector<double>{1, 1}));
  EXPECT_EQ(at(bottom, 0), (std::vector<double>{0, 0}));
  EXPECT_EQ(at(bottom, right), (std::vector<double>{1, 0}));
  EXPECT_NE(text.find("f 1/1/1 34/34/34 35/35/35\n"), std::string::npos);
}

TEST(ObjWriter, AMeshHasNoTextureCoordinates) {
  const ClothSystem system = cloth_of("disc");
  const std::string text = cloth_obj(system, starting_state(system), "x");
  EXPECT_TRUE(lines_of(text, "vt").empty());
  EXPECT_NE(text.find("//"), std::string::npos);
  EXPECT_EQ(read(text).triangles, system.triangles);
}

TEST(ObjWriter, ATitleStaysAComment) {
  const std::string text = obj_text(TriangleMesh{}, "two\nv 1 2 3\rlines");
  EXPECT_EQ(text, "# two v 1 2 3 lines\n");
}

}  // namespace
}  // namespace cloth::test::obj_writer_test
