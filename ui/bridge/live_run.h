// What a worker runs: a scene (SceneRun), or the panes of a comparison, which meet at common times
// (PanesRun). Used by the worker's thread only.
#pragma once

#include <filesystem>
#include <functional>

#include "bridge/fill_frame.h"
#include "bridge/run_exchange.h"
#include "io/text_file.h"
#include "simulation/history.h"

namespace clothlab {

class LiveRun {
 public:
  explicit LiveRun(RunExchange& exchange) : exchange_(exchange) {}
  virtual ~LiveRun() = default;
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// What is in force.
  virtual cloth::Comparison content() const = 0;
  virtual double time() const = 0;       ///< s
  virtual double next_time() const = 0;  ///< s, at the end of the next step or at the next common time
  /// Steps to a common time are not finished: what acts on the panes has to wait.
  virtual bool is_under_way() const { return false; }
  /// Nothing is left that could play on.
  virtual bool is_over() const { return false; }

  /// Shows the run, which is new to the window.
  virtual void begin() = 0;
  /// Whether `edited` can be put in force in the middle of this run, or go on with it as a run of the other
  /// kind. Else it has to start from the beginning.
  virtual bool acts_at_once(const cloth::Comparison& edited) const = 0;
  /// Precondition: acts_at_once(edited), which is of the same kind and has no problems. Returns why it is
  /// refused; empty: it is not.
  virtual std::string edit(const cloth::Comparison& edited) = 0;
  /// The hand or the wind brush.
  virtual void perform(const cloth::SessionAction& action) = 0;

  virtual void prepare_to_play() = 0;
  /// Prepares to replay the history from the present time to its end; false if that is where it stands.
  virtual bool prepare_to_repeat() = 0;
  /// One step, or the way to the next common time begins.
  virtual void single_step() = 0;
  /// What is due, for a few milliseconds.
  virtual void play_for_a_moment() = 0;
  /// `may_go_on` is asked between two steps.
  virtual void go_to(const cloth::HistoryTarget& target, const std::function<bool()>& may_go_on) = 0;
  bool repeats() const { return repeats_; }  ///< the history, where it plays

  virtual void start_recording(const std::filesystem::path& folder) = 0;
  virtual bool is_recording() const = 0;
  virtual void keep_recording_current() = 0;
  /// Ends the recording; does nothing if there is none.
  void end_recording() {
    if (is_recording()) note_end(close_recording());
  }

  virtual void save_session(const std::filesystem::path& /*file*/) {}
  /// Gives away the run with which `content` goes on, at its present state and with its history; an empty one
  /// if there is none. This object may only be destroyed once it has given one away.
  virtual cloth::RunWithHistory release(const cloth::Comparison& content) = 0;

  virtual void publish_frames() = 0;
  void publish_status();

 protected:
  using Clock = RunExchange::Clock;

  virtual void fill_status(WorkerStatus& status) = 0;
  virtual std::optional<cloth::IoError> close_recording() = 0;

  WorkerStatus& status() { return exchange_.status; }
  bool stop_requested() const { return exchange_.stop.stop_requested(); }
  /// Handles the result of a write to the recording: an error is stored in the status and ends the recording.
  void note_record(const std::optional<cloth::IoError>& error);
  /// `difference`: m, distances to be shown instead of strain, or nullptr.
  void publish_frame(std::size_t pane, cloth::Simulation& simulation, const cloth::ClothState& state,
                     const ContactChoice& contact, const std::vector<float>* difference = nullptr);

  RunExchange& exchange_;
  bool repeats_ = false;
  Clock::time_point last_frame_{};

 private:
  /// Handles the result of ending the recording. The status keeps the first error.
  void note_end(const std::optional<cloth::IoError>& error);

  ContactFiller contact_filler_;
  cloth::Vec3Field normals_;  ///< scratch
};

}  // namespace clothlab
