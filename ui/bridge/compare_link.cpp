#include "bridge/compare_link.h"

namespace clothlab {

CompareLink::CompareLink(QObject* parent) : WorkerLink(parent) {}

void CompareLink::send(CompareCommand command) {
  worker_.send(std::move(command));
  wake();
}

void CompareLink::settle() {
  worker_.wait_until_idle();
  fetch();
}

bool CompareLink::fetch() {
  const bool more_to_come = worker_.is_busy();  // asked first: what comes after it is fetched next time
  for (std::size_t pane = 0; pane < cloth::most_panes; ++pane)
    if (const auto frame = worker_.take_frame(pane)) Q_EMIT frameReady(pane, frame);
  if (const auto samples = worker_.take_samples(); !samples.empty()) Q_EMIT samplesReady(samples);
  status_ = worker_.status();
  Q_EMIT statusChanged(status_);
  return more_to_come;
}

}  // namespace clothlab
