// Error against processor time of Clothlab's methods and of another library's on the same cloth: the same
// particles, masses, springs, pins and gravity, the same simulated time, errors against one reference by the
// norm of the work-precision study, one thread, timed in turns.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/speed/interleaved_timing.h"
#include "io/machine.h"
#include "study/reference_solution.h"

namespace cloth::peers {

/// A program that steps a cloth in another library.
struct PeerLibrary {
  std::string name;               ///< "Bullet"
  std::filesystem::path program;  ///< bullet_main.cpp
  bool is_single = false;         ///< precision
};

struct PeerOptions {
  std::vector<PeerLibrary> libraries;
  std::vector<int> sizes;            ///< particles along an edge; empty: 33
  std::vector<std::string> methods;  ///< of our_peer_methods(); empty: all
  int repeats = 5;
  bool quick = false;  ///< a look: the first scene and library alone, small, few steps, short runs
  /// Asked between runs; false ends the study, and what is finished is kept.
  std::function<bool(double fraction, const std::string& text)> progress;
};

/// One run over the horizon.
struct PeerRun {
  double time_step = 0;  ///< s
  std::int64_t steps = 0;
  StateDifference error;        ///< not a number where it did not reach the horizon
  std::string failure;          ///< why it did not
  std::vector<double> seconds;  ///< processor time of the steps, one of each round
  /// Median, in ms of processor time for each second simulated; 0: never timed.
  double cost(double horizon) const;
  bool is_measured() const { return failure.empty() && !seconds.empty(); }
};

/// One method with one number of iterations, from its longest step to its shortest.
struct PeerSeries {
  std::string program;  ///< "Clothlab", "Bullet double", "Bullet single"
  std::string method;
  int iterations = 0;  ///< 0: the method has none
  std::vector<PeerRun> runs;
};

struct PeerScene {
  std::string name, title;
  int size = 0;
  double horizon = 0;  ///< s
  int samples = 0;     ///< at which errors are taken
  ReferenceSolution reference;
  std::vector<PeerSeries> series;
};

struct PeerReport {
  MachineFacts machine;
  bool complete = false;
  int repeats = 0;
  std::vector<std::string> versions;  ///< "Bullet 3.24, double precision"
  std::vector<PeerScene> scenes;
};

/// The time to an error: of the runs of a series on either side of it, logarithms interpolated.
struct TimeToError {
  double milliseconds = 0;  ///< of processor time for each second simulated
  bool is_bound = false;    ///< already the longest step that was run is more exact: no more than this
};
/// None where no run of the series is that exact.
std::optional<TimeToError> time_to_error(const PeerSeries& series, double error, double horizon);

/// Whose series reaches an error first, among those whose program begins with `program`.
struct FirstThere {
  const PeerSeries* series = nullptr;
  TimeToError time;
};
std::optional<FirstThere> first_there(const PeerScene& scene, const std::string& program, double error);

/// A sheet that hangs by two corners and is released from a slant, and one that swings down from where it lay
/// flat, its upper edge pinned.
struct NamedScene {
  std::string name, title;
  Scene scene;
};
std::vector<NamedScene> peer_scenes(int size);

/// Those of ours that are compared.
std::vector<std::string> our_peer_methods();

/// What a program says that was built without any library to compare with.
std::string missing_library_message();

PeerReport study_peers(const PeerOptions& options);

}  // namespace cloth::peers
