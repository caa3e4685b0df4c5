// The reader of studies: study.json and its tables. An input is the files of a folder, each after a line
// "=== name"; what stands before the first of them is study.json.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzz/small_scene.h"
#include "io/text_file.h"
#include "study/study_folder.h"

namespace {

namespace fs = std::filesystem;

const fs::path& scratch_folder() {
  static const fs::path folder = [] {
    std::string name = (fs::temp_directory_path() / "clothlab-fuzz-XXXXXX").string();
    if (!::mkdtemp(name.data())) std::abort();
    std::atexit([] {
      std::error_code ignored;
      fs::remove_all(scratch_folder(), ignored);
    });
    return fs::path(name);
  }();
  return folder;
}

/// False where the input is not worth reading.
bool lay_out(std::string text) {
  const char* const tables[] = {
      "work_precision.csv", "work_precision_samples.csv", "stability.csv", "extremes.csv", "convergence.csv",
      "validation.csv",     "validation_points.csv",      "iterations.csv"};
  std::error_code ignored;
  for (const char* name : tables) fs::remove(scratch_folder() / name, ignored);
  std::string file = "study.json";
  const std::string mark = "\n=== ";
  while (true) {
    const std::size_t end = std::min(text.find(mark), text.size());
    const std::string content = text.substr(0, end);
    if (file == "study.json" && !cloth::test::stays_small(content)) return false;
    if (cloth::write_text_file(scratch_folder() / file, content)) std::abort();
    if (end == text.size()) return true;
    text.erase(0, end + mark.size());
    file.clear();
    for (const char* name : tables)
      if (text.rfind(std::string(name) + "\n", 0) == 0) file = name;
    if (file.empty()) return true;
    text.erase(0, file.size() + 1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!lay_out(std::string(reinterpret_cast<const char*>(data), size))) return -1;
  const cloth::StudyReading reading = cloth::read_study(scratch_folder());
  if (reading.study.has_value() != reading.problem.empty()) std::abort();
  if (!reading.study) return 0;
  const cloth::StudyTable& table = reading.study->table;
  cloth::study_text(table);
  cloth::study_json(table);
  cloth::study_csv(table);
  return 0;
}
