// Text files that are read and written whole: a file that is written is old or new, never half.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cloth {

/// A file that could not be read or written: which, and what the system said.
struct IoError {
  std::filesystem::path path;
  std::string message;
  bool refused = false;  ///< not the system's fault: what was asked for would destroy something
  std::string text() const { return path.string() + ": " + message; }
};

/// The system's last error, as errno has it.
IoError system_error(const std::filesystem::path& path);

/// Makes the folder and those above it.
std::optional<IoError> make_folder(const std::filesystem::path& folder);

/// A new file beside another, to be renamed to it when it is whole: no other thread, process or machine has
/// it.
struct Draft {
  std::filesystem::path path;
  int descriptor = -1;  ///< open for writing; -1 with errno where it could not be made
};
Draft begin_draft(const std::filesystem::path& path);

/// Removes what writers of the file that were killed left beside it. Only where nobody else writes it now.
std::optional<IoError> remove_drafts_of(const std::filesystem::path& path);

/// Writes to a draft first, then renames: the file is old or new, never half, after a loss of power too and
/// with several writers, of whom the last one wins. The new file gets owner and mode of `old`, if that is
/// given.
std::optional<IoError> write_text_file(const std::filesystem::path& path, const std::string& text,
                                       const struct stat* old = nullptr);

/// Waits until the disk has what was renamed, made or removed in the folder, where the system can tell.
void sync_folder(const std::filesystem::path& folder);

/// Bytes of a scene, a session or a table that are read at most: far more than there is use for, and little
/// enough for what is made of them. A mesh may have more.
inline constexpr std::size_t largest_text = std::size_t{256} << 20, largest_mesh_text = std::size_t{2} << 30;

/// The whole file, or why not: it may have `largest` bytes.
std::optional<IoError> read_text_file(const std::filesystem::path& path, std::string& text,
                                      std::size_t largest = largest_text);

/// Writes to an open file through interruptions. The bytes written: fewer than all where errno says why.
std::size_t write_bytes(int descriptor, std::string_view text);

/// Writes all of it and waits for the disk, where the file is on one. False with errno.
bool write_to_disk(int descriptor, std::string_view text);

}  // namespace cloth
