// A folder of results: one run, comparison or study and nothing older, written by one process at a time.
//
//     ResultFolder folder;
//     if (auto error = folder.claim("results", {.kind = "run", .files = {...}, .inputs = {...}})) ...
//     if (auto error = folder.write("scene.json", text)) ...
//     if (auto error = folder.add("record.csv")) ...            // then write it line by line
//     folder.note(record.digest());                             // once it is closed
//     if (auto error = folder.finish("summary.json", text)) ... // last
//
// While it is written, a file ".clothlab" in it is locked and lists what was put there. It stays where a
// process is killed, so that the next one knows which files are ours; afterwards the index file
// (summary.json, study.json) lists them. Files that are not ours are never replaced.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/file_digest.h"
#include "io/line_file.h"

namespace cloth {

/// What somebody wants a folder for.
struct FolderUse {
  std::string kind;                             ///< "run", "comparison", "stability", ...
  std::vector<std::string> files{};             ///< names that it will have
  std::vector<std::filesystem::path> inputs{};  ///< that are read: they must not be replaced
};

class ResultFolder {
 public:
  ResultFolder() = default;
  ~ResultFolder() { release(); }
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// lock(), then begin_anew().
  std::optional<IoError> claim(const std::filesystem::path& folder, const FolderUse& use);

  /// Makes the folder and keeps others from writing to it; changes nothing in it yet. Refuses where another
  /// process writes, where an input or a file that is not ours would be replaced, and where the folder holds
  /// results of another kind.
  std::optional<IoError> lock(const std::filesystem::path& folder, const FolderUse& use);

  /// Removes what an earlier run or study left: the index first, so that it never describes other tables.
  std::optional<IoError> begin_anew();

  /// Keeps it: its files count as this one's.
  std::optional<IoError> go_on();

  bool is_open() const { return descriptor_ >= 0; }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Says that a file of this name follows; refuses where there is one that is not ours.
  std::optional<IoError> add(const std::string& name);

  /// Adds a file and writes it whole: it is old or new, never half.
  std::optional<IoError> write(const std::string& name, const std::string& text, bool is_table = false);

  /// Takes a file of this run or study away again: it was of use only while the rest was made.
  std::optional<IoError> remove(const std::string& name);

  /// What a file that was written line by line holds.
  void note(const FileDigest& digest);
  const std::vector<FileDigest>& digests() const { return digests_; }

  /// Writes the index, which describes the files, after all of them, and releases the folder.
  std::optional<IoError> finish(const std::string& index, const std::string& text);

  /// Lets others write. Without finish() the list of files stays.
  void release();

 private:
  std::optional<IoError> refusal(const FolderUse& use) const;
  std::optional<IoError> note_line(const std::string& line);
  void look_for_old_files();

  std::filesystem::path path_;
  std::string kind_;
  int descriptor_ = -1;                 ///< of the locked list
  bool made_list_ = false;              ///< there was none before
  bool changed_ = false;                ///< anything, since it was locked
  std::string old_kind_;                ///< of the results that were there; empty: none
  std::vector<std::string> old_files_;  ///< index files first
  std::vector<std::string> files_;      ///< of this run or study
  std::vector<FileDigest> digests_;
};

/// Whether both name one file, through links too. A file that is not there is no file.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Refuses to write `output` where it is one of the inputs.
std::optional<IoError> overwritten_input(const std::filesystem::path& output,
                                         const std::vector<std::filesystem::path>& inputs);

}  // namespace cloth
