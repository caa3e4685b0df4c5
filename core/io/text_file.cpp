#include "io/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <vector>

#include "io/process.h"

namespace cloth {
namespace fs = std::filesystem;
namespace {

constexpr const char* draft_end = ".part";

}  // namespace

IoError system_error(const fs::path& path) {
  return {path, std::strerror(errno)};
}

std::optional<IoError> make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return IoError{folder, error.message()};
  if (!fs::is_directory(folder, error)) return IoError{folder, "is not a folder"};
  return std::nullopt;
}

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::size_t write_bytes(int descriptor, std::string_view text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t part = ::write(descriptor, text.data() + done, text.size() - done);
    if (part < 0 && errno == EINTR) continue;
    if (part == 0) errno = ENOSPC;
    if (part <= 0) break;
    done += static_cast<std::size_t>(part);
  }
  return done;
}

bool write_to_disk(int descriptor, std::string_view text) {
  // Some things that can be written to, such as a pipe, cannot be waited for.
  return write_bytes(descriptor, text) == text.size() && (::fsync(descriptor) == 0 || errno == EINVAL);
}

Draft begin_draft(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  Draft draft;
  do {  // another machine may have a process of this number
    draft.path = path;
    draft.path += fmt::format(".{}.{}{}", ::getpid(), count++, draft_end);
    draft.descriptor = ::open(draft.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (draft.descriptor < 0 && errno == EEXIST);
  return draft;
}

std::optional<IoError> remove_drafts_of(const fs::path& path) {
  const std::string begin = path.filename().string() + ".";
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
    const std::string name = file->path().filename().string();
    std::error_code refused;
    if (name.starts_with(begin) && name.ends_with(draft_end) && !fs::remove(file->path(), refused) && refused)
      return IoError{file->path(), refused.message()};
  }
  if (error) return IoError{folder, error.message()};
  return std::nullopt;
}

std::optional<IoError> write_text_file(const fs::path& path, const std::string& text,
                                       const struct stat* old) {
  const auto [draft, descriptor] = begin_draft(path);
  if (descriptor < 0) return system_error(path);
  if (old) {
    // Who may not give a file away writes one of his own; the mode comes after, since a new owner clears
    // bits.
    [[maybe_unused]] const int owned = ::fchown(descriptor, old->st_uid, old->st_gid);
    ::fchmod(descriptor, old->st_mode & 07777);
  }
  std::optional<IoError> failure;
  if (!write_to_disk(descriptor, text)) failure = system_error(path);
  if (::close(descriptor) != 0 && !failure) failure = system_error(path);
  if (!failure && ::rename(draft.c_str(), path.c_str()) != 0) failure = system_error(path);
  if (failure)
    ::unlink(draft.c_str());
  else
    sync_folder(path.parent_path());
  return failure;
}

std::optional<IoError> read_text_file(const fs::path& path, std::string& text, std::size_t largest) {
  std::error_code error;
  if (fs::is_directory(path, error)) return IoError{path, "is a folder"};
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return system_error(path);
  text.clear();
  std::vector<char> block(std::size_t{1} << 20);
  std::optional<IoError> problem;
  for (ssize_t part = 1; part != 0 && !problem;) {
    part = ::read(file, block.data(), block.size());
    if (part < 0 && errno == EINTR) continue;
    if (part < 0)
      problem = system_error(path);
    else if (text.size() + static_cast<std::size_t>(part) > largest)
      problem = IoError{path, fmt::format("is too large: more than {} MB are not read", largest >> 20)};
    else
      text.append(block.data(), static_cast<std::size_t>(part));
  }
  ::close(file);
  return problem;
}

}  // namespace cloth
