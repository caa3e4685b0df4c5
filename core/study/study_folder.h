// A study as a folder, written and read by the command line and the window alike: its tables as CSV, its
// diagram as SVG, report.html, and study.json, which says what was studied.
//
//     if (auto error = StudyRecorder::write(folder, map, command, wall)) ...  // study_recorder.h
//     StudyReading reading = read_study(folder);
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "io/file_digest.h"
#include "io/text_file.h"
#include "study/extremes.h"
#include "study/grid_convergence.h"
#include "study/iterations.h"
#include "study/stability_map.h"
#include "study/validation/validation.h"
#include "study/work_precision.h"

namespace cloth {

inline constexpr const char* study_format = "clothlab/study/1";

using StudyTable = std::variant<WorkPrecision, StabilityMap, ExtremesTable, GridConvergence, ValidationStudy,
                                IterationsStudy>;

struct Study {
  StudyTable table;
  std::string command;  ///< what made it
  double wall = 0;      ///< s
  std::string shard{};  ///< "2/3": it is this part alone; empty: the whole
};

/// "work-precision", "stability", "extremes", "convergence", "validation",
/// "iterations".
const char* kind_of(const StudyTable& table);

/// The scene that is studied; null for the fixed list of cases and for exact solutions.
const Scene* scene_of(const StudyTable& table);

/// The scene's title, or what else is studied.
std::string title_of(const StudyTable& table);

/// Whether it came to its end.
bool is_complete(const StudyTable& table);

/// study.json for a folder. Without `files`: of a study that is being made, whose tables still grow.
/// `states`: the file with the states of its reference, while it is kept. `shard`: it is that part alone.
std::string study_index(const std::filesystem::path& folder, const StudyTable& table,
                        const std::string& command, double wall, const std::vector<FileDigest>& files,
                        const std::optional<FileDigest>& states = {}, const std::optional<Shard>& shard = {});

/// The names of all files of such a study, study.json too.
std::vector<std::string> study_files(const StudyTable& table);

/// The same table that was written, but for the states of a reference and estimated costs. Exactly one of the
/// two is there.
struct StudyReading {
  std::optional<Study> study;
  std::string problem;   ///< file, place and rule
  bool is_lost = false;  ///< a file is not there, or not the one that study.json describes
};
StudyReading read_study(const std::filesystem::path& folder);

/// For a terminal, as the study's own command prints it.
std::string study_text(const StudyTable& table);
std::string study_json(const StudyTable& table);  ///< as with --json

/// The table that a folder of this kind keeps its rows in: "work_precision.csv".
const char* csv_name(const StudyTable& table);
std::string study_csv(const StudyTable& table);

}  // namespace cloth
