// The panes of a comparison advanced in lock step: every pane takes its own steps, and all meet at common
// times, where they are measured and compared.
//
//     LockStep lockstep(comparison);                     // a comparison without problems
//     for (std::int64_t k = 1; k <= lockstep.last_index() && lockstep.advance(k); ++k)
//       show(lockstep.difference(1));
//
// Common times are the multiples of the record interval, which every pane's step divides: whether panes have
// met is a matter of counted steps, never of comparing times. Where a step does not divide the interval, the
// pane is run with the longest shorter one that does, and its notice says so.
//
// Threads: advance_lane touches nothing but its lane, so that each lane may have a thread of its own between
// two common times. Everything else belongs to the one thread that waits for them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/difference.h"
#include "simulation/energy_account.h"
#include "simulation/history.h"
#include "simulation/step_batches.h"

namespace cloth {

/// One pane's run, the controlled reference's, or its check's. What it shows is that of the last common time
/// it reached, which is also where a lane that diverged stays.
struct Lane {
  std::string name;    ///< the pane's; "reference" and "check" for the controlled reference's
  std::string title;   ///< for people
  std::string notice;  ///< what is not as the pane asked for; empty: nothing
  std::unique_ptr<Simulation> simulation;
  std::int64_t index = 0;  ///< of the last common time
  ClothState state;
  Measurement measurement;
  double step_time = 0;   ///< s, mean wall time of a step since the common time before
  double wall = 0;        ///< s, of stepping alone, since the start
  double max_strain = 0;  ///< largest of all common times
  double limiter_excess = 0;
  EnergyAccount energy;                  ///< of all common times
  std::optional<Divergence> divergence;  ///< why it stopped
  double timed_from = 0;                 ///< s of simulated time at which `wall` began to count

  bool going() const { return !divergence; }
  /// s of wall time for each simulated second; 0 at the start
  double cost() const { return state.time > timed_from ? wall / (state.time - timed_from) : 0; }

 private:
  friend class LockStep;

  /// What the lane has summed up when it arrives at a common time.
  struct Sums {
    double step_time = 0, wall = 0, max_strain = 0, limiter_excess = 0;
    EnergyAccount energy;
  };

  Scene start_;                           ///< as it was run at first
  std::optional<History> history_;        ///< where one is kept
  std::vector<Sums> past_;                ///< of each common time of the history
  std::optional<Divergence> known_stop_;  ///< at the end of the history
  std::int64_t steps_since_ = 0;          ///< the last common time
  double wall_since_ = 0;
  BatchSize batch_;
};

class LockStep {
 public:
  /// Precondition: find_problems(comparison) is empty.
  explicit LockStep(const Comparison& comparison);
  /// Takes over a run of `scene` as the only pane, A, at its present state and with its history. Common times
  /// are then counted from there. edit() adds panes; the reference is one of them, or none.
  LockStep(const Scene& scene, RunWithHistory run);
  ~LockStep();
  LockStep(const LockStep&) = delete;
  LockStep& operator=(const LockStep&) = delete;

  const Comparison& comparison() const { return comparison_; }

  /// The panes in their order; behind them the controlled reference and its check, where there are.
  std::size_t lane_count() const { return lanes_.size(); }
  std::size_t pane_count() const { return comparison_.panes.size(); }
  const Lane& lane(std::size_t i) const { return *lanes_[i]; }
  std::optional<std::size_t> reference_lane() const;

  double time_of(std::int64_t index) const { return origin_ + static_cast<double>(index) * interval_; }
  std::int64_t last_index() const { return last_index_; }  ///< the first common time that covers the duration
  std::int64_t index() const;  ///< the common time that every going lane has reached
  bool all_stopped() const;    ///< no pane is going

  /// Steps one lane to a common time, and measures it there. False if `may_go_on`, which is asked before each
  /// batch of steps, ended it before; the next call goes on from where it stands. A lane that stopped is left
  /// alone.
  bool advance_lane(std::size_t lane, std::int64_t index, const std::function<bool()>& may_go_on = {});

  /// Differences at index(). To be called at each common time, once all lanes are there.
  void compare();

  /// Both, lane by lane or on several threads, which then all ask `may_go_on`: the same bits either way.
  /// False if it was ended before.
  bool advance(std::int64_t index, const std::function<bool()>& may_go_on = {}, int threads = 1);

  /// Asked within steps that take long, by all threads: true interrupts them, see Simulation. Not for lanes
  /// that an edit adds later.
  void set_stop_test(const std::function<bool()>& test);

  /// From the reference, at the last compare(); nullptr for the reference itself, for a pane that stopped,
  /// and where there is no reference or it has stopped.
  const Difference* difference(std::size_t pane) const;
  /// Of the controlled reference from its check, likewise: what differences of the panes cannot be trusted
  /// below. nullptr for another reference.
  const Difference* floor() const { return floor_.present ? &floor_.difference : nullptr; }
  /// m, root of the mean of the squared RMS differences at all common times so far but the start; nothing for
  /// the reference itself or before the first.
  std::optional<double> rms_over_time(std::size_t pane) const;

  // --- Between common times reached by all, acting on all lanes that are going ---

  /// Puts an edited comparison in force. Precondition: acts_at_once(comparison(), edited), and
  /// find_problems(edited) is empty. A new pane goes on from where the one it is a copy of stands; panes that
  /// the edit does not touch go on as without it, to the bit. Another reference forgets the differences so
  /// far.
  void edit(const Comparison& edited);
  void set_brush(const std::optional<BrushGust>& brush);
  /// As strong as the weakest hand of the lanes, so that it pulls all alike; see Simulation::strongest_pull.
  void set_pull(const std::optional<Pull>& pull);

  // --- The history, lockstep_history.cpp. Every lane has one of its own, with the same common times. ---

  /// Keeps a history from the present common time on, with at most so many bytes of stored states.
  void keep_history(std::size_t max_bytes);
  /// The last common time that the history has; without a history the present one.
  std::int64_t known_index() const;
  /// The common time nearest to a time (s), within the history.
  std::int64_t index_near(double time) const;
  /// Brings all lanes to a common time of the history, to the bits that they had there, with the edits that
  /// were in force. advance() then repeats the history, with what was done on the way, up to its end. False
  /// if `may_go_on` ended it before: then only another go_to() may follow.
  bool go_to(std::int64_t index, const std::function<bool()>& may_go_on = {});
  /// Makes the present common time the end of the history, as every edit and the hand do.
  void cut();
  const History& history_of(std::size_t lane) const { return *lanes_[lane]->history_; }
  std::size_t stored_states() const;  ///< of all lanes
  std::size_t history_bytes() const;
  /// Gives a pane's run away, at its present common time. Precondition: a history is kept; afterwards this
  /// object may only be destroyed.
  RunWithHistory release(std::size_t pane);

 private:
  struct ErrorSum {
    double squares = 0;      ///< m^2, of RMS differences
    std::int64_t times = 0;  ///< how many
  };
  struct Error {
    Difference difference;
    bool present = false;
    ErrorSum sum;
    std::int64_t counted = 0;    ///< the index of the last that was added
    std::vector<ErrorSum> past;  ///< of each common time of the history
  };
  /// What was in force from a common time on.
  struct InForce {
    std::int64_t index = 0;
    Comparison comparison;
    std::optional<PullStrength> pull;
  };

  bool keeps_history() const { return lanes_.front()->history_.has_value(); }
  void remember_errors();
  void remember_in_force();
  bool go_to(Lane& lane, std::int64_t index, const std::function<bool()>& may_go_on);
  void put_in_force(std::int64_t index);
  void perform(Lane& lane, const SessionAction& action);
  bool repeats(const Lane& lane) const;
  bool step_lane(Lane& lane, std::int64_t left);

  void measure(Error& error, std::size_t lane, std::size_t against);
  void add_lane(const std::string& name, const std::string& title, const Scene& scene);
  static std::unique_ptr<Lane> copy_of(const Lane& from);
  void take_panes(const Comparison& edited);
  void edit_lane(Lane& lane, const Scene& scene);
  static Lane::Sums sums_of(const Lane& lane);
  static void take_sums(Lane& lane, const Lane::Sums& sums);
  void arrive(Lane& lane, std::int64_t index);
  std::optional<PullStrength> weakest_pull() const;
  void share_pull_strength();

  Comparison comparison_;
  double interval_ = 0;  ///< s
  double origin_ = 0;    ///< s, of the common time 0: another than 0 after taking over a run between two
  std::int64_t last_index_ = 0;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<Error> errors_;  ///< one of each pane
  Error floor_;
  std::vector<InForce> in_force_;  ///< of the history, indices ascend
};

/// That the last common time lies beyond the duration, in words, where that is no whole number of record
/// intervals; else empty.
std::string uneven_intervals_text(const Scene& scene);

/// `scene` with the step that a pane of these rows is run with: see step_dividing. Precondition: it has one.
Scene in_lock_step(const Scene& scene);

}  // namespace cloth
