#include "bridge/simulation_link.h"

namespace clothlab {
namespace {

constexpr int fetch_interval = 16;  // ms: a 60 Hz screen

}  // namespace

SimulationLink::SimulationLink(QObject* parent) : QObject(parent) {
  timer_.setInterval(fetch_interval);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &SimulationLink::fetch);
}

void SimulationLink::send(Command command) {
  worker_.send(std::move(command));
  ++sent_;
  if (!timer_.isActive()) timer_.start();
}

void SimulationLink::settle() {
  worker_.wait_until_idle();
  fetch();
}

void SimulationLink::fetch() {
  const bool more_to_come = worker_.is_busy();  // asked first: what comes after it is fetched next time
  if (const auto frame = worker_.take_frame()) Q_EMIT frameReady(frame);
  if (const auto samples = worker_.take_samples(); !samples.empty()) Q_EMIT samplesReady(samples);
  status_ = worker_.status();
  Q_EMIT statusChanged(status_);
  if (!more_to_come) timer_.stop();
}

}  // namespace clothlab
