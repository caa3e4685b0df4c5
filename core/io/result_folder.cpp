#include "io/result_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "io/process.h"
#include "io/text_file.h"

namespace cloth {
namespace {

namespace fs = std::filesystem;

const char* const list_name = ".clothlab";
const char* const list_format = "clothlab folder 1";
constexpr std::array index_names{"study.json",    "summary.json", "reproduce.json", "bench.json",
                                 "measured.json", "strips.json",  "identified.json"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// There, be it a link that leads nowhere.
bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found && !error;
}

/// A file that can be read to its end at once: whoever opens a pipe waits for somebody to write to it.
bool is_readable(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// A list or an index is text that somebody may have changed: a name must stay within its folder.
bool is_plain(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name != list_name &&
         name.find('/') == std::string::npos;
}

void add_name(std::vector<std::string>& names, const std::string& name) {
  if (is_plain(name) && !contains(names, name)) names.push_back(name);
}

const char* const two_things = "a run and a study";  // as old versions let it happen

std::string with_article(const std::string& kind) {
  if (kind == two_things) return kind;
  return kind == "run" || kind == "comparison" || kind == "bench" ? "a " + kind : "a study (" + kind + ")";
}

struct OldResults {
  std::string kind;
  std::vector<std::string> files;
};

/// What a list of files that was left behind says.
void read_list(const std::string& text, OldResults& old) {
  std::istringstream lines(text);
  std::string line;
  if (!std::getline(lines, line) || line != list_format) return;
  while (std::getline(lines, line)) {
    if (line.rfind("kind ", 0) == 0) old.kind = line.substr(5);
    if (line.rfind("file ", 0) == 0) add_name(old.files, line.substr(5));
  }
}

/// The names that results without a list have, as versions before 0.3 left them.
std::vector<std::string> names_of_old_versions(const std::string& kind) {
  if (kind == "bench") return {};
  if (kind == "work-precision")
    return {"work_precision.csv", "work_precision_samples.csv", "work_precision.svg", "report.html"};
  if (kind == "stability") return {"stability.csv", "stability.svg", "report.html"};
  if (kind == "extremes") return {"extremes.csv", "extremes.svg", "report.html"};
  if (kind == "comparison")
    return {"comparison.json", "compare.csv", "A.csv",       "B.csv",      "C.csv",
            "D.csv",           "edits.jsonl", "compare.svg", "report.html"};
  return {"scene.json", "record.csv", "final_state.csv", "start_state.csv", "edits.jsonl"};
}

/// What an index file says, if it is one of ours.
void read_index(const fs::path& folder, const std::string& name, OldResults& old) {
  std::string text;
  if (!is_readable(folder / name) || read_text_file(folder / name, text)) return;
  const auto root = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!root.is_object()) return;
  const auto text_of = [&](const char* key) {
    const auto found = root.find(key);
    return found != root.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  if (text_of("program") != "clothlab" && text_of("format").rfind("clothlab/study/", 0) != 0) return;
  std::string kind = text_of("kind");
  if (kind.empty()) kind = name == "bench.json" ? "bench" : root.contains("panes") ? "comparison" : "run";
  old.kind = old.kind.empty() || old.kind == kind ? kind : two_things;
  old.files.insert(old.files.begin(), name);
  if (const auto files = root.find("files"); files != root.end() && files->is_object()) {
    for (const auto& [file, entry] : files->items()) add_name(old.files, file);
    return;
  }
  for (const std::string& file : names_of_old_versions(kind)) add_name(old.files, file);
  for (int part = 2; is_there(folder / fmt::format("record-{}.csv", part)); ++part)
    add_name(old.files, fmt::format("record-{}.csv", part));
}

/// A run that an old version began and did not end has neither.
void look_for_a_record(const fs::path& folder, OldResults& old) {
  std::string text;
  if (!is_readable(folder / "record.csv") || read_text_file(folder / "record.csv", text)) return;
  if (text.rfind("time_s,step,kinetic_J,", 0) != 0) return;
  old.kind = "run";
  old.files = names_of_old_versions(old.kind);
}

OldResults find_old_results(const fs::path& folder) {
  OldResults old;
  std::string text;
  for (const char* name : index_names) read_index(folder, name, old);
  if (is_readable(folder / list_name) && !read_text_file(folder / list_name, text)) read_list(text, old);
  if (old.files.empty()) look_for_a_record(folder, old);
  std::erase_if(old.files, [&](const std::string& name) { return !is_there(folder / name); });
  if (old.files.empty()) old.kind.clear();
  return old;
}

/// The process that a list names last, e.g. "process 4711 on host".
std::string writer_of(const fs::path& list) {
  std::string text, line, writer = "another process";
  if (!is_readable(list) || read_text_file(list, text)) return writer;
  std::istringstream lines(text);
  while (std::getline(lines, line))
    if (line.rfind("process ", 0) == 0) writer = line;
  return writer;
}

bool is_at(int descriptor, const fs::path& path) {
  struct stat open_file {
  }, named{};
  return ::fstat(descriptor, &open_file) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         open_file.st_dev == named.st_dev && open_file.st_ino == named.st_ino;
}

std::optional<IoError> remove_file(const fs::path& path) {
  if (::unlink(path.c_str()) == 0 || errno == ENOENT) return std::nullopt;
  return system_error(path);
}

}  // namespace

bool is_same_file(const fs::path& a, const fs::path& b) {
  struct stat first {
  }, second{};
  return ::stat(a.c_str(), &first) == 0 && ::stat(b.c_str(), &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

std::optional<IoError> overwritten_input(const fs::path& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs)
    if (is_same_file(output, input))
      return IoError{output,
                     "is read by this command as " + input.string() +
                         ", and writing would replace it: give another place for the results",
                     true};
  return std::nullopt;
}

void ResultFolder::look_for_old_files() {
  OldResults old = find_old_results(path_);
  old_kind_ = std::move(old.kind);
  old_files_ = std::move(old.files);
}

std::optional<IoError> ResultFolder::refusal(const FolderUse& use) const {
  for (const auto& names : {old_files_, use.files})
    for (const std::string& name : names)
      if (auto error = overwritten_input(path_ / name, use.inputs)) return error;
  if (!old_kind_.empty() && old_kind_ != use.kind)
    return IoError{path_,
                   fmt::format("holds {}, and a folder holds one thing: give another one, or remove it first",
                               with_article(old_kind_)),
                   true};
  for (const std::string& name : use.files)
    if (is_there(path_ / name) && !contains(old_files_, name))
      return IoError{path_ / name, "is not from this program, and would be replaced: give another folder",
                     true};
  return std::nullopt;
}

std::optional<IoError> ResultFolder::lock(const fs::path& folder, const FolderUse& use) {
  release();
  if (auto error = make_folder(folder)) return error;
  path_ = folder;
  kind_ = use.kind;
  files_.clear();
  digests_.clear();
  changed_ = false;
  look_for_old_files();
  if (auto error = refusal(use)) return error;  // before there is a list
  const fs::path list = path_ / list_name;
  do {  // whoever finishes removes the list: then it is another file that must be locked
    release();
    made_list_ = !is_there(list);
    descriptor_ = ::open(list.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor_ < 0) return system_error(list);
    if (!is_readable(list)) {
      ::close(std::exchange(descriptor_, -1));
      return IoError{list, "is not from this program", true};
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(std::exchange(descriptor_, -1));
      return IoError{path_, writer_of(list) + " is writing to this folder"};
    }  // a file system without locks is used without
  } while (!is_at(descriptor_, list));
  look_for_old_files();  // now that no other process changes them
  if (auto error = refusal(use)) {
    release();
    return error;
  }
  return std::nullopt;
}

std::optional<IoError> ResultFolder::note_line(const std::string& line) {
  changed_ = true;
  const std::string text = line + "\n";
  if (write_bytes(descriptor_, text) == text.size()) return std::nullopt;
  return system_error(path_ / list_name);
}

std::optional<IoError> ResultFolder::begin_anew() {
  changed_ = true;
  for (const std::string& name : old_files_) {
    if (auto error = remove_file(path_ / name)) return error;
    if (auto error = remove_drafts_of(path_ / name)) return error;
    if (std::find(index_names.begin(), index_names.end(), name) != index_names.end()) sync_folder(path_);
  }
  old_files_.clear();
  if (::ftruncate(descriptor_, 0) != 0) return system_error(path_ / list_name);
  return go_on();
}

std::optional<IoError> ResultFolder::go_on() {
  if (auto error = note_line(list_format + std::string("\nkind ") + kind_)) return error;
  if (auto error = note_line(fmt::format("process {} on {}", ::getpid(), host_name()))) return error;
  for (const std::string& name : old_files_) {
    files_.push_back(name);
    if (auto error = note_line("file " + name)) return error;
  }
  return std::nullopt;
}

std::optional<IoError> ResultFolder::claim(const fs::path& folder, const FolderUse& use) {
  if (auto error = lock(folder, use)) return error;
  return begin_anew();
}

std::optional<IoError> ResultFolder::add(const std::string& name) {
  if (contains(files_, name)) return std::nullopt;
  if (is_there(path_ / name))
    return IoError{path_ / name, "is not from this program, and would be replaced: give another folder",
                   true};
  files_.push_back(name);
  return note_line("file " + name);
}

std::optional<IoError> ResultFolder::write(const std::string& name, const std::string& text, bool is_table) {
  if (auto error = add(name)) return error;
  if (auto error = write_text_file(path_ / name, text)) return error;
  note(digest_of(name, text, is_table));
  return std::nullopt;
}

std::optional<IoError> ResultFolder::remove(const std::string& name) {
  if (!contains(files_, name)) return std::nullopt;
  std::erase_if(digests_, [&](const FileDigest& digest) { return digest.name == name; });
  return remove_file(path_ / name);
}

void ResultFolder::note(const FileDigest& digest) {
  std::erase_if(digests_, [&](const FileDigest& other) { return other.name == digest.name; });
  digests_.push_back(digest);
}

std::optional<IoError> ResultFolder::finish(const std::string& index, const std::string& text) {
  if (auto error = add(index)) return error;
  if (auto error = write_text_file(path_ / index, text)) return error;
  const auto error = remove_file(path_ / list_name);
  made_list_ = false;
  release();
  return error;
}

void ResultFolder::release() {
  if (descriptor_ < 0) return;
  if (made_list_ && !changed_) ::unlink((path_ / list_name).c_str());
  ::close(std::exchange(descriptor_, -1));
}

}  // namespace cloth
