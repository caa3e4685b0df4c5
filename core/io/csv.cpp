#include "io/csv.h"

#include <fmt/format.h>

namespace cloth {
namespace {

std::string line_of(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) line += (i > 0 ? "," : "") + csv_field(fields[i]);
  return line;
}

}  // namespace

std::optional<IoError> CsvFile::open(const std::filesystem::path& path,
                                     const std::vector<std::string>& header) {
  if (auto error = lines_.open(path)) return error;
  if (auto error = lines_.add(line_of(header))) return error;
  return lines_.flush();
}

std::optional<IoError> CsvFile::add(const std::vector<std::string>& fields) {
  return lines_.add(line_of(fields));
}

std::string csv_number(double value) {
  return fmt::format("{:.17g}", value);
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_text(const CsvTable& table, const char* end) {
  std::string text = line_of(table.header) + end;
  for (const auto& row : table.rows) text += line_of(row) + end;
  return text;
}

CsvTable parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row;
  std::string field;
  bool quoted = false, row_started = false;
  const auto end_row = [&] {
    row.push_back(std::move(field));
    rows.push_back(std::move(row));
    row.clear(), field.clear();
    row_started = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"')
        field += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        field += text[++i];
      else
        quoted = false;
      continue;
    }
    if (c == '\r') continue;
    if (c == '\n') {
      end_row();
      continue;
    }
    row_started = true;
    if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      row.push_back(std::move(field));
      field.clear();
    } else {
      field += c;
    }
  }
  if (row_started) end_row();
  CsvTable table;
  if (rows.empty()) return table;
  table.header = rows.front();
  table.rows.assign(rows.begin() + 1, rows.end());
  return table;
}

}  // namespace cloth
