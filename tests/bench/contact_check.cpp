// clothlab-contact-check: runs scenes of contact as they are, with any method and step, and has every frame
// looked at for crossings of cloth and obstacles and, with self-contact, of the cloth and itself. Prints a
// row for each run; exit code 1 if anything came through.
//
//     clothlab-contact-check --scenes corner fold --methods verlet xpbd --steps 0.001 0.0001
//     clothlab-contact-check --scenes bunny --steps 1e-4 --from touch --duration 0.2
//     clothlab-contact-check --ledger --scenes cube tablecloth --methods own xpbd
//     clothlab-contact-check --rest --methods verlet --scenes slope corner --damping 0.004
//
// Scenes: the built-in ones with continuous contact, and the small ones of the tests, as small/NAME.
#include "support/contact_check.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "contact/continuous_contact.h"
#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "simulation/time_step.h"

namespace {

using namespace cloth;
using namespace cloth::test;

const std::string small = "small/";
const std::string own = "own";  // method: the scene's

struct Options {
  std::vector<std::string> scenes, methods;
  std::vector<double> steps{1.0 / 60, 1e-3, 1e-4};
  std::string from = "start";
  double duration = 0;  ///< s; 0: the scene's
  double part = 1;      ///< of the particles along an edge
  double damping = 0;   ///< N s/m; 0: the scene's
  std::vector<std::string> ledger_scenes;
  std::vector<double> ledger_steps{0};  ///< s; 0: the scene's, or the automatic one
  bool ledger = false;                  ///< look at energy and pace instead of crossings
  bool rest = false;                    ///< look for rest instead of crossings
  double patience = infinity;           ///< s
};

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes())
    if (has_continuous_contact(builtin_scene(scene.name))) names.push_back(scene.name);
  for (const std::string& name : contact_scene_names()) names.push_back(small + name);
  return names;
}

bool is_small(const std::string& name) {
  return name.starts_with(small);
}

Scene scene_named(const std::string& name, double part) {
  if (is_small(name)) {
    Scene scene = contact_scene(name.substr(small.size()));
    scene.duration = 0.5;
    return scene;
  }
  return coarser(builtin_scene(name), part);
}

std::optional<Checkpoint> start_of(const std::string& name, const Scene& scene, const std::string& from) {
  constexpr double lead = 0.005;  // s
  if (from == "start" || is_small(name)) return std::nullopt;
  return from == "touch" ? state_before_touch(scene, lead) : state_at(scene, std::stod(from));
}

void print_header() {
  fmt::print("{:<28} {:<21} {:>9} {:>15} {:>7} {:>8} {:>9} {:>10} {:>8}  {}\n", "Scene", "Method", "Step (s)",
             "From, to (s)", "Frames", "Touched", "Held back", "Crossings", "CPU (s)", "Ended");
}

void print_row(const std::string& name, const Scene& scene, const CheckedRun& run) {
  std::string end = "as asked";
  if (run.gave_up) end = "out of patience";
  if (run.stop) end = run.stop->pinched ? "pinched" : run.stop->solver_failed ? "solver failed" : "diverged";
  if (run.stop) end += fmt::format(" at {:.4g} s: {}", run.stop->time, run.stop->cause);
  if (run.crossings.number > 0)
    end = fmt::format("{}; first crossing at {:.5g} s: {}", end, run.crossed_at, run.crossings.first);
  fmt::print("{:<28} {:<21} {:>9.3g} {:>15} {:>7} {:>8} {:>9} {:>10} {:>8.2f}  {}\n",
             fmt::format("{} {}x{}", name, scene.cloth.columns, scene.cloth.rows), scene.integrator.method,
             *scene.integrator.time_step, fmt::format("{:.3f}, {:.3f}", run.begin, run.end), run.frames,
             run.touched, run.held_back, run.crossings.number, run.cost, end);
  std::fflush(stdout);
}

/// Whether the scenes come to rest by 5 s, with the first of the methods at its step `auto`.
void check_rest(const Options& options) {
  fmt::print("{:<28} {:>10} {:>12} {:>14} {:>16} {:>20} {:>8}  {}\n", "Scene", "Peak (J)", "At 5 s / peak",
             "At rest (s)", "Then / peak", "Moved in 1 s (m)", "Touched", "Ended");
  for (const std::string& name : options.scenes) {
    Scene scene = scene_named(name, options.part);
    scene.integrator.method = options.methods.front();
    scene.integrator.time_step.reset();
    scene.integrator.time_step = resolved_time_step(scene);
    if (options.damping > 0) scene.damping = options.damping;
    const Preparation prepare = is_small(name) ? thrown({0, -2, 0}) : Preparation{};
    const RestingRun run = rest_run(scene, {.prepare = prepare});
    fmt::print("{:<28} {:>10.4g} {:>12.2e} {:>14.4g} {:>16.2e} {:>20.2e} {:>8}  {}\n",
               fmt::format("{} {}x{}", name, scene.cloth.columns, scene.cloth.rows), run.peak,
               run.kinetic / run.peak, run.resting_since, run.highest_after / run.peak, run.furthest_after,
               run.touched, run.stop ? describe(*run.stop) : "as asked");
    std::fflush(stdout);
  }
}

/// Of any built-in scene, with or without contact, and of the small ones.
std::vector<std::string> ledger_names() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  for (const std::string& name : contact_scene_names()) names.push_back(small + name);
  return names;
}

/// What contact did with the energy, as parts of what was exchanged, and the worst step beside the median
/// one. Each scene at its own step where none is given.
void check_ledger(const Options& options) {
  fmt::print("{:<26} {:<20} {:>9} {:>11} {:>9} {:>9} {:>9} {:>9} {:>9} {:>11} {:>12}  {}\n", "Scene",
             "Method", "Step (s)", "Work (J)", "Positive", "Largest", "Gain", "Error", "Worst/med",
             "Median (ms)", "Worst at (s)", "Ended");
  for (const std::string& name : options.ledger_scenes)
    for (const std::string& method : options.methods)
      for (const double step : options.ledger_steps) {
        Scene scene = scene_named(name, options.part);
        if (method != own) scene.integrator.method = method, scene.integrator.time_step.reset();
        if (step > 0) scene.integrator.time_step = step;
        if (!(scene.integrator.time_step = resolved_time_step(scene))) continue;
        const double duration = options.duration > 0 ? options.duration : scene.duration;
        const ContactLedger run =
            ledger_run(scene, is_small(name) ? thrown({0, -2, 0}) : Preparation{}, duration);
        const double exchanged = run.account.exchanged();
        fmt::print(
            "{:<26} {:<20} {:>9.3g} {:>11.3g} {:>9.2g} {:>9.2g} {:>9.2g} {:>9.2g} {:>9.3g} {:>11.3g} "
            "{:>12.3g}  {}\n",
            name, scene.integrator.method, *scene.integrator.time_step, run.work, run.positive / exchanged,
            run.largest_gift / exchanged, run.gain / exchanged, run.account.share(), run.unevenness(),
            1e3 * run.median_step, run.worst_at, run.stop ? describe(*run.stop) : "as asked");
        std::fflush(stdout);
      }
}

/// Crossings.
int check_all(const Options& options) {
  int crossings = 0, frames = 0;
  print_header();
  for (const double step : options.steps)
    for (const std::string& name : options.scenes) {
      Scene scene = scene_named(name, options.part);
      const double duration = options.duration > 0 ? options.duration : scene.duration;
      const std::optional<Checkpoint> start = start_of(name, scene, options.from);
      for (const std::string& method : options.methods) {
        scene.integrator.method = method;
        scene.integrator.time_step = step;
        CheckedWay way{
            .duration = duration, .start = start ? &*start : nullptr, .patience = options.patience};
        if (is_small(name)) way.prepare = thrown({0, -2, 0});
        const CheckedRun run = check_run(scene, way);
        print_row(name, scene, run);
        crossings += run.crossings.number;
        frames += run.frames;
      }
    }
  fmt::print("{} crossings on {} frames\n", crossings, frames);
  return crossings;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Options options;
  options.scenes = scene_names();
  options.methods = integrator_names();
  CLI::App app("Looks for crossings on every frame of scenes of contact.");
  options.ledger_scenes = ledger_names();
  std::vector<std::string> methods = options.methods;
  methods.push_back(own);
  app.add_option("--scenes", options.scenes,
                 "Built-in scenes with continuous contact, with --ledger any, or small/NAME; all")
      ->check(CLI::IsMember(options.ledger_scenes));
  app.add_option("--methods", options.methods, "All; with --ledger also own, and without it that alone")
      ->check(CLI::IsMember(methods));
  app.add_option("--steps", options.steps, "In s")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--from", options.from,
                 "start, touch (5 ms before the first one) or a time in s, got to with "
                 "Verlet at the step auto")
      ->check(CLI::IsMember({"start", "touch"}) | CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--duration", options.duration, "In s; without it the scene's, 0.5 of small ones")
      ->check(CLI::PositiveNumber);
  app.add_option("--patience", options.patience,
                 "In s of processor time, after which a run begins no further step")
      ->check(CLI::PositiveNumber);
  app.add_option("--part", options.part, "Of the particles along an edge of a built-in scene")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  app.add_flag("--ledger", options.ledger,
               "Instead: the work of contact, what it gave and the ledger's error as parts of the energy "
               "exchanged, and the worst step beside the median one in processor time of one thread");
  app.add_flag(
      "--rest", options.rest,
      "Instead: how still each scene lies after 5 s, with the first of the methods at the step auto");
  app.add_option("--damping", options.damping,
                 "With --rest: viscous damping in N s/m instead of the scene's");
  CLI11_PARSE(app, argument_count, arguments);
  if (options.ledger) {
    if (app["--scenes"]->count() > 0) options.ledger_scenes = options.scenes;
    if (app["--steps"]->count() > 0) options.ledger_steps = options.steps;
    if (app["--methods"]->count() == 0) options.methods = {own};
    return check_ledger(options), 0;
  }
  if (options.rest) return check_rest(options), 0;
  return check_all(options) > 0 ? 1 : 0;
}
