// A text file that is valid whenever a process ends: whole lines are written at once, and a line that no
// longer fits on the disk is taken back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace cloth {

/// A file that could not be read or written: which, and what the system said.
struct IoError {
  std::filesystem::path path;
  std::string message;
  std::string text() const { return path.string() + ": " + message; }
};

class LineFile {
 public:
  LineFile() = default;
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  /// Makes or empties the file.
  std::optional<IoError> open(const std::filesystem::path& path);

  /// Keeps one line (without its end) until the next flush, or until enough have gathered.
  std::optional<IoError> add(const std::string& line);

  std::optional<IoError> flush();
  std::optional<IoError> close();
  bool is_open() const { return descriptor_ >= 0; }

 private:
  std::optional<IoError> failure() const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t written_ = 0;  ///< bytes, whole lines only
  std::string pending_;
};

}  // namespace cloth
