// A thread that another one can take the place of without waiting for its end: what was replaced is told to
// stop and joined once it has ended, at the latest by the destructor.
#pragma once

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace clothlab {

class ReplacedThread {
 public:
  /// `work(stop)` is to end soon after it is told to stop.
  template <class Work>
  void start(Work work) {
    stop();
    std::erase_if(all_, [](const Running& one) { return one.ended->load(); });
    auto ended = std::make_shared<std::atomic<bool>>(false);
    all_.push_back({ended, std::jthread([work = std::move(work), ended](const std::stop_token& stop) {
                      work(stop);
                      *ended = true;
                    })});
  }
  /// Does not wait.
  void stop() {
    for (Running& one : all_) one.thread.request_stop();
  }

 private:
  struct Running {
    std::shared_ptr<std::atomic<bool>> ended;
    std::jthread thread;
  };
  std::vector<Running> all_;
};

}  // namespace clothlab
