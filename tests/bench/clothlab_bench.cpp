// clothlab-bench: ns per particle and step of each method and each stage, beside a plain kernel timed in the
// same run.
//
// Absolute times are this machine's and this minute's; the ratios are what carries over.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench_scenes.h"
#include "integrators/registry.h"
#include "interleaved_timing.h"
#include "io/run_folder.h"
#include "reference_kernel.h"
#include "simulation/simulation.h"

namespace {

using namespace cloth;
using namespace cloth::bench;
using json = nlohmann::ordered_json;

constexpr double developed_time = 0.4;  // s of hanging before anything is timed
constexpr double nanoseconds = 1e9;

struct Options {
  std::vector<int> sizes{32, 64, 128};
  int repeats = 11;
  double moment = 0.02;
  bool json = false;
};

struct Diverged : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void advance(Simulation& simulation, std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k)
    if (const auto divergence = simulation.step()) throw Diverged(describe(*divergence));
}

/// The state from which everything of one size is timed: not the flat sheet, in which no spring pulls yet.
Checkpoint developed_cloth(int size) {
  Simulation simulation(hanging_cloth(size, "verlet"));
  advance(simulation, static_cast<std::int64_t>(developed_time / simulation.time_step()));
  return simulation.checkpoint();
}

/// One row of the table.
struct Row {
  int size = 0;
  std::string method, stage;  ///< no stage: the bare step; no method: the reference kernel
  double time_step = 0;       ///< s
  Spread time;                ///< ns per particle and step
  Spread to_reference, to_bare;
  double evaluations = 0, sweeps = 0, velocity_iterations = 0;  ///< per step, in the timed and untimed steps
};

struct Variant {
  std::string method, stage;
  std::unique_ptr<Simulation> simulation;
};

std::vector<Variant> variants_of(int size, const Checkpoint& start) {
  std::vector<Variant> variants;
  const auto add = [&](const std::string& stage, const Scene& scene) {
    variants.push_back({scene.integrator.method, stage, std::make_unique<Simulation>(scene)});
    variants.back().simulation->restore(start);
  };
  for (const std::string& method : integrator_names()) add("", hanging_cloth(size, method));
  for (const char* method : {"semi-implicit-euler", "verlet"})
    for (const ExtraStage& extra : extra_stages()) {
      Scene scene = hanging_cloth(size, method);
      extra.add(scene);
      add(extra.name, scene);
    }
  return variants;
}

/// How far the yardstick is from semi-implicit Euler after some steps, in m: the two must compute the same
/// motion.
double disagreement(int size, const Checkpoint& start) {
  constexpr int steps = 100;
  const Scene scene = hanging_cloth(size, "semi-implicit-euler");
  Simulation simulation(scene);
  simulation.restore(start);
  ReferenceKernel kernel(scene, simulation.system(), start.state);
  for (int k = 0; k < steps; ++k) kernel.step(simulation.time_step());
  advance(simulation, steps);
  return kernel.distance_to(simulation.state().position);
}

std::vector<Row> measure_size(int size, const Options& options) {
  constexpr double tolerance = 1e-9;  // m
  const Checkpoint start = developed_cloth(size);
  if (const double distance = disagreement(size, start); !(distance < tolerance))
    throw std::runtime_error(
        fmt::format("the reference kernel is {} m away from semi-implicit Euler", distance));

  const double per_particle = nanoseconds / (static_cast<double>(size) * size);
  std::vector<Variant> variants = variants_of(size, start);
  const Simulation& plain = *variants[1].simulation;
  ReferenceKernel kernel(plain.scene(), plain.system(), start.state);
  std::vector<Subject> subjects;
  subjects.push_back({"reference", per_particle, [&, h = plain.time_step()](int times) {
                        for (int k = 0; k < times; ++k) kernel.step(h);
                      }});
  for (Variant& variant : variants)
    subjects.push_back({variant.method, per_particle,
                        [&simulation = *variant.simulation](int times) { advance(simulation, times); }});
  time_interleaved(subjects, options.repeats, options.moment);

  std::vector<Row> rows;
  rows.push_back({.size = size,
                  .method = "",
                  .stage = "",
                  .time_step = plain.time_step(),
                  .time = spread_of(subjects[0].samples),
                  .to_reference = {1, 1, 1},
                  .to_bare = {},
                  .evaluations = 1});
  for (std::size_t k = 0; k < variants.size(); ++k) {
    const Variant& variant = variants[k];
    const auto bare = std::find_if(variants.begin(), variants.end(), [&](const Variant& other) {
      return other.method == variant.method && other.stage.empty();
    });
    const Subject& subject = subjects[k + 1];
    const Subject& bare_subject = subjects[static_cast<std::size_t>(bare - variants.begin()) + 1];
    const StepCount& count = variant.simulation->count();
    const auto each_step = [&](std::int64_t number) {
      return static_cast<double>(number) / static_cast<double>(count.steps);
    };
    rows.push_back({.size = size,
                    .method = variant.method,
                    .stage = variant.stage,
                    .time_step = variant.simulation->time_step(),
                    .time = spread_of(subject.samples),
                    .to_reference = ratio_of(subject, subjects[0]),
                    .to_bare = ratio_of(subject, bare_subject),
                    .evaluations = each_step(count.force_evaluations),
                    .sweeps = each_step(count.limiter_sweeps),
                    .velocity_iterations = each_step(count.velocity_iterations)});
  }
  return rows;
}

// --- Output
// ----------------------------------------------------------------------------------------------------------

/// What summary.json says of the machine: processor, compiler, build.
json machine() {
  json host = json::parse(summary_json({})).at("host");
  host.erase("name");
  return host;
}

std::string text_of(const Spread& s, int digits) {
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", s.median, digits, s.low, digits, s.high, digits);
}

std::string remark(const Row& row) {
  if (row.sweeps > 0) return fmt::format("{:.1f} evaluations, {:.1f} sweeps", row.evaluations, row.sweeps);
  if (row.velocity_iterations > 0)
    return fmt::format("{:.1f} evaluations, {:.1f} iterations", row.evaluations, row.velocity_iterations);
  return fmt::format("{:.1f} evaluations", row.evaluations);
}

std::string head(const Options& options) {
  const json host = machine();
  return fmt::format(
      "Clothlab {}, {}, {}; {}; one thread\n"
      "Cloth pinned at two corners, six spring directions, gravity, viscous damping, after {} s of hanging.\n"
      "ns per particle and step: median [quartiles] of {} interleaved repeats. Absolute times are this "
      "machine's.\n",
      version(), host.value("compiler", ""), host.value("build", ""), host.value("processor", ""),
      developed_time, options.repeats);
}

std::string size_table(const std::vector<Row>& rows) {
  std::string text = fmt::format("\n{0} x {0}\n  {1:<38} {2:<26} {3}\n", rows.front().size, "step", "ns",
                                 "to the reference");
  for (const Row& row : rows)
    if (row.stage.empty())
      text += fmt::format("  {:<38} {:<26} {}\n",
                          row.method.empty() ? "reference kernel (scalar, index pairs)" : row.method,
                          text_of(row.time, 1), text_of(row.to_reference, 2));
  text += fmt::format("  {:<38} {:<26} {}\n", "with one stage more", "ns",
                      "to the bare step         of force, a step");
  for (const Row& row : rows)
    if (!row.stage.empty())
      text += fmt::format("  {:<38} {:<26} {:<24} {}\n", row.method + " + " + row.stage, text_of(row.time, 1),
                          text_of(row.to_bare, 2), remark(row));
  while (text.find(" \n") != std::string::npos) text.erase(text.find(" \n"), 1);
  return text;
}

json spread_json(const Spread& s) {
  return {{"median", s.median}, {"low", s.low}, {"high", s.high}};
}

json row_json(const Row& row) {
  const bool reference = row.method.empty();
  json object{{"size", row.size},
              {"method", reference ? "reference" : row.method},
              {"stage", row.stage.empty() ? json() : json(row.stage)},
              {"time_step_s", row.time_step},
              {"ns_per_particle_step", spread_json(row.time)},
              {"ratio_to_reference", spread_json(row.to_reference)},
              {"ratio_to_bare_step", row.stage.empty() ? json() : spread_json(row.to_bare)},
              {"force_evaluations_per_step", row.evaluations}};
  if (row.sweeps > 0) object["limiter_sweeps_per_step"] = row.sweeps;
  if (row.velocity_iterations > 0) object["velocity_iterations_per_step"] = row.velocity_iterations;
  return object;
}

void run_benchmark(const Options& options) {
  json result{
      {"version", version()}, {"machine", machine()}, {"repeats", options.repeats}, {"rows", json::array()}};
  if (!options.json) fmt::print("{}", head(options));
  for (const int size : options.sizes) {
    const std::vector<Row> rows = measure_size(size, options);
    for (const Row& row : rows) result["rows"].push_back(row_json(row));
    if (!options.json) fmt::print("{}", size_table(rows));
    std::fflush(stdout);
  }
  if (options.json) fmt::print("{}\n", result.dump(2));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "What a step of Clothlab costs on this machine, beside a plain scalar kernel timed in the same run.",
      "clothlab-bench"};
  app.add_option("--sizes", options.sizes, "Particles along an edge, e.g. 32,64,128,256")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::Range(4, 2048));
  app.add_option("--repeats", options.repeats, "Timings of each row")
      ->capture_default_str()
      ->check(CLI::Range(3, 1000));
  app.add_option("--moment", options.moment, "Seconds that one timing takes, about")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 10.0));
  app.add_flag("--json", options.json, "Give the result as one JSON object");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    constexpr int bad_usage = 2;
    return app.exit(error) == 0 ? 0 : bad_usage;
  }
  try {
    run_benchmark(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "clothlab-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
