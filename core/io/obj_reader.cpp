#include "io/obj_reader.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>

#include "geometry/polygon.h"
#include "io/text_file.h"
#include "io/tiny_obj.h"

namespace cloth {
namespace {

constexpr double largest_coordinate = 1e9;
constexpr std::size_t max_vertices = 10'000'000;
constexpr std::size_t max_corners_at_once = 64;  // tiny_obj's time for a face grows with a power of them

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// Takes the next word off the front of `line`; empty at its end.
std::string_view next_word(std::string_view& line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  std::size_t length = 0;
  while (length < line.size() && !is_blank(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

std::string shown(std::string_view word) {
  constexpr std::size_t longest = 30;
  return word.size() <= longest ? std::string(word) : std::string(word.substr(0, longest - 3)) + "...";
}

/// Looks through the text line by line. Vertices are taken here, to the last digit; faces become lines of
/// plain vertex numbers from 1, for tiny_obj to cut into triangles.
class Scan {
 public:
  std::vector<Vec3> vertices;
  std::string faces;
  std::string problem;

  /// Whether the whole text could be used.
  bool read(std::string_view text, const std::string& place) {
    while (!text.empty()) {
      ++line_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      const std::string_view keyword = next_word(line);
      if (keyword == "v") read_vertex(line);
      if (keyword == "f") read_face(line);
      if (problem.empty()) continue;
      problem = fmt::format("{}:{}: {}", place, line_, problem);
      return false;
    }
    if (vertices.empty() || faces.empty())
      problem = fmt::format("{}: there is no mesh in it: {} vertices, {} faces", place, vertices.size(),
                            faces.empty() ? "no" : "some");
    return problem.empty();
  }

 private:
  void read_vertex(std::string_view line) {
    if (vertices.size() == max_vertices) {
      problem = fmt::format("there may be at most {} vertices", max_vertices);
      return;
    }
    Vec3 vertex;
    for (double& coordinate : vertex) {
      const std::string_view word = next_word(line);
      if (word.empty()) problem = "a vertex needs three numbers";
      if (!word.empty() && !read_number(word, coordinate))
        problem = fmt::format("\"{}\" is no coordinate: a finite number up to {:g}", shown(word),
                              largest_coordinate);
      if (!problem.empty()) return;
    }
    vertices.push_back(vertex);
  }

  static bool read_number(std::string_view word, double& number) {
    if (word.front() == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size() && std::abs(number) <= largest_coordinate;
  }

  /// Corners are "7", "7/1", "7//3" or "7/1/3"; numbers below 0 count back from the last vertex.
  void read_face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const std::string_view number = word.substr(0, word.find('/'));
      long long vertex = 0;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), vertex);
      const auto count = static_cast<long long>(vertices.size());
      if (vertex < 0) vertex += count + 1;
      if (number.empty() || error != std::errc() || end != number.data() + number.size() || vertex < 1 ||
          vertex > count) {
        problem =
            fmt::format("\"{}\" is no corner of a face: {} vertices stand before it", shown(word), count);
        return;
      }
      corners_.push_back(static_cast<int>(vertex) - 1);
    }
    if (corners_.size() < 3)
      problem = "a face needs three corners";
    else if (corners_.size() <= max_corners_at_once)
      add_face(corners_);
    else
      cut_face();
  }

  void add_face(std::span<const int> corners) {
    faces += 'f';
    for (const int corner : corners) fmt::format_to(std::back_inserter(faces), " {}", corner + 1);
    faces += '\n';
  }

  void cut_face() {
    const std::vector<Triangle> triangles = cut_polygon(vertices, corners_);
    if (triangles.empty())
      problem =
          fmt::format("a face of {} corners is too entangled to be cut into triangles", corners_.size());
    for (const Triangle& triangle : triangles) add_face(triangle);
  }

  std::vector<int> corners_;  ///< of the face being read
  int line_ = 0;
};

}  // namespace

ObjReading parse_obj(const std::string& text, const std::string& place) {
  Scan scan;
  if (!scan.read(text, place)) return {std::nullopt, std::move(scan.problem)};
  TriangleMesh mesh{std::move(scan.vertices), {}};
  mesh.triangles = cut_into_triangles(mesh.vertices, scan.faces);
  if (mesh.triangles.empty()) return {std::nullopt, place + ": all of its faces are degenerate"};
  return {std::move(mesh), {}};
}

ObjReading read_obj(const std::filesystem::path& path) {
  std::string text;
  if (const auto error = read_text_file(path, text, largest_mesh_text))
    return {std::nullopt, fmt::format("{}: {}", path.filename().string(), error->message)};
  return parse_obj(text, path.filename().string());
}

}  // namespace cloth
