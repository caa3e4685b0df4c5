// Triangle meshes from OBJ files: what is read, and what is said of a file that is none.
#include "io/obj_reader.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>

#include "support/files.h"

namespace cloth::test::obj_reader_test {
namespace {

const char* const square =
    "# a unit square\nmtllib none.mtl\no square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ns "
    "off\n";

TriangleMesh read(const std::string& text) {
  ObjReading reading = parse_obj(text, "x.obj");
  EXPECT_EQ(reading.problem, "");
  return reading.mesh.value_or(TriangleMesh{});
}

std::string problem_of(const std::string& text) {
  const ObjReading reading = parse_obj(text, "x.obj");
  EXPECT_FALSE(reading.mesh);
  return reading.problem;
}

double area_of(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0));
  }
  return sum.norm();
}

TEST(ObjReader, ReadsVerticesInOrderAndTriangles) {
  const TriangleMesh mesh = read(std::string(square) + "f 1 2 3\nf 1/1/1 3//1 4/1\n");
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[2], Vec3(1, 1, 0));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
}

TEST(ObjReader, CutsPolygonsIntoTrianglesOfTheSameAreaAndWinding) {
  const TriangleMesh quad = read(std::string(square) + "f 1 2 3 4\n");
  EXPECT_EQ(quad.triangles.size(), 2U);
  EXPECT_NEAR(area_of(quad), 1, 1e-12);

  std::string text, face = "f";  // an L: six corners, one of them turning in
  for (const auto& [x, y] : {std::pair{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})
    text += "v " + std::to_string(x) + ' ' + std::to_string(y) + " 0\n";
  for (int k = 1; k <= 6; ++k) face += ' ' + std::to_string(k);
  const TriangleMesh corner = read(text + face + '\n');
  EXPECT_EQ(corner.triangles.size(), 4U);
  EXPECT_NEAR(area_of(corner), 3, 1e-12);
}

TEST(ObjReader, CountsNegativeNumbersBackFromTheLastVertex) {
  EXPECT_EQ(read(std::string(square) + "f -4 -3 -2\n").triangles.at(0), (Triangle{0, 1, 2}));
}

TEST(ObjReader, TakesNumbersToTheLastDigitInEveryLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"C", "de_DE.UTF-8", "fr_FR.UTF-8"}) {
    std::setlocale(LC_ALL, locale);  // where it is not installed, the last one stays
    const TriangleMesh mesh = read("v 0.1 1e-3 +.30000000000000004\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n");
    EXPECT_EQ(mesh.vertices.at(0), Vec3(0.1, 1e-3, 0.1 + 0.2));
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(ObjReader, NamesFileAndLineOfWhatCannotBeRead) {
  EXPECT_EQ(problem_of("v 0 0 0\nv nan 0 0\n").substr(0, 8), "x.obj:2:");
  EXPECT_EQ(problem_of("v 0 0 0\nv 1 inf 0\n").substr(0, 8), "x.obj:2:");
  EXPECT_EQ(problem_of("v 1e300 0 0\n").substr(0, 8), "x.obj:1:");
  EXPECT_EQ(problem_of("v 0,5 0 0\n").substr(0, 8), "x.obj:1:");
  EXPECT_EQ(problem_of("v 0 0\n").substr(0, 8), "x.obj:1:");
  EXPECT_EQ(problem_of("v 0 0 0\nf 1 1 2\n").substr(0, 8), "x.obj:2:");
  EXPECT_EQ(problem_of(std::string(square) + "f 1 2\n").substr(0, 9), "x.obj:11:");
  EXPECT_EQ(problem_of(std::string(square) + "f 1 2 0\n").substr(0, 9), "x.obj:11:");
  EXPECT_EQ(problem_of(std::string(square) + "f 1 2 5\n").substr(0, 9), "x.obj:11:");
  EXPECT_EQ(problem_of(std::string(square) + "f 1 2 three\n").substr(0, 9), "x.obj:11:");
}

TEST(ObjReader, SaysThatThereIsNoMesh) {
  EXPECT_NE(problem_of("").find("no mesh"), std::string::npos);
  EXPECT_NE(problem_of(square).find("no mesh"), std::string::npos);
  EXPECT_NE(problem_of("\x7f"
                       "ELF\0\1\2"),
            "");
}

TEST(ObjReader, SaysWhyAFileCannotBeOpened) {
  const ObjReading reading = read_obj("/nowhere/at all.obj");
  EXPECT_FALSE(reading.mesh);
  EXPECT_EQ(reading.problem.find("/nowhere"), std::string::npos);
  EXPECT_NE(reading.problem.find("at all.obj"), std::string::npos);
}

}  // namespace
}  // namespace cloth::test::obj_reader_test
