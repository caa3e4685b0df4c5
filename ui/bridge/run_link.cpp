#include "bridge/run_link.h"

#include <utility>

namespace clothlab {
namespace {

constexpr int fetch_interval = 16;  // ms: a 60 Hz screen

/// Whether panes or a scene run once the command is carried out; nothing if it changes nothing about that.
std::optional<bool> wants_panes(const Command& command) {
  if (const auto* load = std::get_if<command::Load>(&command)) return !cloth::is_scene(load->content);
  if (const auto* edit = std::get_if<command::Edit>(&command)) return !cloth::is_scene(edit->content);
  if (std::holds_alternative<command::OpenSession>(command)) return false;
  return std::nullopt;
}

}  // namespace

RunLink::RunLink(QObject* parent) : QObject(parent) {
  timer_.setInterval(fetch_interval);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, [this] {
    if (!fetch()) timer_.stop();
  });
}

void RunLink::send(Command command) {
  const std::optional<bool> panes = wants_panes(command);
  sent_ = worker_.send(std::move(command));
  if (panes && std::exchange(panes_wanted_, *panes) != *panes) of_other_kind_ = sent_;
  if (!timer_.isActive()) timer_.start();
}

void RunLink::settle() {
  worker_.wait_until_idle();
  fetch();
}

/// Returns false if nothing more will come until a command is sent; the timer then stops.
bool RunLink::fetch() {
  const bool more_to_come = worker_.is_busy();  // asked first: what comes after it is fetched next time
  WorkerStatus newest = worker_.status();
  if (newest.commands < of_other_kind_) return more_to_come;
  for (std::size_t pane = 0; pane < cloth::max_panes; ++pane)
    if (const auto frame = worker_.take_frame(pane)) Q_EMIT frameReady(pane, frame);
  if (const auto samples = worker_.take_samples(); !samples.empty()) Q_EMIT samplesReady(samples);
  if (const auto samples = worker_.take_pane_samples(); !samples.empty()) Q_EMIT paneSamplesReady(samples);
  status_ = std::move(newest);
  Q_EMIT statusChanged(status_);
  return more_to_come;
}

}  // namespace clothlab
