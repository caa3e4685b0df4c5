// The history of a run: checkpoints and the log of commands. Any step of the run is reached again with
// bitwise the same state, from the checkpoint before it and the commands logged since.
//
//     history.begin(simulation);
//     ... simulation.step(); history.extend(simulation); history.keep(simulation); ...
//     history.log(action, simulation);                    // after the action has been carried out
//     history.go_to(simulation, {.step = 120}, {});       // with all commands up to step 120
//     history.cut(simulation);                            // before continuing there: drops what came later
#pragma once

#include <memory>

#include "simulation/session.h"

namespace cloth {

/// A step, or else the step nearest to a time. Beyond the end of the history: its end.
struct HistoryTarget {
  std::optional<std::int64_t> step;
  double time = 0;  ///< s
};

/// The result of going to a step of the history.
struct HistoryArrival {
  bool arrived = false;
  std::optional<Divergence> divergence;  ///< the simulation is then in the diverged state
  std::vector<Problem> problems;         ///< of a logged command that could not be carried out
};

class History {
 public:
  static constexpr std::size_t default_max_bytes = std::size_t{256} << 20;

  explicit History(std::size_t max_bytes = default_max_bytes) : max_bytes_(max_bytes) {}

  /// Starts the history of a new run; `simulation` is at its start.
  void begin(const Simulation& simulation);
  /// Starts the history of a recorded session, which has not been simulated yet. Carries out its commands
  /// before the first step.
  std::vector<Problem> begin(Simulation& simulation, const Session& session);

  /// Call after each good step. At the end of the history it becomes longer; inside, nothing changes.
  void extend(const Simulation& simulation);

  /// Stores a checkpoint of the present state. The newest one is always kept, older ones at even intervals.
  void keep(const Simulation& simulation);

  /// Logs an action that has just been carried out at the end of the history.
  void log(SessionAction action, const Simulation& simulation);

  /// Makes the present step the end of the history. Returns true if something came later and was dropped.
  bool cut(const Simulation& simulation);

  /// Brings the simulation to a step of the history, with all commands logged up to it carried out. `go_on`
  /// is called after each step; where it returns false the simulation stays at that step.
  HistoryArrival go_to(Simulation& simulation, const HistoryTarget& target,
                       const std::function<bool()>& go_on);

  /// Takes one step and carries out the commands logged after it. Precondition: not at the end.
  HistoryArrival step(Simulation& simulation) const;

  /// Restores the newest checkpoint before the step at which the simulation diverged, and ends the history
  /// there.
  void return_from(const Divergence& divergence, Simulation& simulation);

  /// The whole history as a session.
  Session session(const Simulation& simulation) const;

  std::int64_t last_step() const { return last_step_; }
  double last_time() const { return last_time_; }  ///< s
  std::size_t state_count() const { return states_.size(); }
  std::vector<double> state_times() const;  ///< s, ascending
  const std::vector<SessionCommand>& commands() const { return commands_; }
  std::size_t commands_until(std::int64_t step) const;  ///< how many were logged up to and with it
  /// Another number whenever commands() has become another list.
  std::int64_t command_changes() const { return command_changes_; }
  const std::string& expected_hash() const {
    return expected_hash_;
  }  ///< of a session's end, if it is the end

  std::size_t max_bytes() const { return max_bytes_; }
  void set_max_bytes(std::size_t bytes) {
    max_bytes_ = bytes;
    thin_out();
  }
  const Scene& start_scene() const { return scene_; }  ///< as started
  /// Memory of the checkpoints, at most max_bytes() unless the first and the newest alone need more, and of
  /// the log, which is kept whole.
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

  std::size_t max_bytes_;
  Scene scene_;                ///< as started
  std::vector<State> states_;  ///< steps ascend; the first is the start
  std::int64_t interval_ = 1;  ///< steps between two states, at least
  std::vector<SessionCommand> commands_;
  std::int64_t command_changes_ = 0;
  std::int64_t last_step_ = 0;
  double last_time_ = 0;
  std::vector<StepChange> step_changes_;  ///< up to last_step_
  std::string expected_hash_;
  std::size_t state_bytes_ = 0, command_bytes_ = 0;
};

/// A run with its history, as it passes from one owner to another.
struct RunWithHistory {
  std::unique_ptr<Simulation> simulation;
  History history;
};

}  // namespace cloth
