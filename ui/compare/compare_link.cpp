#include "compare/compare_link.h"

namespace clothlab {
namespace {

constexpr int fetch_interval = 16;  // ms: a 60 Hz screen

}  // namespace

CompareLink::CompareLink(QObject* parent) : QObject(parent) {
  timer_.setInterval(fetch_interval);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &CompareLink::fetch);
}

void CompareLink::send(CompareCommand command) {
  worker_.send(std::move(command));
  if (!timer_.isActive()) timer_.start();
}

void CompareLink::settle() {
  worker_.wait_until_idle();
  fetch();
}

void CompareLink::fetch() {
  const bool more_to_come = worker_.is_busy();  // asked first: what comes after it is fetched next time
  for (std::size_t pane = 0; pane < cloth::most_panes; ++pane)
    if (const auto frame = worker_.take_frame(pane)) Q_EMIT frameReady(pane, frame);
  if (const auto samples = worker_.take_samples(); !samples.empty()) Q_EMIT samplesReady(samples);
  status_ = worker_.status();
  Q_EMIT statusChanged(status_);
  if (!more_to_come) timer_.stop();
}

}  // namespace clothlab
