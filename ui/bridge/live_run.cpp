#include "bridge/live_run.h"

namespace clothlab {

void LiveRun::note_record(const std::optional<cloth::IoError>& error) {
  if (!error) return;
  status().recording_error = error->text();
  end_recording();
}

void LiveRun::note_end(const std::optional<cloth::IoError>& error) {
  if (error && status().recording_error.empty()) status().recording_error = error->text();
}

void LiveRun::publish_frame(std::size_t pane, cloth::Simulation& simulation, const cloth::ClothState& state,
                            const ContactChoice& contact, const std::vector<float>* difference) {
  const auto frame = exchange_.frames[pane].blank();
  frame->topology = exchange_.topology;
  fill_frame(simulation, state, normals_, *frame);
  contact_filler_.fill(simulation, contact, *frame);
  if (difference) show_difference(*difference, *frame);
  exchange_.frames[pane].publish(frame);
}

void LiveRun::publish_status() {
  const bool playing = status().playing;
  status().playing_again = playing && repeats_;
  status().steps_per_second = playing ? exchange_.meter.steps_per_second() : 0;
  status().real_time_factor = playing ? exchange_.meter.real_time_factor() : 0;
  status().recording = is_recording();
  fill_status(status());
  exchange_.publish();
}

}  // namespace clothlab
