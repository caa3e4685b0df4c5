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

  bool going() const { return !divergence; }
  /// s of wall time for each simulated second; 0 at the start
  double cost() const { return state.time > 0 ? wall / state.time : 0; }

 private:
  friend class LockStep;
  Scene start_;                   ///< as it was run at first
  std::int64_t steps_since_ = 0;  ///< the last common time
  double wall_since_ = 0;
  BatchSize batch_;
};

class LockStep {
 public:
  /// Precondition: find_problems(comparison) is empty.
  explicit LockStep(const Comparison& comparison);
  ~LockStep();
  LockStep(const LockStep&) = delete;
  LockStep& operator=(const LockStep&) = delete;

  const Comparison& comparison() const { return comparison_; }

  /// The panes in their order; behind them the controlled reference and its check, where there are.
  std::size_t lane_count() const { return lanes_.size(); }
  std::size_t pane_count() const { return comparison_.panes.size(); }
  const Lane& lane(std::size_t i) const { return *lanes_[i]; }
  std::optional<std::size_t> reference_lane() const;

  double time_of(std::int64_t index) const { return static_cast<double>(index) * interval_; }
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

 private:
  struct Error {
    Difference difference;
    bool present = false;
    double squares = 0;                   ///< m^2, of RMS differences
    std::int64_t times = 0, counted = 0;  ///< how many, and the index of the last
  };

  void measure(Error& error, std::size_t lane, std::size_t against);
  void add_lane(const std::string& name, const std::string& title, const Scene& scene);
  static std::unique_ptr<Lane> copy_of(const Lane& from);
  void take_panes(const Comparison& edited);
  void edit_lane(Lane& lane, const Scene& scene);
  void arrive(Lane& lane, std::int64_t index);
  void share_pull_strength();

  Comparison comparison_;
  double interval_ = 0;
  std::int64_t last_index_ = 0;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<Error> errors_;  ///< one of each pane
  Error floor_;
};

/// That the last common time lies beyond the duration, in words, where that is no whole number of record
/// intervals; else empty.
std::string uneven_intervals_text(const Scene& scene);

/// `scene` with the step that a pane of these rows is run with: see step_dividing. Precondition: it has one.
Scene in_lock_step(const Scene& scene);

}  // namespace cloth
