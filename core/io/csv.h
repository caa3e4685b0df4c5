// A CSV file that is valid whenever a process ends: whole rows are written at once, and a row that no longer
// fits on the disk is taken back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cloth {

/// A file that could not be read or written: which, and what the system said.
struct IoError {
  std::filesystem::path path;
  std::string message;
  std::string text() const { return path.string() + ": " + message; }
};

class CsvFile {
 public:
  CsvFile() = default;
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  /// Makes or empties the file and writes the header row.
  std::optional<IoError> open(const std::filesystem::path& path, const std::vector<std::string>& header);

  /// Keeps one row until the next flush, or until enough have gathered.
  std::optional<IoError> add(const std::vector<std::string>& fields);

  std::optional<IoError> flush();
  std::optional<IoError> close();
  bool is_open() const { return descriptor_ >= 0; }

 private:
  std::optional<IoError> failure() const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t written_ = 0;  ///< bytes, whole rows only
  std::string pending_;
};

/// 17 significant digits and a decimal point, whatever the locale: reads back to the same bits.
std::string csv_number(double value);

/// Quotes a field where RFC 4180 asks for it.
std::string csv_field(const std::string& text);

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// Reads RFC 4180 text; a last line without an end counts as a row.
CsvTable parse_csv(const std::string& text);

}  // namespace cloth
