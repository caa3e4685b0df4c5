#include "main_window/stop_signals.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>

namespace clothlab {
namespace {

constexpr std::array signals_to_stop{SIGINT, SIGTERM, SIGHUP};

std::atomic<int> write_end{-1};

/// A signal handler may call only async-signal-safe functions: it writes a byte to a pipe, and the event loop
/// reads it (D. J. Bernstein's self-pipe).
extern "C" void tell_event_loop(int) {
  const int saved = errno;
  const char byte = 0;
  [[maybe_unused]] const ssize_t written = ::write(write_end.load(), &byte, 1);
  errno = saved;
}

}  // namespace

StopSignals::StopSignals(std::function<void()> stop) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return;  // signals then end the process as ever
  read_end_ = ends[0];
  write_end = ends[1];
  notifier_ = std::make_unique<QSocketNotifier>(read_end_, QSocketNotifier::Read);
  QObject::connect(notifier_.get(), &QSocketNotifier::activated, notifier_.get(),
                   [this, stop = std::move(stop)] {
                     notifier_->setEnabled(false);
                     stop();
                   });
  for (const int signal : signals_to_stop) {
    struct sigaction action {
    }, before{};
    action.sa_handler = tell_event_loop;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) ::sigaction(signal, &before, nullptr);
  }
}

StopSignals::~StopSignals() {
  if (read_end_ < 0) return;
  for (const int signal : signals_to_stop) {
    struct sigaction action {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler == tell_event_loop) std::signal(signal, SIG_DFL);
  }
  notifier_.reset();
  ::close(write_end.exchange(-1));
  ::close(read_end_);
}

}  // namespace clothlab
