#include "support/files.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace cloth::test {
namespace {

std::ptrdiff_t index_of(const CsvTable& table, const std::string& name) {
  const auto found = std::find(table.header.begin(), table.header.end(), name);
  if (found == table.header.end()) throw std::runtime_error("no column " + name);
  return found - table.header.begin();
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "clothlab-test-XXXXXX").string();
  if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder: " + pattern);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

std::vector<double> column_of(const CsvTable& table, const std::string& name) {
  const auto index = static_cast<std::size_t>(index_of(table, name));
  std::vector<double> numbers;
  for (const auto& row : table.rows) numbers.push_back(std::strtod(row.at(index).c_str(), nullptr));
  return numbers;
}

CsvTable without_column(CsvTable table, const std::string& name) {
  const auto index = index_of(table, name);
  table.header.erase(table.header.begin() + index);
  for (auto& row : table.rows) row.erase(row.begin() + index);
  return table;
}

}  // namespace cloth::test
