#include "io/user_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <variant>

namespace cloth {
namespace {

constexpr int max_links = 40;  // that Linux follows

/// Where a path leads, the last name included, whether or not something is there.
std::variant<std::filesystem::path, IoError> target_of(const std::filesystem::path& path) {
  std::filesystem::path at = path;
  for (int links = 0; links < max_links; ++links) {
    std::error_code error;
    const auto next = std::filesystem::read_symlink(at, error);
    if (error == std::errc::too_many_symbolic_link_levels) break;
    if (error) return at;  // no link
    at = next.is_absolute() ? next : at.parent_path() / next;
  }
  errno = ELOOP;
  return system_error(path);
}

const char* kind_of_file(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

/// Over what is there, which other names lead to as well. What did not go through is taken back.
std::optional<IoError> overwrite(const std::filesystem::path& target, const std::string& text) {
  std::string before;
  if (auto error = read_text_file(target, before)) return error;
  const int file = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return system_error(target);
  const auto holds = [&](const std::string& content) {
    return write_to_disk(file, content) && ::ftruncate(file, static_cast<off_t>(content.size())) == 0;
  };
  std::optional<IoError> error;
  if (!holds(text)) {
    error = system_error(target);
    ::lseek(file, 0, SEEK_SET);
    // Failing in this as well leaves nothing better to do: the first error is the one to report.
    [[maybe_unused]] const bool taken_back = holds(before);
  }
  ::close(file);
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
      found.problem = IoError{
          target, std::string("is ") + kind_of_file(found.facts.st_mode) + ": the result goes into a file"};
    else if (::access(target.c_str(), W_OK) != 0)
      found.problem = system_error(target);
  } else if (errno != ENOENT) {
    found.problem = system_error(target);
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
  return write_text_file(target, text, found.there ? &found.facts : nullptr);
}

}  // namespace cloth
