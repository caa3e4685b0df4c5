// The history of a run: states to go back to, and the log of everything that was done. Any step of the run is
// reached again, to the bit, from the state kept before it and what the log has since.
//
//     history.begin(simulation);
//     ... simulation.step(); history.extend(simulation); history.keep(simulation); ...
//     history.log(action, simulation);                    // what has just been carried out
//     history.go_to(simulation, {.step = 120}, {});       // all that was logged up to step 120 is in force
//     history.cut(simulation);                            // before going on from there: what came later is
//     dropped
#pragma once

#include <memory>

#include "simulation/session.h"

namespace cloth {

/// A step, or else the step nearest to a time. Beyond the end of the history: its end.
struct HistoryTarget {
  std::optional<std::int64_t> step;
  double time = 0;  ///< s
};

/// How a way through the history ended.
struct HistoryArrival {
  bool arrived = false;
  std::optional<Divergence> divergence;  ///< the simulation holds the bad state
  std::vector<Problem> problems;         ///< of a logged command that could not be carried out
};

class History {
 public:
  static constexpr std::size_t default_most_bytes = std::size_t{256} << 20;

  explicit History(std::size_t most_bytes = default_most_bytes) : most_bytes_(most_bytes) {}

  /// A new run, with `simulation` at its start.
  void begin(const Simulation& simulation);
  /// A run that a session describes, not gone through yet. Carries out what it has before the first step.
  std::vector<Problem> begin(Simulation& simulation, const Session& session);

  /// The simulation has made a good step at the end of the history, or inside of it: then nothing changes.
  void extend(const Simulation& simulation);

  /// The present state as one to go back to: the newest is always kept, older ones in even intervals.
  void keep(const Simulation& simulation);

  /// What has just been carried out, at the end of the history.
  void log(SessionAction action, const Simulation& simulation);

  /// Makes the present step the end. True if something came later, which is then dropped.
  bool cut(const Simulation& simulation);

  /// Brings the simulation to a step of the history, with everything in force that was logged up to it.
  /// `go_on` is asked after each step on the way: false ends the way there, at a step like any other.
  HistoryArrival go_to(Simulation& simulation, const HistoryTarget& target,
                       const std::function<bool()>& go_on);

  /// One step along the history and what was logged after it. Precondition: not at the end.
  HistoryArrival step(Simulation& simulation) const;

  /// The newest state before a step; for a simulation that has diverged there. The history ends at it then.
  void return_from(const Divergence& divergence, Simulation& simulation);

  /// The whole history as a session.
  Session session(const Simulation& simulation) const;

  std::int64_t last_step() const { return last_step_; }
  double last_time() const { return last_time_; }  ///< s
  std::size_t state_count() const { return states_.size(); }
  std::vector<double> state_times() const;  ///< s, ascending
  const std::vector<SessionCommand>& commands() const { return commands_; }
  std::size_t commands_until(std::int64_t step) const;  ///< how many were logged up to and with it
  const std::string& expected_hash() const {
    return expected_hash_;
  }  ///< of a session's end, if it is the end

  std::size_t most_bytes() const { return most_bytes_; }
  /// Of the states, which stay within most_bytes() unless the first and the newest alone are more, and of the
  /// log, which is all kept: it is the session.
  std::size_t bytes() const { return state_bytes_ + command_bytes_; }

 private:
  struct State {
    Checkpoint checkpoint;
    std::shared_ptr<const Scene> scene;  ///< in force
    std::size_t commands = 0;            ///< of the log in force
    std::int64_t step() const { return checkpoint.state.step; }
    std::size_t bytes() const { return checkpoint.bytes() + sizeof(State); }
  };

  void start_over(const Simulation& simulation);
  std::vector<Problem> carry_out_logged(std::size_t first, Simulation& simulation) const;
  std::vector<Problem> restore(const State& state, Simulation& simulation) const;
  const State& nearest(const HistoryTarget& target) const;
  void pop_state();
  void thin_out();

  std::size_t most_bytes_;
  Scene scene_;                ///< as started
  std::vector<State> states_;  ///< steps ascend; the first is the start
  std::int64_t interval_ = 1;  ///< steps between two states, at least
  std::vector<SessionCommand> commands_;
  std::int64_t last_step_ = 0;
  double last_time_ = 0;
  std::vector<StepChange> step_changes_;  ///< up to last_step_
  std::string expected_hash_;
  std::size_t state_bytes_ = 0, command_bytes_ = 0;
};

}  // namespace cloth
