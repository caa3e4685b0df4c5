#include "bench/peers/peer_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "bench/peers/peer_program.h"
#include "simulation/simulation.h"
#include "study/step_ladder.h"

namespace cloth::peers {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const char* const our_name = "Clothlab";

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What makes the runs of a series: a step and whether states are wanted, to an answer.
using Runner = std::function<PeerAnswer(double time_step, std::int64_t steps, int samples)>;

struct Plan {
  PeerSeries series;
  Runner run;
  std::int64_t first_steps = 0;
  int factor = 2;  ///< steps of a run to those of the one before
};

/// Ours, in this process, as a run of the command line takes its steps.
PeerAnswer run_ours(const Scene& scene, std::int64_t steps, int samples) {
  PeerAnswer answer;
  Simulation simulation(scene);
  const std::int64_t parts = std::max(1, samples);
  for (std::int64_t part = 1; part <= parts; ++part) {
    const double before = processor_time();
    const auto divergence = simulation.advance(steps * part / parts - steps * (part - 1) / parts);
    answer.seconds += processor_time() - before;
    if (divergence) {
      answer.failure = describe(*divergence);
      return answer;
    }
    if (samples > 0) answer.states.push_back(simulation.state());
  }
  return answer;
}

/// What is timed of ours: methods, and how often they go through the springs in a step.
struct OurMethod {
  const char* method;
  std::int64_t iterations;  ///< 0: it has none
};
constexpr OurMethod our_methods[] = {
    {"semi-implicit-euler", 0}, {"verlet", 0},      {"rk4", 0},  {"implicit-euler", 0},
    {"projective", 10},         {"projective", 40}, {"xpbd", 1}, {"vbd", 20}};

Scene with_iterations(Scene scene, const std::string& method, std::int64_t iterations) {
  IntegratorChoice& choice = scene.integrator;
  if (method == "projective") choice.projective_iterations = iterations;
  if (method == "vbd") choice.vbd_iterations = iterations;
  if (method == "xpbd") choice.xpbd_iterations = iterations, choice.substeps = 1;
  return scene;
}

/// What is timed of Bullet's: of each model passes or iterations of Newton's method, and whose ladder of
/// steps it takes.
struct TheirMethod {
  const char* model;
  int iterations;
  const char* ladder;
};
constexpr TheirMethod their_methods[] = {{"springs-explicit", 1, "semi-implicit-euler"},
                                         {"springs-implicit", 1, "implicit-euler"},
                                         {"springs-implicit", 5, "implicit-euler"},
                                         {"links", 1, "implicit-euler"},
                                         {"links", 10, "implicit-euler"},
                                         {"links-by-stiffness", 1, "implicit-euler"},
                                         {"links-by-stiffness", 10, "implicit-euler"}};

class OneScene {
 public:
  OneScene(const PeerOptions& options, const NamedScene& named, int size, PeerReport& report)
      : options_(options), named_(named), report_(report) {
    scene_.name = named.name;
    scene_.title = named.title;
    scene_.size = size;
    scene_.horizon = options.quick ? 0.1 : 0.5;
    scene_.samples = 5;
  }

  bool run(const std::function<bool(double, const std::string&)>& goes_on) {
    const bool finished = measure(goes_on);
    for (Plan& plan : plans_) scene_.series.push_back(std::move(plan.series));
    if (scene_.reference.is_known()) report_.scenes.push_back(std::move(scene_));
    return finished;
  }

 private:
  bool measure(const std::function<bool(double, const std::string&)>& goes_on) {
    const auto says = [&](double from, double to) {
      return [&goes_on, from, to, this](double part) {
        return goes_on(from + (to - from) * part, scene_.name + ", reference");
      };
    };
    scene_.reference = solve_smooth(named_.scene, scene_.horizon, scene_.samples, says(0, 0.1));
    if (!scene_.reference.is_known()) return false;
    make_plans();
    for (std::size_t k = 0; k < plans_.size(); ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(plans_.size());
      if (!find_errors(plans_[k], [&] { return goes_on(0.1 + 0.4 * part, text_of(plans_[k])); }))
        return false;
    }
    return time_in_turns(goes_on);
  }

  std::string text_of(const Plan& plan) const {
    return fmt::format("{}, {} {}", scene_.name, plan.series.program, plan.series.method);
  }

  void make_plans() {
    const Ladders ladders = make_ladders(named_.scene, our_peer_methods(), scene_.horizon);
    const auto steps_of = [&](const std::string& method) {
      for (const StepLadder& ladder : ladders.methods)
        if (ladder.facts.name == method)
          return (ladder.first_steps + scene_.samples - 1) / scene_.samples * scene_.samples;
      return std::int64_t{0};
    };
    for (const OurMethod& each : our_methods)
      if (options_.methods.empty() ||
          std::find(options_.methods.begin(), options_.methods.end(), each.method) != options_.methods.end())
        add_ours(each, steps_of(each.method));
    for (const PeerLibrary& library : options_.libraries)
      for (const TheirMethod& each : their_methods)
        if (!options_.quick || (each.iterations == 1 && &library == &options_.libraries.front()))
          add_theirs(library, each, steps_of(each.ladder));
  }

  void add_ours(const OurMethod& each, std::int64_t first_steps) {
    Plan plan{.series = {.program = our_name,
                         .method = each.method,
                         .iterations = static_cast<int>(each.iterations),
                         .runs = {}},
              .run = {},
              .first_steps = first_steps};
    Scene scene = with_iterations(named_.scene, each.method, each.iterations);
    scene.integrator.method = each.method;
    scene.integrator.tolerance = 1e-8;
    plan.run = [scene](double time_step, std::int64_t steps, int samples) mutable {
      scene.integrator.time_step = time_step;
      return run_ours(scene, steps, samples);
    };
    plans_.push_back(std::move(plan));
  }

  void add_theirs(const PeerLibrary& library, const TheirMethod& each, std::int64_t first_steps) {
    const bool has_iterations = std::string(each.model) != "springs-explicit";
    Plan plan{.series = {.program = library.name + (library.is_single ? " single" : " double"),
                         .method = each.model,
                         .iterations = has_iterations ? each.iterations : 0,
                         .runs = {}},
              .run = {},
              .first_steps = first_steps};
    const int particles = scene_.size * scene_.size;
    plan.run = [this, library, each, particles](double time_step, std::int64_t steps, int samples) {
      PeerAnswer answer = run_peer(library.program, named_.scene, particles,
                                   {each.model, time_step, steps, samples, each.iterations});
      if (samples > 0 && !answer.states.empty()) answer.states.erase(answer.states.begin());
      if (!answer.version.empty()) note_version(library.name + " " + answer.version);
      return answer;
    };
    plans_.push_back(std::move(plan));
  }

  void note_version(const std::string& version) {
    if (std::find(report_.versions.begin(), report_.versions.end(), version) == report_.versions.end())
      report_.versions.push_back(version);
  }

  /// The runs of a series, untimed: errors, and the warm-up. Ends where a run takes too long for its rounds.
  bool find_errors(Plan& plan, const std::function<bool()>& goes_on) {
    const int most = options_.quick ? 2 : 9;
    const double longest = options_.quick ? 0.05 : 0.8;  // s
    double taken = 0;
    std::int64_t steps = plan.first_steps;
    for (int rung = 0; rung < most && taken * plan.factor <= longest; ++rung, steps *= plan.factor) {
      if (!goes_on()) return false;
      PeerRun run{.time_step = scene_.horizon / static_cast<double>(steps),
                  .steps = steps,
                  .error = {nan, nan, nan},
                  .failure = {},
                  .seconds = {}};
      const PeerAnswer answer = plan.run(run.time_step, steps, scene_.samples);
      if (!answer.failure.empty() && !goes_on()) return false;  // a signal ends the other program as well
      run.failure = answer.failure;
      if (run.failure.empty()) run.error = difference(answer.states, scene_.reference.states);
      taken = answer.seconds;
      plan.series.runs.push_back(run);
    }
    return true;
  }

  /// Rounds over all runs of all series, each beginning with another one.
  bool time_in_turns(const std::function<bool(double, const std::string&)>& goes_on) {
    std::vector<std::pair<Plan*, PeerRun*>> all;
    for (Plan& plan : plans_)
      for (PeerRun& run : plan.series.runs)
        if (run.failure.empty()) all.emplace_back(&plan, &run);
    const double turns = static_cast<double>(all.size()) * options_.repeats;
    double done = 0;
    for (int round = 0; round < options_.repeats; ++round)
      for (std::size_t k = 0; k < all.size(); ++k) {
        const std::size_t shift =
            all.size() * static_cast<std::size_t>(round) / static_cast<std::size_t>(options_.repeats);
        auto& [plan, run] = all[(k + shift) % all.size()];
        if (!goes_on(0.5 + 0.5 * done++ / turns, text_of(*plan) + ", timed")) return false;
        const PeerAnswer answer = plan->run(run->time_step, run->steps, 0);
        if (answer.failure.empty()) run->seconds.push_back(answer.seconds);
      }
    return true;
  }

  const PeerOptions& options_;
  const NamedScene& named_;
  PeerReport& report_;
  PeerScene scene_;
  std::vector<Plan> plans_;
};

}  // namespace

double PeerRun::cost(double horizon) const {
  return seconds.empty() ? 0 : 1e3 * speed::spread_of(seconds).median / horizon;
}

std::optional<TimeToError> time_to_error(const PeerSeries& series, double error, double horizon) {
  const PeerRun* before = nullptr;
  for (const PeerRun& run : series.runs) {
    if (!run.is_measured() || !(run.error.rms_position > 0)) continue;
    const double reached = run.error.rms_position, cost = run.cost(horizon);
    if (reached <= error) {
      if (!before) return TimeToError{cost, true};
      const double from = before->error.rms_position;
      const double part = std::log(from / error) / std::log(from / reached);
      return TimeToError{before->cost(horizon) * std::pow(cost / before->cost(horizon), part), false};
    }
    before = &run;
  }
  return std::nullopt;
}

std::optional<FirstThere> first_there(const PeerScene& scene, const std::string& program, double error) {
  std::optional<FirstThere> first;
  for (const PeerSeries& series : scene.series) {
    if (series.program.rfind(program, 0) != 0) continue;
    const auto time = time_to_error(series, error, scene.horizon);
    if (time && (!first || time->milliseconds < first->time.milliseconds)) first = FirstThere{&series, *time};
  }
  return first;
}

std::vector<NamedScene> peer_scenes(int size) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = size;
  scene.springs = SpringMaterial{.structural = 100, .shear = 100, .flexion = 10};
  scene.gravity = Vec3(0, -9.81, 0);
  Scene hanging = scene, swinging = scene;
  hanging.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  hanging.cloth.down = {0, -0.3, 0.95};
  swinging.cloth.pins = {NamedPin::top_edge};
  swinging.cloth.down = {0, 0, 1};
  return {{"hang", "hung by two corners, released from a slant", hanging},
          {"swing", "upper edge pinned, released from where it lay flat", swinging}};
}

std::vector<std::string> our_peer_methods() {
  std::vector<std::string> names;
  for (const OurMethod& each : our_methods)
    if (names.empty() || names.back() != each.method) names.push_back(each.method);
  return names;
}

std::string missing_library_message() {
  return "this program was built without Bullet: install libbullet-dev, configure and build again";
}

PeerReport study_peers(const PeerOptions& options) {
  PeerReport report;
  report.machine = machine_facts();
  report.repeats = options.repeats;
  std::vector<int> sizes = options.sizes;
  if (sizes.empty()) sizes = {options.quick ? 9 : 33};
  double done = 0;
  for (const int size : sizes) {
    std::vector<NamedScene> scenes = peer_scenes(size);
    if (options.quick) scenes.resize(1);
    for (const NamedScene& named : scenes) {
      const auto all = static_cast<double>(scenes.size() * sizes.size());
      const auto goes_on = [&](double fraction, const std::string& text) {
        return !options.progress || options.progress((done + fraction) / all, text);
      };
      if (!OneScene(options, named, size, report).run(goes_on)) return report;
      done += 1;
    }
  }
  report.complete = true;
  return report;
}

}  // namespace cloth::peers
