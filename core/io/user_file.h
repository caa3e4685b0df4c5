// A file whose name somebody gave for one result, wherever it lies: links to it stay links, and it keeps its
// mode. The files of a results folder are the program's own; those go through write_text_file().
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/text_file.h"

namespace cloth {

/// Why `path` could not be written: its folder is missing, its links lead in a circle, or there is something
/// that is not a plain file, as a device or a pipe. For a look before a long run.
std::optional<IoError> problem_of_user_file(const std::filesystem::path& path);

/// Writes to what `path` leads to over symbolic links. The file there is old or new, never half, keeps its
/// mode, and other hard links to it show the new content.
std::optional<IoError> write_user_file(const std::filesystem::path& path, const std::string& text);

}  // namespace cloth
