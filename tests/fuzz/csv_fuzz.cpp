// The reader of CSV: what it read, written and read again, is the same.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/csv.h"

namespace {

std::string written(const cloth::CsvTable& table) {
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string field = cloth::csv_field(row[k]);
      // A line of one empty field is an empty line: in quotes it is a field all the same.
      text += (k > 0 ? "," : "") + (row.size() == 1 && field.empty() ? std::string("\"\"") : field);
    }
    text += "\r\n";
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const cloth::CsvTable table = cloth::parse_csv(std::string(reinterpret_cast<const char*>(data), size));
  if (table.header.empty()) return 0;
  const cloth::CsvTable again = cloth::parse_csv(written(table));
  if (again.header != table.header || again.rows != table.rows) std::abort();
  return 0;
}
