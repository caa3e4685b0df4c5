#include "bridge/worker_link.h"

namespace clothlab {
namespace {

constexpr int fetch_interval = 16;  // ms: a 60 Hz screen

}  // namespace

WorkerLink::WorkerLink(QObject* parent) : QObject(parent) {
  timer_.setInterval(fetch_interval);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (!fetch()) timer_.stop();
  });
}

void SimulationLink::tellFrames(SimulationWorker& worker) {
  if (const auto frame = worker.take_frame()) Q_EMIT frameReady(frame);
}

void CompareLink::tellFrames(CompareWorker& worker) {
  for (std::size_t pane = 0; pane < cloth::max_panes; ++pane)
    if (const auto frame = worker.take_frame(pane)) Q_EMIT frameReady(pane, frame);
}

}  // namespace clothlab
