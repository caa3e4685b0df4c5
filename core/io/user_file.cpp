#include "io/user_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <variant>

#include "io/run_folder.h"

namespace cloth {
namespace {

constexpr int most_links = 40;  // that Linux follows

IoError failure_of(const std::filesystem::path& path, int error) {
  return {path, std::strerror(error)};
}

/// Where a path leads, the last name included, whether or not something is there.
std::variant<std::filesystem::path, IoError> target_of(const std::filesystem::path& path) {
  std::filesystem::path at = path;
  for (int links = 0; links < most_links; ++links) {
    std::error_code error;
    const auto next = std::filesystem::read_symlink(at, error);
    if (error == std::errc::too_many_symbolic_link_levels) break;
    if (error) return at;  // no link
    at = next.is_absolute() ? next : at.parent_path() / next;
  }
  return failure_of(path, ELOOP);
}

const char* kind_of_file(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

/// A descriptor that is closed at the end.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags, mode_t mode = 0)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }

  /// Writes all of it to the disk. False with errno.
  bool write(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t part = ::write(number_, text.data() + done, text.size() - done);
      if (part < 0 && errno != EINTR) return false;
      if (part > 0) done += static_cast<std::size_t>(part);
    }
    return ::fsync(number_) == 0;
  }

 private:
  int number_;
};

/// Over what is there, which other names lead to as well. What did not go through is taken back.
std::optional<IoError> overwrite(const std::filesystem::path& target, const std::string& text) {
  std::string before;
  if (auto error = read_text_file(target, before)) return error;
  Descriptor file(target, O_WRONLY);
  if (!file.is_open()) return failure_of(target, errno);
  if (file.write(text) && ::ftruncate(file.number(), static_cast<off_t>(text.size())) == 0)
    return std::nullopt;
  const IoError error = failure_of(target, errno);
  ::lseek(file.number(), 0, SEEK_SET);
  // Failing in this as well leaves nothing better to do: the first error is the one to report.
  [[maybe_unused]] const bool taken_back =
      file.write(before) && ::ftruncate(file.number(), static_cast<off_t>(before.size())) == 0;
  return error;
}

/// By a file beside it that takes its name.
std::optional<IoError> replace(const std::filesystem::path& target, const std::string& text,
                               const struct stat* old) {
  std::filesystem::path draft = target;
  draft += ".part";
  ::unlink(draft.c_str());
  Descriptor file(draft, O_WRONLY | O_CREAT | O_EXCL, 0666);
  if (!file.is_open()) return failure_of(target, errno);
  if (old) {
    // Who may not give a file away writes one of his own; the mode comes after, since a new owner clears bits.
    [[maybe_unused]] const int owned = ::fchown(file.number(), old->st_uid, old->st_gid);
    ::fchmod(file.number(), old->st_mode & 07777);
  }
  if (file.write(text) && ::rename(draft.c_str(), target.c_str()) == 0) return std::nullopt;
  const IoError error = failure_of(target, errno);
  ::unlink(draft.c_str());
  return error;
}

/// What is at `target`, if anything, or why it cannot be written.
struct Found {
  bool there = false;
  struct stat facts {};
  std::optional<IoError> problem;
};

Found look_at(const std::filesystem::path& target) {
  Found found;
  const std::filesystem::path folder = target.parent_path();
  std::error_code error;
  if (!folder.empty() && !std::filesystem::is_directory(folder, error)) {
    found.problem = IoError{target, "there is no folder " + folder.string()};
  } else if (::stat(target.c_str(), &found.facts) == 0) {
    found.there = true;
    if (!S_ISREG(found.facts.st_mode))
      found.problem = IoError{target, std::string("is ") + kind_of_file(found.facts.st_mode) +
                                          ": the result goes into a file"};
    else if (::access(target.c_str(), W_OK) != 0)
      found.problem = failure_of(target, errno);
  } else if (errno != ENOENT) {
    found.problem = failure_of(target, errno);
  }
  return found;
}

}  // namespace

std::optional<IoError> problem_of_user_file(const std::filesystem::path& path) {
  const auto target = target_of(path);
  if (const auto* error = std::get_if<IoError>(&target)) return *error;
  return look_at(std::get<std::filesystem::path>(target)).problem;
}

std::optional<IoError> write_user_file(const std::filesystem::path& path, const std::string& text) {
  const auto followed = target_of(path);
  if (const auto* error = std::get_if<IoError>(&followed)) return *error;
  const auto& target = std::get<std::filesystem::path>(followed);
  const Found found = look_at(target);
  if (found.problem) return found.problem;
  if (found.there && found.facts.st_nlink > 1) return overwrite(target, text);
  return replace(target, text, found.there ? &found.facts : nullptr);
}

}  // namespace cloth
