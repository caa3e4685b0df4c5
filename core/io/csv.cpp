#include "io/csv.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace cloth {
namespace {

constexpr std::size_t flush_at = 1 << 16;  // bytes

std::string line_of(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (!line.empty()) line += ',';
    line += csv_field(field);
  }
  return line + "\n";
}

}  // namespace

CsvFile::~CsvFile() {
  flush();
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<IoError> CsvFile::failure() const {
  return IoError{path_, std::strerror(errno)};
}

std::optional<IoError> CsvFile::open(const std::filesystem::path& path,
                                     const std::vector<std::string>& header) {
  if (const auto error = close()) return error;
  path_ = path;
  written_ = 0;
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return failure();
  pending_ = line_of(header);
  return flush();
}

std::optional<IoError> CsvFile::add(const std::vector<std::string>& fields) {
  pending_ += line_of(fields);
  return pending_.size() >= flush_at ? flush() : std::nullopt;
}

std::optional<IoError> CsvFile::flush() {
  std::size_t done = 0;
  while (descriptor_ >= 0 && done < pending_.size()) {
    const ssize_t part = ::write(descriptor_, pending_.data() + done, pending_.size() - done);
    if (part > 0) {
      done += static_cast<std::size_t>(part);
    } else if (part < 0 && errno != EINTR) {
      const auto error = failure();
      const std::size_t whole = pending_.rfind('\n', done == 0 ? 0 : done - 1);
      if (done > 0 && whole != std::string::npos) written_ += static_cast<std::int64_t>(whole) + 1;
      // Failing to truncate as well leaves nothing better to do: the first error is the one to report.
      [[maybe_unused]] const int truncated = ::ftruncate(descriptor_, written_);
      pending_.clear();
      return error;
    }
  }
  written_ += static_cast<std::int64_t>(done);
  pending_.clear();
  return std::nullopt;
}

std::optional<IoError> CsvFile::close() {
  if (descriptor_ < 0) return std::nullopt;
  auto error = flush();
  if (::close(descriptor_) != 0 && !error) error = failure();
  descriptor_ = -1;
  return error;
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
