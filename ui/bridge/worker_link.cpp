#include "bridge/worker_link.h"

#include <limits>

namespace clothlab {
namespace {

constexpr int fetch_interval = 16;  // ms: a 60 Hz screen

bool loads_scene(const Command& command) {
  return command::is_one_of<command::Load<cloth::Scene>, command::TakeRun<cloth::Scene>,
                            command::OpenSession>(command);
}

bool loads_comparison(const Command& command) {
  return command::is_one_of<command::Load<cloth::Comparison>, command::TakeRun<cloth::Comparison>>(command);
}

/// How the run is shown and played, whatever is loaded.
bool is_for_both(const Command& command) {
  return command::is_one_of<command::Speed, command::ShowContact, command::Colour>(command);
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
  if (compares_ ? loads_scene(command) : loads_comparison(command)) activate(!compares_);
  if (is_for_both(command)) {
    if (compares_)
      scene_.send(command);
    else
      comparison_.send(command);
  }
  sent_ = compares_ ? comparison_.send(std::move(command)) : scene_.send(std::move(command));
  active_since_ = std::min(active_since_, sent_);
  if (!timer_.isActive()) timer_.start();
}

template <class Content>
void RunLink::pass_on(const Content& content, const cloth::Scene& scene) {
  auto run = std::make_shared<std::promise<cloth::RunWithHistory>>();
  auto taken = std::make_shared<std::future<cloth::RunWithHistory>>(run->get_future());
  send(command::GiveRun{scene, run});
  send(command::TakeRun<Content>{content, taken});
}

void RunLink::continueAs(const cloth::Comparison& comparison) {
  pass_on(comparison, comparison.scene);
}

void RunLink::continueAs(const cloth::Scene& scene) {
  pass_on(scene, scene);
}

/// The worker that rests ends its recording.
void RunLink::activate(bool comparison) {
  for (const Command& last : {Command(command::Pause{}), Command(command::StopRecording{})}) {
    if (compares_)
      comparison_.send(last);
    else
      scene_.send(last);
  }
  compares_ = comparison;
  active_since_ = std::numeric_limits<std::uint64_t>::max();  // the next one
}

void RunLink::settle() {
  if (compares_)
    comparison_.wait_until_idle();
  else
    scene_.wait_until_idle();
  fetch();
}

/// Returns false if nothing more will come until a command is sent; the timer then stops.
bool RunLink::fetch() {
  return compares_ ? fetch_from(comparison_) : fetch_from(scene_);
}

template <class Worker>
bool RunLink::fetch_from(Worker& worker) {
  const bool more_to_come = worker.is_busy();  // asked first: what comes after it is fetched next time
  WorkerStatus newest = worker.status();
  if (newest.commands < active_since_) return more_to_come;
  for (std::size_t pane = 0; pane < cloth::max_panes; ++pane)
    if (const auto frame = worker.take_frame(pane)) Q_EMIT frameReady(pane, frame);
  if (const auto samples = worker.take_samples(); !samples.empty()) tell(samples);
  status_ = std::move(newest);
  Q_EMIT statusChanged(status_);
  return more_to_come;
}

}  // namespace clothlab
