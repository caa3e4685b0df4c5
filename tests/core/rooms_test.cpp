// The rooms of core stand in a row: each includes only those before it, so that there is no loop. The picture
// of docs/architecture.md is drawn from the same includes; CLOTHLAB_WRITE_PICTURES=1 writes it anew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace cloth::test::rooms_test {
namespace {

namespace fs = std::filesystem;

/// From the ground up.
const std::vector<std::string> rooms{"params",      "geometry", "io",      "design",  "exact",
                                     "cloth",       "scene",    "kernels", "sparse",  "forces",
                                     "integrators", "limiter",  "contact", "measure", "simulation",
                                     "picture",     "report",   "study",   "sweep",   "compare"};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::ptrdiff_t place_of(const std::string& room) {
  return std::find(rooms.begin(), rooms.end(), room) - rooms.begin();
}

struct Include {
  fs::path file;
  std::string target;  ///< "scene/scene.h"
  std::string room() const { return target.substr(0, target.find('/')); }
};

/// Every include in quotes of the sources below `folder`.
std::vector<Include> includes_below(const fs::path& folder) {
  static const std::regex line("#include \"([^\"]+)\"");
  std::vector<Include> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it)
      found.push_back({entry.path(), (*it)[1]});
  }
  return found;
}

fs::path source(const char* folder) {
  return fs::path(CLOTHLAB_SOURCE_DIR) / folder;
}

TEST(Rooms, OfCoreAreAllInTheRow) {
  for (const auto& entry : fs::directory_iterator(source("core"))) {
    if (!entry.is_directory()) continue;
    EXPECT_LT(place_of(entry.path().filename()), std::ssize(rooms)) << entry.path();
  }
}

TEST(Rooms, IncludeOnlyWhatStandsBeforeThem) {
  std::size_t seen = 0;
  for (const std::string& room : rooms)
    for (const Include& include : includes_below(source("core") / room)) {
      if (include.target.find('/') == std::string::npos) continue;
      ++seen;
      EXPECT_LE(place_of(include.room()), place_of(room))
          << include.file << " includes \"" << include.target << "\"";
    }
  EXPECT_GT(seen, 500u);
}

TEST(Rooms, OfCoreIncludeNothingOfQt) {
  for (const auto& entry : fs::recursive_directory_iterator(source("core")))
    if (entry.is_regular_file()) {
      EXPECT_FALSE(std::regex_search(text_of(entry.path()), std::regex("#include <Q[A-Z]"))) << entry.path();
    }
}

/// A table: the room of a row includes the room of a column so many times. A column has its name beside the
/// diagonal, above which there is nothing.
std::string drawn() {
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const std::string& room : rooms)
    for (const Include& include : includes_below(source("core") / room))
      if (include.room() != room && place_of(include.room()) < std::ssize(rooms))
        ++counts[{room, include.room()}];
  constexpr int cell = 30, label = 110, top = 10;
  const int size = static_cast<int>(rooms.size());
  const int width = label + cell * size + 90, height = top + cell * size + 10;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      width, height);
  for (int k = 0; k < size; ++k) {
    const int x = label + cell * k, y = top + cell * k;
    const std::string& name = rooms[static_cast<std::size_t>(k)];
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"#222222\">{}</text>\n", label - 8,
                       y + 20, name);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"#6b7480\">{}</text>\n", x + cell + 6, y + 20, name);
    svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#d8dde3\"/>\n", x, y,
                       cell - 2, cell - 2);
  }
  for (const auto& [pair, count] : counts) {
    const auto x = label + cell * place_of(pair.second), y = top + cell * place_of(pair.first);
    const bool many = count > 9;
    svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", x, y, cell - 2,
                       cell - 2, many ? "#2f6fa8" : "#b9d2e8");
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n",
                       x + (cell - 2) / 2, y + 19, many ? "#ffffff" : "#222222", count);
  }
  return svg + "</svg>\n";
}

TEST(Rooms, AreThoseOfThePictureInTheDocumentation) {
  const fs::path path = source("docs") / "pictures" / "rooms.svg";
  const std::string now = drawn();
  if (const char* write = std::getenv("CLOTHLAB_WRITE_PICTURES"); write && *write)
    std::ofstream(path, std::ios::binary) << now;
  EXPECT_TRUE(text_of(path) == now) << "CLOTHLAB_WRITE_PICTURES=1 with this test writes " << path << " anew";
}

}  // namespace
}  // namespace cloth::test::rooms_test
