#include "io/line_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <utility>

namespace cloth {
namespace {

constexpr std::size_t flush_at = 1 << 16;  // bytes

}  // namespace

LineFile::~LineFile() {
  flush();
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<IoError> LineFile::open(const std::filesystem::path& path) {
  return open(path, O_CREAT | O_TRUNC);
}

std::optional<IoError> LineFile::open_new(const std::filesystem::path& path) {
  return open(path, O_CREAT | O_EXCL | O_APPEND);
}

std::optional<IoError> LineFile::open_at_end(const std::filesystem::path& path) {
  if (auto error = open(path, 0)) return error;
  const off_t end = ::lseek(descriptor_, 0, SEEK_END);
  if (end < 0) return system_error(path_);
  written_ = end;
  return std::nullopt;
}

std::optional<IoError> LineFile::open(const std::filesystem::path& path, int flags) {
  if (const auto error = close()) return error;
  path_ = path;
  written_ = lines_ = 0;
  hash_ = {};
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  if (descriptor_ < 0) return system_error(path_);
  return std::nullopt;
}

std::optional<IoError> LineFile::add(const std::string& line) {
  pending_ += line;
  pending_ += '\n';
  ++pending_lines_;
  return pending_.size() >= flush_at ? flush() : std::nullopt;
}

std::optional<IoError> LineFile::flush() {
  if (descriptor_ < 0) return std::nullopt;
  const std::string text = std::exchange(pending_, {});
  const std::int64_t lines = std::exchange(pending_lines_, 0);
  std::optional<IoError> error;
  std::string_view kept = text;
  if (const std::size_t done = write_bytes(descriptor_, text); done < text.size()) {
    error = system_error(path_);
    kept = kept.substr(0, kept.substr(0, done).rfind('\n') + 1);  // npos + 1 is 0
  }
  written_ += static_cast<std::int64_t>(kept.size());
  lines_ += error ? std::count(kept.begin(), kept.end(), '\n') : lines;
  hash_.add(kept);
  if (!error) return std::nullopt;
  // Failing to take the rest of a line back leaves nothing better to do: the first error is the one to
  // report.
  [[maybe_unused]] const int truncated = ::ftruncate(descriptor_, written_);
  ::lseek(descriptor_, written_, SEEK_SET);
  return error;
}

std::optional<IoError> LineFile::sync() const {
  // Some things that can be written to, such as a pipe, cannot be waited for.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) return system_error(path_);
  return std::nullopt;
}

std::optional<IoError> LineFile::close() {
  if (descriptor_ < 0) return std::nullopt;
  auto error = flush();
  auto unsynced = sync();
  if (!error) error = std::move(unsynced);
  if (::close(descriptor_) != 0 && !error) error = system_error(path_);
  descriptor_ = -1;
  return error;
}

FileDigest LineFile::digest() const {
  return {.name = path_.filename().string(),
          .bytes = static_cast<std::uint64_t>(written_),
          .rows = std::max<std::int64_t>(0, lines_ - 1),
          .hash = hash_.text()};
}

}  // namespace cloth
