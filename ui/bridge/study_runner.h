// Runs one study at a time in its own thread, at low priority, on copies of its inputs. The window polls
// status and tables; the newest table replaces older ones. Only `wait` and the destructor wait for the study.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include "study/study_recorder.h"

namespace clothlab {

using StudyOptions =
    std::variant<cloth::WorkPrecisionOptions, cloth::StabilityOptions, cloth::ExtremesOptions>;

struct StudyOrder {
  cloth::Scene scene;  ///< extremes: not used, see ExtremesOptions::scene
  StudyOptions options;
  std::filesystem::path folder;  ///< each finished run is written there at once; an unfinished study of the
                                 ///< same inputs is continued
  std::string command;           ///< the equivalent command line, stored with the results
};

struct StudyStatus {
  bool running = false;
  bool stopping = false;       ///< cancelled; the present step has not ended yet
  double fraction = 0;         ///< part of the whole study that is done, 0 to 1
  std::string text;            ///< what is being done
  double elapsed = 0;          ///< s
  std::optional<double> left;  ///< estimated time left, s; none: no estimate yet
  std::string problem;  ///< why the folder could not be written or the study did not finish; empty: no error
};

class StudyRunner {
 public:
  StudyRunner() = default;
  ~StudyRunner();  ///< cancels, then waits for the present step and for finished runs to be written
  StudyRunner(const StudyRunner&) = delete;
  StudyRunner& operator=(const StudyRunner&) = delete;

  /// Precondition: nothing is running.
  void start(StudyOrder order);
  void cancel();
  StudyStatus status() const;
  bool is_running() const;

  /// The newest table since the last call; null if there is none.
  std::shared_ptr<const cloth::StudyTable> take();

  /// Blocks until the study has ended and its folder is written. For tests and for closing.
  void wait() {
    if (thread_.joinable()) thread_.join();
  }

 private:
  using Clock = std::chrono::steady_clock;
  void run(const StudyOrder& order, const std::stop_token& stop);
  void carry_out(const StudyOrder& order, const std::stop_token& stop);
  bool note(const cloth::StudyProgress& progress);
  template <class Table>
  const Table* begin(const Table& plan, const StudyOrder& order);
  template <class Table>
  void offer(const Table& table, bool last);
  template <class Table>
  void keep(const Table& table, bool last);

  mutable std::mutex mutex_;  // guards the members up to the blank line
  StudyStatus status_;
  Clock::time_point start_;
  std::shared_ptr<const cloth::StudyTable> newest_;

  Clock::time_point offered_;  // used by the study's thread only, like recorder_
  cloth::StudyRecorder recorder_;
  std::jthread thread_;
};

}  // namespace clothlab
