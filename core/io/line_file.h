// A text file that is valid whenever a process ends: whole lines are written at once, and a line that no
// longer fits on the disk is taken back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/file_digest.h"
#include "io/fnv_hash.h"
#include "io/text_file.h"

namespace cloth {

class LineFile {
 public:
  LineFile() = default;
  ~LineFile();
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;

  /// Makes or empties the file.
  std::optional<IoError> open(const std::filesystem::path& path);

  /// Makes the file; an error where there is one.
  std::optional<IoError> open_new(const std::filesystem::path& path);

  /// Goes on at the end of a file of whole lines; the digest is then of what is added.
  std::optional<IoError> open_at_end(const std::filesystem::path& path);

  /// Keeps one line (without its end) until the next flush, or until enough have gathered.
  std::optional<IoError> add(const std::string& line);

  /// Hands what has gathered to the system: it outlives this process.
  std::optional<IoError> flush();
  /// Waits until what was flushed is on the disk: it outlives a loss of power. Another thread may go on
  /// adding and flushing meanwhile, but not close.
  std::optional<IoError> sync() const;
  /// Both, and no more lines follow.
  std::optional<IoError> close();
  bool is_open() const { return descriptor_ >= 0; }

  /// Of the whole lines that were written; `rows` counts all but the first, the header.
  FileDigest digest() const;

 private:
  std::optional<IoError> open(const std::filesystem::path& path, int flags);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t written_ = 0;  ///< bytes, whole lines only
  std::int64_t lines_ = 0, pending_lines_ = 0;
  FnvHash hash_;  ///< of what is written
  std::string pending_;
};

}  // namespace cloth
