#include "io/obj_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace cloth {
namespace {

/// On one line, whatever the title.
std::string comment(std::string title) {
  std::replace_if(
      title.begin(), title.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return fmt::format("# {}\n", title);
}

template <class Number>
void append_triples(std::string& text, const char* key, std::span<const Number> values) {
  for (std::size_t i = 0; i + 2 < values.size(); i += 3)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", key, values[i], values[i + 1], values[i + 2]);
}

}  // namespace

std::string obj_text(const TriangleMesh& mesh, const std::string& title) {
  std::vector<double> positions;
  positions.reserve(3 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) positions.insert(positions.end(), {v.x(), v.y(), v.z()});
  ObjSurface<double> surface;
  surface.positions = positions;
  surface.triangles = mesh.triangles;
  return obj_text(surface, title);
}

template <class Number>
std::string obj_text(const ObjSurface<Number>& surface, const std::string& title) {
  std::string text = comment(title);
  append_triples(text, "v", surface.positions);
  for (const auto& [u, v] : surface.texture) fmt::format_to(std::back_inserter(text), "vt {} {}\n", u, v);
  append_triples(text, "vn", surface.normals);
  const bool has_texture = !surface.texture.empty(), has_normals = !surface.normals.empty();
  for (const Triangle& triangle : surface.triangles) {
    text += 'f';
    for (const int vertex : triangle) {
      const int number = vertex + 1;
      fmt::format_to(std::back_inserter(text), " {}", number);
      if (has_texture) fmt::format_to(std::back_inserter(text), "/{}", number);
      if (has_normals) fmt::format_to(std::back_inserter(text), "{}/{}", has_texture ? "" : "/", number);
    }
    text += '\n';
  }
  return text;
}

template <class Number>
std::vector<std::array<Number, 2>> grid_texture(int rows, int columns) {
  std::vector<std::array<Number, 2>> texture;
  if (rows < 2 || columns < 2) return texture;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      texture.push_back({static_cast<Number>(column) / static_cast<Number>(columns - 1),
                         static_cast<Number>(rows - 1 - row) / static_cast<Number>(rows - 1)});
  return texture;
}

template std::string obj_text(const ObjSurface<float>&, const std::string&);
template std::string obj_text(const ObjSurface<double>&, const std::string&);
template std::vector<std::array<float, 2>> grid_texture(int, int);
template std::vector<std::array<double, 2>> grid_texture(int, int);

}  // namespace cloth
