// The folder of a sweep, which many processes on many machines may fill at once without a lock:
//
//     sweep.json       the plan, and the engine that its points are made by; the first process writes it
//     shards/          a file for each attempt, see sweep_rows.h
//     sweep.csv, ...   made of them by a merge, at any time
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/text_file.h"
#include "sweep/sweep_plan.h"
#include "sweep/sweep_rows.h"

namespace cloth {

inline constexpr const char* sweep_folder_format = "clothlab/sweep-folder/1";
inline constexpr const char* sweep_index_name = "sweep.json";
inline constexpr const char* shard_folder_name = "shards";

struct SweepFolder {
  std::filesystem::path path{};
  SweepPlan plan{};  ///< its files are named as seen from the folder
  std::string hash{};
  std::string version{}, instruction_set{};  ///< of the engine

  std::filesystem::path shards() const { return path / shard_folder_name; }
};

/// A folder, or why there is none: exactly one of the three is there.
struct SweepFolderReading {
  std::optional<SweepFolder> folder{};
  std::vector<Problem> problems{};
  std::optional<IoError> error{};
};

/// Makes the folder for the plan, or takes the one that holds it. One of another plan, engine or instruction
/// set is refused, as is one that holds other results.
SweepFolderReading take_sweep_folder(const std::filesystem::path& path, const SweepPlan& plan);

/// The one that is there, for more points by this engine; refused where that is another one.
SweepFolderReading resume_sweep_folder(const std::filesystem::path& path);

/// One that is there, whatever engine made it.
SweepFolderReading read_sweep_folder(const std::filesystem::path& path);

/// The shard files, by name; only those that can have points of `shard` where that is given. One of another
/// plan is an error.
struct ShardFiles {
  std::vector<ShardFile> files{};
  std::optional<Shard> latest{};  ///< of the file that was written last
  std::optional<IoError> error{};
};
ShardFiles read_shard_files(const SweepFolder& folder, const std::optional<Shard>& shard = {});

}  // namespace cloth
