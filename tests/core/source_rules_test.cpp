// Rules that a compiler does not hold: functions stay short enough to be read at one sight, and the
// documentation names files that there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace cloth::test::source_rules_test {
namespace {

namespace fs = std::filesystem;

struct Function {
  std::string head;  ///< its last line, with the name or the parameters
  int first = 0;     ///< line of the opening brace, from 1
  int lines = 0;     ///< from the opening brace to the closing one
};

/// The line without comments and without what stands in quotes.
std::string code_of(const std::string& line) {
  static const std::regex quoted(R"(//.*|"(\\.|[^"\\])*"|'(\\.|[^'\\])*')");
  return std::regex_replace(line, quoted, "");
}

/// Whether the text before a brace is the head of a function: parameters, then at most qualifiers, a trailing
/// return type or initialisers.
bool is_head(const std::string& text) {
  static const std::regex control(
      R"(^\s*(if|for|while|switch|else|do|namespace|class|struct|enum|return|case)\b)");
  static const std::regex parameters(
      R"(\)\s*(const)?\s*(noexcept)?\s*(override)?\s*(->[^;]*)?(:[^;]*)?\s*$)");
  const std::string before = text.substr(0, text.find('('));
  if (text.size() > 2000 || before.find('=') != std::string::npos) return false;
  return !std::regex_search(text, control) && std::regex_search(text, parameters);
}

/// The functions of a file; those within another, such as lambdas, are part of it.
std::vector<Function> functions_of(const fs::path& path) {
  struct Open {
    int line = 0;
    bool is_function = false;
    std::string head;
  };
  std::vector<Function> functions;
  std::vector<Open> open;
  std::ifstream file(path);
  std::string line, head;
  for (int number = 1; std::getline(file, line); ++number) {
    for (const char c : code_of(line)) {
      if (c == '{') {
        open.push_back({number, is_head(head), head.substr(head.find_last_of('\n') + 1)});
      } else if (c == '}' && !open.empty()) {
        const Open last = open.back();
        open.pop_back();
        const bool is_inner =
            std::any_of(open.begin(), open.end(), [](const Open& outer) { return outer.is_function; });
        if (last.is_function && !is_inner)
          functions.push_back({last.head, last.line, number - last.line + 1});
      } else if (c != ';') {
        head += c;
        continue;
      }
      head.clear();
    }
    if (!head.empty()) head += '\n';
  }
  return functions;
}

TEST(Functions, HaveFewerThanSixtyLines) {
  std::size_t seen = 0;
  for (const char* folder : {"core", "app", "ui"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(CLOTHLAB_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      for (const Function& function : functions_of(entry.path())) {
        ++seen;
        EXPECT_LT(function.lines, 60) << entry.path() << ", line " << function.first << ": " << function.head;
      }
    }
  EXPECT_GT(seen, 3000u);
}

// The linker keeps one of two inline things of one name, which may be the wrong one for half of the program.
TEST(Headers, NeverDefineTwoThingsOfOneName) {
  static const std::regex space(R"(^namespace ([a-z_:]*) ?\{)");
  static const std::regex type(R"(^(struct|class|enum class|enum) ([A-Za-z]+)( : .*)? \{)");
  static const std::regex variable(R"(^inline (constexpr|const) .*?([A-Za-z_]+)(\[.*\])?( = |\{).*)");
  std::map<std::string, fs::path> defined;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(CLOTHLAB_SOURCE_DIR) / "core")) {
    if (entry.path().extension() != ".h") continue;
    std::ifstream file(entry.path());
    std::string scope;
    for (std::string line; std::getline(file, line);) {
      std::smatch found;
      if (std::regex_search(line, found, space)) scope += found[1].str() + "/";
      if (scope.find("//") != std::string::npos || scope.starts_with("/")) break;  // internal to each source
      const bool is_type = std::regex_search(line, found, type);
      if (!is_type && !std::regex_search(line, found, variable)) continue;
      const auto [place, is_new] = defined.emplace(scope + found[2].str(), entry.path());
      EXPECT_TRUE(is_new) << found[2] << " in " << entry.path() << " and in " << place->second;
    }
  }
  EXPECT_GT(defined.size(), 400u);
}

TEST(Documentation, NamesSourcesThatThereAre) {
  static const std::regex path("\\b(core|app|ui|tests)/[a-z_/]+\\.(h|cpp)\\b");
  const fs::path root = CLOTHLAB_SOURCE_DIR;
  std::size_t seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() != ".md") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      for (std::sregex_iterator it(line.begin(), line.end(), path), end; it != end; ++it) {
        ++seen;
        EXPECT_TRUE(fs::exists(root / it->str())) << entry.path() << " names " << it->str();
      }
  }
  EXPECT_GT(seen, 50u);
}

TEST(Functions, AreFoundWithTheirLengths) {
  const fs::path path = fs::temp_directory_path() / "clothlab_source_rules.cpp";
  std::ofstream(path)
      << "namespace a {\nint one(int x) {\n  if (x) {\n    return 1;  // }\n  }\n  return 2;\n}\n"
         "struct B {\n  void two() const { use(\"{\"); }\n};\n}\n";
  const std::vector<Function> functions = functions_of(path);
  fs::remove(path);
  ASSERT_EQ(functions.size(), 2u);
  EXPECT_EQ(functions[0].lines, 6);
  EXPECT_EQ(functions[0].first, 2);
  EXPECT_EQ(functions[1].lines, 1);
}

}  // namespace
}  // namespace cloth::test::source_rules_test
