// Runs one study at a time in a thread of its own, at low priority, on copies of what it was given. The
// window only ever looks: the newest table wins, and no call waits for the study but `wait` and the
// destructor.
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
  std::filesystem::path folder;  ///< finished runs are on disk there at once; an unfinished study goes on
  std::string command;           ///< what made it
};

struct StudyStatus {
  bool running = false;
  bool stopping = false;       ///< cancelled, but not yet at its next step
  double fraction = 0;         ///< of the whole study
  std::string text;            ///< what is being done
  double elapsed = 0;          ///< s
  std::optional<double> left;  ///< s, estimated; none: too early to say
  std::string problem;         ///< why the folder could not be written, or the study not brought to its end
};

class StudyRunner {
 public:
  StudyRunner() = default;
  ~StudyRunner();  ///< cancels and waits: for one step and the writing of what is finished
  StudyRunner(const StudyRunner&) = delete;
  StudyRunner& operator=(const StudyRunner&) = delete;

  /// Precondition: nothing is running.
  void start(StudyOrder order);
  void cancel();
  StudyStatus status() const;
  bool is_running() const;

  /// The newest table since the last call; null if there is none.
  std::shared_ptr<const cloth::StudyTable> take();

  /// Until what runs has ended and its folder is written. For tests and orderly ends.
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

  mutable std::mutex mutex_;  // of the members down to the blank line
  StudyStatus status_;
  Clock::time_point start_;
  std::shared_ptr<const cloth::StudyTable> newest_;

  Clock::time_point offered_;  // of the worker alone
  cloth::StudyRecorder recorder_;
  std::jthread thread_;
};

}  // namespace clothlab
