#include "bench/speed/step_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "bench/speed/reference_kernel.h"
#include "integrators/registry.h"

namespace cloth::speed {

namespace {

constexpr double nanoseconds = 1e9;
const char* const kernel_feature = "damping";  // the reference kernel is that of a damped cloth
const char* const damped_springs_feature = "spring-damping";

struct Variant {
  Wanted wanted;
  std::unique_ptr<Simulation> simulation;
  std::optional<Divergence> divergence = {};
  StepCount warm = {};  ///< when the samples began
};

/// Seconds of a step at `size`, as the next smaller size that was timed tells; 0 if none was.
double predicted_seconds(int size, const Wanted& wanted, const std::vector<StepCost>& smaller) {
  const StepCost* nearest = nullptr;
  for (const StepCost& row : smaller)
    if (Wanted{row.method, row.feature, row.threads} == wanted && row.size < size && row.samples > 0 &&
        (!nearest || row.size > nearest->size))
      nearest = &row;
  if (!nearest) return 0;
  const double ratio = static_cast<double>(size) / nearest->size;
  return nearest->seconds_per_step() * ratio * ratio;
}

bool advance(Variant& variant, int steps) {
  variant.divergence = variant.simulation->advance(steps);
  return !variant.divergence;
}

std::string title_of(const Wanted& wanted) {
  const Feature& feature = feature_named(wanted.feature);
  return feature.title.empty() ? wanted.method : wanted.method + ", " + feature.title;
}

/// How far the yardstick is from semi-implicit Euler after some steps, in m: the two must compute the same
/// motion.
double disagreement(const Scene& scene, const DevelopedCloth& start) {
  Simulation simulation(scene);
  start.put_into(simulation);
  ReferenceKernel kernel(scene, simulation.system(), simulation.state());
  const int steps = std::clamp(1'000'000 / simulation.system().size(), 10, 100);
  for (int k = 0; k < steps; ++k) {
    kernel.step(simulation.time_step());
    if (simulation.step()) break;
  }
  return kernel.distance_to(simulation.state().position);
}

/// The variant's row, without the ratios to other rows.
StepCost cost_of(const Variant& variant, const Subject& subject, const Yardsticks& yardsticks) {
  const Simulation& simulation = *variant.simulation;
  const StepCount count = simulation.count().since(variant.warm);
  const auto each_step = [&](std::int64_t number) {
    return static_cast<double>(number) / static_cast<double>(std::max<std::int64_t>(1, count.steps));
  };
  StepCost row{.size = simulation.system().columns,
               .method = variant.wanted.method,
               .feature = variant.wanted.feature,
               .threads = variant.wanted.threads,
               .time_step = simulation.time_step(),
               .samples = static_cast<int>(subject.samples.size()),
               .time = spread_of(subject),
               .evaluations = each_step(count.force_evaluations),
               .inner_steps = std::max(1.0, each_step(count.inner_steps + count.rejected_steps)),
               .sweeps = each_step(count.limiter_sweeps),
               .velocity_iterations = each_step(count.velocity_iterations),
               .linear_iterations = each_step(count.linear_iterations)};
  double springs = 0;
  for (const SpringRun& run : simulation.system().springs) springs += run.count;
  springs /= simulation.system().size();
  if (const double floor = divider_floor(yardsticks, springs, row.evaluations); floor > 0)
    row.to_divider = row.time.median / floor;
  if (const double floor = memory_floor(yardsticks); floor > 0) row.to_memory = row.time.median / floor;
  if (variant.divergence) row.remark = describe(*variant.divergence);
  return row;
}

/// The reference kernel first, then the variants in their order. `subjects` stand in the same order.
std::vector<StepCost> rows_of(const std::vector<Variant>& variants, const std::vector<Subject>& subjects,
                              const Simulation& kernel_source, const Yardsticks& yardsticks) {
  std::vector<StepCost> rows;
  rows.push_back({.size = kernel_source.system().columns,
                  .method = reference_method,
                  .feature = kernel_feature,
                  .time_step = kernel_source.time_step(),
                  .samples = static_cast<int>(subjects[0].samples.size()),
                  .time = spread_of(subjects[0]),
                  .to_reference = {1, 1, 1, 1},
                  .evaluations = 1});
  for (std::size_t k = 0; k < variants.size(); ++k) {
    StepCost row = cost_of(variants[k], subjects[k + 1], yardsticks);
    row.to_reference = ratio_of(subjects[k + 1], subjects[0]);
    for (std::size_t other = 0; other < variants.size(); ++other)
      if (variants[other].wanted == Wanted{row.method, bare_feature().name, row.threads})
        row.to_bare = ratio_of(subjects[k + 1], subjects[other + 1]);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// What is timed at one size.
struct Field {
  std::vector<Variant> variants;
  std::vector<StepCost> left_out;
};

/// Puts the variants into the state from which they are timed. Nothing: `progress` ended it.
std::optional<Field> prepare(int size, const std::vector<Wanted>& wanted, const StepPlan& plan,
                             DevelopedCloths& cloths, const std::vector<StepCost>& smaller,
                             const TimingProgress& progress) {
  Field field;
  for (const Wanted& asked : wanted) {
    if (progress && !progress(0, title_of(asked))) return std::nullopt;
    const double seconds = predicted_seconds(size, asked, smaller);
    if (seconds > plan.longest_step) {
      field.left_out.push_back({.size = size,
                                .method = asked.method,
                                .feature = asked.feature,
                                .threads = asked.threads,
                                .remark = fmt::format("left out: a step would take some {:.2g} s", seconds)});
      continue;
    }
    const Scene scene = hanging_cloth(size, asked.method, feature_named(asked.feature));
    Variant variant{asked, std::make_unique<Simulation>(scene)};
    variant.wanted.threads = use_threads(*variant.simulation, asked.threads);
    const auto is_same = [&](const Variant& other) { return other.wanted == variant.wanted; };
    if (std::any_of(field.variants.begin(), field.variants.end(), is_same)) continue;
    cloths.of(asked.feature).put_into(*variant.simulation);
    field.variants.push_back(std::move(variant));
  }
  return field;
}

/// Where simulations have threads, asks for them; else a step takes one.
template <class Engine>
int threads_used(Engine& engine, [[maybe_unused]] int threads) {
  if constexpr (requires { engine.set_threads(threads); }) {
    engine.set_threads(threads);
    return engine.threads();
  } else {
    return 1;
  }
}

/// Threads need some steps to be chosen or not, and what nobody sees is only left out of several steps at
/// once.
Subject subject_of(Variant& variant, double scale) {
  constexpr int steps_between_rows = 16;
  const bool shared = variant.wanted.threads > 1;
  const bool in_one_pass = variant.wanted.feature == bare_feature().name ||
                           variant.wanted.feature == kernel_feature ||
                           variant.wanted.feature == damped_springs_feature;
  return {.name = title_of(variant.wanted),
          .scale = scale,
          .run = [&variant](int steps) { return advance(variant, steps); },
          .threads = variant.wanted.threads,
          .runs_to_settle = shared ? 4 * ThreadChoice::trial : 1,
          .moments = shared ? 8.0 : 1.0,
          .runs_at_least = in_one_pass && facts_of(variant.wanted.method).evaluations_per_step > 0
                               ? steps_between_rows
                               : 1,
          .warm = [&variant] { variant.warm = variant.simulation->count(); }};
}

}  // namespace

int use_threads(Simulation& simulation, int threads) {
  return threads_used(simulation, threads);
}

SizeCosts measure_size(int size, const std::vector<Wanted>& wanted, const StepPlan& plan,
                       DevelopedCloths& cloths, const std::vector<StepCost>& smaller,
                       const TimingProgress& progress) {
  SizeCosts result;
  std::optional<Field> field = prepare(size, wanted, plan, cloths, smaller, progress);
  if (!field) return result;

  const Scene plain = hanging_cloth(size, "semi-implicit-euler", feature_named(kernel_feature));
  const DevelopedCloth& start = cloths.of(kernel_feature);
  result.disagreement = disagreement(plain, start);
  Simulation source(plain);
  start.put_into(source);
  ReferenceKernel kernel(plain, source.system(), source.state());

  const double per_particle = nanoseconds / (static_cast<double>(size) * size);
  std::vector<Subject> subjects;
  subjects.push_back({"reference kernel", per_particle, [&, h = source.time_step()](int steps) {
                        for (int k = 0; k < steps; ++k) kernel.step(h);
                        return true;
                      }});
  for (Variant& variant : field->variants) subjects.push_back(subject_of(variant, per_particle));
  result.complete = time_interleaved(subjects, plan.timing, progress);
  if (!result.complete) return result;
  result.rows = rows_of(field->variants, subjects, source, plan.yardsticks);
  result.rows.insert(result.rows.end(), field->left_out.begin(), field->left_out.end());
  return result;
}

}  // namespace cloth::speed
