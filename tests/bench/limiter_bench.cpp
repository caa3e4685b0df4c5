// clothlab-limiter-bench: what keeping a deformation rate costs, against the excess that is left.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "kernels/instruction_set.h"
#include "limiter_rows.h"

namespace {

using namespace cloth;
using namespace cloth::speed;
using json = nlohmann::ordered_json;

json spread_json(const Spread& s) {
  return {{"median", s.median}, {"low", s.low}, {"high", s.high}};
}

json row_json(int size, const LimiterRow& row) {
  return {{"size", size},
          {"rate", row.rate == 0 ? json() : json(row.rate)},
          {"solver", row.solver.empty() ? json() : json(row.solver)},
          {"max_sweeps", row.max_sweeps},
          {"ns_per_particle_step", spread_json(row.time)},
          {"least_ns_per_particle_step", row.least},
          {"ratio_of_least_to_bare_step", row.to_bare},
          {"sweeps_per_step", row.sweeps},
          {"direct_iterations_per_step", row.iterations},
          {"mean_excess", row.mean_excess},
          {"largest_excess", row.largest_excess}};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes{32, 64, 128};
  LimiterOptions options;
  bool as_json = false, no_direct = false;
  CLI::App app{"What keeping a deformation rate costs on this machine, against the excess that is left.",
               "clothlab-limiter-bench"};
  app.add_option("--sizes", sizes, "Particles along an edge")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::Range(4, 1024));
  app.add_option("--rates", options.rates, "Deformation rates as fractions")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 5.0));
  app.add_option("--developed", options.developed_time, "Seconds of hanging before anything is timed")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 10.0));
  app.add_option("--repeats", options.repeats, "Timings of each row")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  app.add_option("--moment", options.moment, "Seconds that one timing takes, about")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 10.0));
  app.add_flag("--no-direct", no_direct, "Leave out the direct solver: at 0.1 % it takes minutes");
  app.add_flag("--json", as_json, "Give the result as one JSON object");
  CLI11_PARSE(app, argc, argv);
  if (no_direct)
    std::erase_if(options.choices, [](const LimiterChoice& choice) { return choice.solver == "direct"; });

  try {
    json rows = json::array();
    if (!as_json)
      fmt::print(
          "Cloth pinned at two corners, after {} s of hanging at its rate; semi-implicit Euler; instruction "
          "set "
          "{}.\nns per particle and step, {} interleaved repeats; excess: what is left above the "
          "rate.\n",
          options.developed_time, name_of(active_instruction_set()), options.repeats);
    for (const int size : sizes) {
      const std::vector<LimiterRow> found = measure_limiter(size, options);
      for (const LimiterRow& row : found) rows.push_back(row_json(size, row));
      if (!as_json) fmt::print("{}", limiter_table(size, found));
      std::fflush(stdout);
    }
    if (as_json)
      fmt::print("{}\n", json{{"instruction_set", name_of(active_instruction_set())}, {"rows", rows}}.dump(2));
  } catch (const std::exception& error) {
    fmt::print(stderr, "clothlab-limiter-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
