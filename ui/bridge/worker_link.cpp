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

void WorkerLink::wake() {
  if (!timer_.isActive()) timer_.start();
}

}  // namespace clothlab
