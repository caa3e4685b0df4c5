// A comparison run to its duration, without a window: files, results and what a report draws.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/ranking.h"
#include "io/result_folder.h"

namespace cloth {

struct ComparisonOptions {
  std::filesystem::path folder;  ///< empty: leave nothing on disk
  int threads = 1;               ///< 1 keeps the panes' costs free of each other
  /// Told the simulated time after each common time, and asked before each step, from any of the threads;
  /// false stops the run.
  std::function<void(double time)> progress;
  std::function<bool()> may_go_on;
  ResultFolder* results = nullptr;  ///< claimed already; else `folder` is
};

/// What charts draw: a value for each common time that the pane reached.
struct PaneSeries {
  std::vector<double> time;  ///< s
  std::vector<double> energy_error, max_strain;
  std::vector<double> difference_time, rms;  ///< s, m; no difference, no point
};

struct ComparisonRun {
  Comparison comparison;  ///< as it was run
  std::vector<PaneResult> panes;
  std::vector<PaneSeries> series;  ///< one of each pane
  std::string reference;           ///< reference_text
  std::string check;               ///< what a controlled reference is checked by
  std::string reference_failure;   ///< not empty: the reference stopped, and why
  std::string notice;  ///< what is not as asked for in all panes, or in the reference; empty: nothing
  bool reference_rate_kept = true;
  double reference_wall = 0;    ///< s, of a controlled reference
  std::optional<double> floor;  ///< m, RMS at the end: see LockStep::floor
  double largest_floor = 0;     ///< m, of all common times
  PaneSeries floor_series;      ///< its rms
  int particles = 0, columns = 0;
  double simulated = 0;  ///< s, the last common time
  int threads = 1;
  bool stopped = false;
  std::optional<IoError> io_error;  ///< what was written before it is valid
  std::vector<FileDigest> files{};  ///< that lie beside summary.json

  /// Whether there is what was asked for: a pane that reached the end, and a reference if one was wanted.
  bool has_result() const;

  /// Whether every pane, and a controlled reference, kept its deformation rate.
  bool rate_is_kept() const;
};

/// Precondition: find_problems(comparison) is empty.
ComparisonRun run_comparison(const Comparison& comparison, const ComparisonOptions& options);

}  // namespace cloth
