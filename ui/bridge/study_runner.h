// Runs one study at a time in its own thread, at low priority, on copies of its inputs. The window polls
// status and tables; the newest table replaces older ones. Only `wait` and the destructor wait for the study.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "study/study_recorder.h"

namespace clothlab {

using StudyOptions =
    std::variant<cloth::WorkPrecisionOptions, cloth::StabilityOptions, cloth::ExtremesOptions,
                 cloth::GridConvergenceOptions, cloth::ValidationOptions, cloth::IterationsOptions>;

struct StudyOrder {
  cloth::Scene scene;  ///< not used by extremes (ExtremesOptions::scene) and exact solutions
  StudyOptions options;
  std::filesystem::path folder;  ///< each finished run is written there at once; an unfinished study of the
                                 ///< same inputs is continued
  std::string command;           ///< the equivalent command line, stored with the results
};

struct StudyStatus {
  bool running = false;
  bool stopping = false;        ///< cancelled; the present step has not ended yet
  bool writing = false;         ///< computed; its folder is being completed, and the next study may start
  double fraction = 0;          ///< part of the whole study that is done, 0 to 1
  std::string text;             ///< what is being done
  double elapsed = 0;           ///< s
  std::optional<double> left;   ///< estimated time left, s; none: no estimate yet
  std::string earlier_problem;  ///< why the study before, written meanwhile, could not be; empty: no error
  std::string problem;  ///< why the folder could not be written or the study did not finish; empty: no error
};

class StudyRunner {
 public:
  StudyRunner() = default;
  ~StudyRunner();  ///< cancels, then waits for the present step and for finished runs to be written
  StudyRunner(const StudyRunner&) = delete;
  StudyRunner& operator=(const StudyRunner&) = delete;

  /// Precondition: nothing is running, or what is running is only being written, which then goes on.
  void start(StudyOrder order);
  void cancel();
  StudyStatus status() const;
  bool is_running() const;

  /// The newest table since the last call; null if there is none.
  std::shared_ptr<const cloth::StudyTable> take();

  /// Blocks until the study has ended and its folder is written. For tests and for closing.
  void wait();

 private:
  using Clock = std::chrono::steady_clock;
  /// One study. All but `ended` belongs to its own thread, and to those of its cells one at a time.
  struct Job {
    StudyOrder order;
    Clock::time_point start, offered;
    cloth::StudyRecorder recorder;
    std::atomic<bool> ended = false;
    std::jthread thread;
  };

  void run(Job& job, const std::stop_token& stop);
  void carry_out(Job& job, const std::stop_token& stop);
  bool note(const Job& job, const cloth::StudyProgress& progress);
  void note_problem(const Job& job, const std::string& problem);
  template <class Table>
  const Table* begin(Job& job, const Table& plan);
  template <class Table>
  void offer(Job& job, const Table& table);
  template <class Table>
  void end(Job& job, const Table& table);
  template <class Table>
  void show(const Job& job, Table table);

  mutable std::mutex mutex_;  // of the members down to the blank line
  StudyStatus status_;
  const Job* present_ = nullptr;  ///< whose status it is
  std::shared_ptr<const cloth::StudyTable> newest_;

  std::vector<std::unique_ptr<Job>> jobs_;  ///< the last is the present one; those before are being written
};

}  // namespace clothlab
