// Temporary folders and the files in them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/csv.h"

namespace cloth::test {

/// Made empty, removed with all it holds at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string content_of(const std::filesystem::path& file);

/// The named column as numbers. Fails the test if there is none.
std::vector<double> column_of(const CsvTable& table, const std::string& name);

/// The table without one column.
CsvTable without_column(CsvTable table, const std::string& name);

}  // namespace cloth::test
