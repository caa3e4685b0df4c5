#include "io/line_file.h"

#include <fcntl.h>
#include <unistd.h>

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
  if (const auto error = close()) return error;
  path_ = path;
  written_ = 0;
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return failure();
  return std::nullopt;
}

std::optional<IoError> LineFile::add(const std::string& line) {
  pending_ += line;
  pending_ += '\n';
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
      if (done > 0 && whole != std::string::npos) written_ += static_cast<std::int64_t>(whole) + 1;
      // Failing to take the line back as well leaves nothing better to do: the first error is the one to
      // report.
      [[maybe_unused]] const int truncated = ::ftruncate(descriptor_, written_);
      ::lseek(descriptor_, written_, SEEK_SET);
      pending_.clear();
      return error;
    }
  }
  written_ += static_cast<std::int64_t>(done);
  pending_.clear();
  return std::nullopt;
}

std::optional<IoError> LineFile::close() {
  if (descriptor_ < 0) return std::nullopt;
  auto error = flush();
  if (::close(descriptor_) != 0 && !error) error = failure();
  descriptor_ = -1;
  return error;
}

}  // namespace cloth
