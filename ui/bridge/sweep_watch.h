// Follows the folder of a sweep while something fills it: this process, another one here, or a cluster. A
// thread of its own looks at the files and reads them anew where they have grown; the window polls for the
// newest results.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

#include "bridge/replaced_thread.h"
#include "sweep/sweep_results.h"

namespace clothlab {

/// What a sweep's folder says at one moment.
struct SweepView {
  cloth::SweepFolder folder;
  cloth::SweepResults results;
};

class SweepWatch {
 public:
  /// Follows this folder instead of another one, whose reading it does not wait for. `interval`: between two
  /// looks where nothing tells of a change.
  void follow(const std::filesystem::path& folder, std::chrono::milliseconds interval);
  void stop();
  /// Something has changed: look at once.
  void look();

  /// The newest view since the last call; null if there is none.
  std::shared_ptr<const SweepView> take();
  /// Why the folder cannot be read at present; empty: it can.
  std::string problem() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Reader;
  /// Of one folder.
  struct Following {
    std::mutex mutex;
    std::condition_variable_any changed;
    bool is_due = false;
    std::shared_ptr<const SweepView> newest;
    std::string problem;
  };
  static void run(Following& following, const std::filesystem::path& folder,
                  std::chrono::milliseconds interval, const std::stop_token& stop);

  std::shared_ptr<Following> present_;
  ReplacedThread thread_;
};

}  // namespace clothlab
