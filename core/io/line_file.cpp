#include "io/line_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace cloth {
namespace {

constexpr std::size_t flush_at = 1 << 16;  // bytes

}  // namespace

LineFile::~LineFile() {
  flush();
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<IoError> LineFile::failure() const {
  return IoError{path_, std::strerror(errno)};
}

std::optional<IoError> LineFile::open(const std::filesystem::path& path) {
  return open(path, O_CREAT | O_TRUNC);
}

std::optional<IoError> LineFile::open_at_end(const std::filesystem::path& path) {
  if (auto error = open(path, 0)) return error;
  const off_t end = ::lseek(descriptor_, 0, SEEK_END);
  if (end < 0) return failure();
  written_ = end;
  return std::nullopt;
}

std::optional<IoError> LineFile::open(const std::filesystem::path& path, int flags) {
  if (const auto error = close()) return error;
  path_ = path;
  written_ = lines_ = 0;
  hash_ = {};
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  if (descriptor_ < 0) return failure();
  return std::nullopt;
}

std::optional<IoError> LineFile::add(const std::string& line) {
  pending_ += line;
  pending_ += '\n';
  ++pending_lines_;
  return pending_.size() >= flush_at ? flush() : std::nullopt;
}

std::optional<IoError> LineFile::flush() {
  std::size_t done = 0;
  while (descriptor_ >= 0 && done < pending_.size()) {
    const ssize_t part = ::write(descriptor_, pending_.data() + done, pending_.size() - done);
    if (part > 0) {
      done += static_cast<std::size_t>(part);
    } else if (part < 0 && errno != EINTR) {
      const auto error = failure();
      const std::size_t whole = pending_.rfind('\n', done == 0 ? 0 : done - 1);
      if (done > 0 && whole != std::string::npos) {
        const std::string kept = pending_.substr(0, whole + 1);
        written_ += static_cast<std::int64_t>(kept.size());
        lines_ += std::count(kept.begin(), kept.end(), '\n');
        hash_.add(kept);
      }
      // Failing to take the line back as well leaves nothing better to do: the first error is the one to
      // report.
      [[maybe_unused]] const int truncated = ::ftruncate(descriptor_, written_);
      ::lseek(descriptor_, written_, SEEK_SET);
      pending_.clear();
      pending_lines_ = 0;
      return error;
    }
  }
  written_ += static_cast<std::int64_t>(done);
  lines_ += pending_lines_;
  hash_.add(pending_);
  pending_.clear();
  pending_lines_ = 0;
  return std::nullopt;
}

std::optional<IoError> LineFile::close() {
  if (descriptor_ < 0) return std::nullopt;
  auto error = flush();
  // Some things that can be written to, such as a pipe, cannot be waited for.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && !error) error = failure();
  if (::close(descriptor_) != 0 && !error) error = failure();
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
