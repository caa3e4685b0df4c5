// CSV after RFC 4180.
#pragma once

#include <string>
#include <vector>

#include "io/line_file.h"

namespace cloth {

class CsvFile {
 public:
  /// Makes or empties the file and writes the header row.
  std::optional<IoError> open(const std::filesystem::path& path, const std::vector<std::string>& header);

  /// Goes on at the end of a table that is there.
  std::optional<IoError> open_at_end(const std::filesystem::path& path) { return lines_.open_at_end(path); }

  /// Keeps one row until the next flush, or until enough have gathered.
  std::optional<IoError> add(const std::vector<std::string>& fields);

  std::optional<IoError> flush() { return lines_.flush(); }
  std::optional<IoError> close() { return lines_.close(); }
  bool is_open() const { return lines_.is_open(); }
  FileDigest digest() const { return lines_.digest(); }

 private:
  LineFile lines_;
};

/// 17 significant digits and a decimal point, whatever the locale: reads back to the same bits.
std::string csv_number(double value);

/// Quotes a field where RFC 4180 asks for it.
std::string csv_field(const std::string& text);

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// With `end` behind each row, the header's too.
std::string csv_text(const CsvTable& table, const char* end);

/// Reads RFC 4180 text; a last line without an end counts as a row.
CsvTable parse_csv(const std::string& text);

}  // namespace cloth
