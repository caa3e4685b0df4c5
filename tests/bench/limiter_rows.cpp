#include "limiter_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "bench/speed/speed_scenes.h"
#include "simulation/simulation.h"

namespace cloth::speed {
namespace {

constexpr const char* method = "semi-implicit-euler";
constexpr double never_exceeded = 10;
constexpr int direct_repeats = 3;

/// Soft enough that its corners would stretch far beyond 10 %.
Scene bare_cloth(int size) {
  Scene scene = hanging_cloth(size, method, bare_feature());
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10};
  return scene;
}

double least_of(const Subject& subject) {
  return spread_of(subject).least;
}

Scene limited_cloth(int size, double rate, const LimiterChoice& choice) {
  Scene scene = bare_cloth(size);
  scene.deformation = Deformation{.rate = rate, .max_sweeps = choice.max_sweeps, .solver = choice.solver};
  return scene;
}

/// What the limiter did in the steps of one variant.
struct LimiterCount {
  double steps = 0, sweeps = 0, iterations = 0, excess = 0, largest_excess = 0;
  void add(const LimiterReport& report) {
    steps += 1, sweeps += report.sweeps, iterations += report.direct_iterations, excess += report.excess;
    largest_excess = std::max(largest_excess, report.excess);
  }
};

void advance(Simulation& simulation, int steps, LimiterCount& count) {
  for (int n = 0; n < steps; ++n) {
    if (const auto divergence = simulation.step()) throw std::runtime_error(describe(*divergence));
    count.add(simulation.last_limit());
  }
}

struct Variant {
  LimiterRow row;
  std::unique_ptr<Simulation> simulation;
  LimiterCount count{};
};

class RateMeasurement {
 public:
  RateMeasurement(int size, double rate, const LimiterOptions& options)
      : size_(size), rate_(rate), options_(options) {
    Simulation simulation(limited_cloth(size, rate, {"sweeps", 200}));
    LimiterCount unused;
    advance(simulation, static_cast<int>(options.developed_time / simulation.time_step()), unused);
    start_ = simulation.checkpoint();
  }

  /// Rows of the choices with or without the direct solver, timed against each other and the bare step.
  std::vector<LimiterRow> measure(bool direct) const {
    std::vector<Variant> variants;
    const auto add = [&](double rate, const LimiterChoice& choice, const Scene& scene) {
      Variant& variant = variants.emplace_back();
      variant.row.rate = rate, variant.row.solver = choice.solver, variant.row.max_sweeps = choice.max_sweeps;
      variant.simulation = std::make_unique<Simulation>(scene);
    };
    add(0, {}, bare_cloth(size_));
    if (!direct) add(rate_, {}, limited_cloth(size_, never_exceeded, {"sweeps", 1}));
    for (const LimiterChoice& choice : options_.choices)
      if ((choice.solver == "direct") == direct) add(rate_, choice, limited_cloth(size_, rate_, choice));
    return timed(variants, direct ? std::min(direct_repeats, options_.repeats) : options_.repeats);
  }

 private:
  std::vector<LimiterRow> timed(std::vector<Variant>& variants, int repeats) const {
    const double per_particle = 1e9 / (size_ * size_);
    std::vector<Subject> subjects;
    for (Variant& variant : variants)
      subjects.push_back({variant.row.solver, per_particle, [&variant, this](int times) {
                            variant.simulation->restore(start_);
                            variant.count = {};
                            advance(*variant.simulation, times, variant.count);
                            return true;
                          }});
    time_interleaved(subjects, {.repeats = repeats, .moment = options_.moment, .budget = 60},
                     [](double, const std::string&) { return true; });
    std::vector<LimiterRow> rows;
    for (std::size_t k = 0; k < variants.size(); ++k) {
      LimiterRow row = variants[k].row;
      const LimiterCount& count = variants[k].count;
      row.time = spread_of(subjects[k]);
      row.least = least_of(subjects[k]);
      row.to_bare = row.least / least_of(subjects[0]);
      row.sweeps = count.sweeps / count.steps;
      row.iterations = count.iterations / count.steps;
      row.mean_excess = count.excess / count.steps;
      row.largest_excess = count.largest_excess;
      rows.push_back(row);
    }
    return rows;
  }

  int size_;
  double rate_;
  const LimiterOptions& options_;
  Checkpoint start_;
};

std::string name_of(const LimiterRow& row) {
  if (row.rate == 0) return "no limiter";
  if (row.solver.empty()) return "limiter that finds nothing";
  if (row.solver == "direct") return fmt::format("{:g} %, direct", 100 * row.rate);
  return fmt::format("{:g} %, {}, at most {}", 100 * row.rate, row.solver, row.max_sweeps);
}

}  // namespace

std::vector<LimiterRow> measure_limiter(int size, const LimiterOptions& options) {
  std::vector<LimiterRow> rows;
  for (const double rate : options.rates) {
    const RateMeasurement measurement(size, rate, options);
    std::vector<LimiterRow> swept = measurement.measure(false), direct;
    if (std::any_of(options.choices.begin(), options.choices.end(),
                    [](const LimiterChoice& choice) { return choice.solver == "direct"; }))
      direct = measurement.measure(true);
    rows.insert(rows.end(), swept.begin(), swept.end());
    if (!direct.empty()) rows.insert(rows.end(), direct.begin() + 1, direct.end());
  }
  return rows;
}

std::string limiter_table(int size, const std::vector<LimiterRow>& rows) {
  std::string text =
      fmt::format("\n{0} x {0}\n  {1:<28} {2:>9} {3:>9} {4:>9} {5:>8} {6:>10} {7:>12} {8:>9}\n", size, "step",
                  "least ns", "median", "to bare", "sweeps", "iterations", "mean excess", "largest");
  for (const LimiterRow& row : rows) {
    if (row.rate == 0) text += "\n";
    text += fmt::format("  {:<28} {:>9.1f} {:>9.1f} {:>9.2f} {:>8.1f} {:>10.1f} {:>12.1e} {:>9.1e}\n",
                        name_of(row), row.least, row.time.median, row.to_bare, row.sweeps, row.iterations,
                        row.mean_excess, row.largest_excess);
  }
  return text;
}

}  // namespace cloth::speed
