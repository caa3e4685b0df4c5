#include "bridge/simulation_link.h"

namespace clothlab {

SimulationLink::SimulationLink(QObject* parent) : WorkerLink(parent) {}

void SimulationLink::send(Command command) {
  worker_.send(std::move(command));
  ++sent_;
  wake();
}

void SimulationLink::settle() {
  worker_.wait_until_idle();
  fetch();
}

bool SimulationLink::fetch() {
  const bool more_to_come = worker_.is_busy();  // asked first: what comes after it is fetched next time
  if (const auto frame = worker_.take_frame()) Q_EMIT frameReady(frame);
  if (const auto samples = worker_.take_samples(); !samples.empty()) Q_EMIT samplesReady(samples);
  status_ = worker_.status();
  Q_EMIT statusChanged(status_);
  return more_to_come;
}

}  // namespace clothlab
