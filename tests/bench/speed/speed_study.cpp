#include "bench/speed/speed_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "integrators/registry.h"
#include "scene/builtin_scenes.h"

namespace cloth::speed {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The bare cloth is always there: ratios need it.
bool asks_for(const SpeedOptions& options, const Feature& feature) {
  return options.features.empty() || holds(options.features, feature.name) ||
         feature.name == bare_feature().name;
}

/// Methods whose step is a fixed number of force evaluations.
bool is_explicit(const std::string& method) {
  return facts_of(method).evaluations_per_step > 0;
}

const std::vector<int>& sizes_of(const SpeedOptions& options) {
  static const std::vector<int> usual{32, 64, 128, 256, 512}, quick{16, 24, 32};
  if (!options.sizes.empty()) return options.sizes;
  return options.quick ? quick : usual;
}

/// Solving equations at every size would take hours: without sizes given it ends here.
constexpr int largest_implicit = 128;

std::vector<int> threads_of(const SpeedOptions& options) {
  if (!options.threads.empty()) return options.threads;
  const int all = static_cast<int>(std::thread::hardware_concurrency());
  return all > 1 ? std::vector<int>{1, all} : std::vector<int>{1};
}

TimingPlan timing_of(const SpeedOptions& options) {
  TimingPlan plan{.repeats = options.repeats, .moment = 0.005, .budget = 6};
  if (options.quick) plan.moment = 0.001, plan.budget = 0.05;
  return plan;
}

/// The study, part after part.
class Study {
 public:
  explicit Study(const SpeedOptions& options) : options_(options) {
    report_.machine = machine_facts();
    report_.repeats = options.repeats;
  }

  SpeedReport run() {
    // Memory first: nothing has been allocated and given back yet.
    report_.complete = (!has("memory") || measure_memories()) && (!has("start") || measure_starts()) &&
                       (!has("scenes") || measure_scenes()) && (!has("contact") || measure_contacts()) &&
                       (!has("steps") || measure_steps());
    return std::move(report_);
  }

 private:
  bool has(const char* part) const { return options_.parts.empty() || holds(options_.parts, part); }

  /// A share of the whole, by what it usually takes.
  struct Share {
    double from = 0, to = 1;
  };

  bool goes_on(Share share, double fraction, const std::string& text) const {
    return !options_.progress || options_.progress(share.from + fraction * (share.to - share.from), text);
  }

  bool measure_memories() {
    const auto& methods = options_.methods.empty() ? integrator_names() : options_.methods;
    double done = 0;
    for (const std::string& method : methods) {
      if (!goes_on({0, 0.04}, done++ / static_cast<double>(methods.size()), "memory, " + method))
        return false;
      const int size = options_.quick ? 64 : is_explicit(method) ? 256 : largest_implicit;
      for (const Feature& feature : features())
        if (asks_for(options_, feature) && (is_explicit(method) || feature.name == bare_feature().name))
          report_.memory.push_back(measure_memory(method, feature.name, size));
    }
    return true;
  }

  bool measure_starts() {
    constexpr Share share{0.04, 0.08};
    const int starts = options_.quick ? 3 : 20, openings = options_.quick ? 1 : 5;
    const int size = options_.quick ? 128 : 1024;
    if (!goes_on(share, 0, "start")) return false;
    if (!options_.program.empty()) {
      const Scene scene = builtin_scene("corners-shear");
      const std::string step = fmt::format("{:.17g}", scene.integrator.time_step.value_or(1e-4));
      report_.starts.push_back(measure_start(
          "clothlab-cli run, 33 x 33, one step", options_.program,
          {"run", "corners-shear", "--set", "integrator.time_step=" + step, "--set", "duration=" + step},
          starts));
    }
    for (const bool top_edge : {false, true}) {
      if (!goes_on(share, top_edge ? 0.7 : 0.3, fmt::format("opening {0} x {0}", size))) return false;
      report_.starts.push_back(measure_opening(size, top_edge, openings));
    }
    return true;
  }

  bool measure_scenes() {
    std::vector<std::string> names = options_.scenes;
    if (names.empty())
      for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
    const std::vector<int> sizes = options_.sizes.empty() ? std::vector<int>{0} : options_.sizes;
    double done = 0;
    for (const int size : sizes)
      for (const std::string& name : names) {
        const double all = static_cast<double>(names.size() * sizes.size());
        const std::string text = "scene " + name + (size > 0 ? fmt::format(", {}", size) : "");
        if (!goes_on({0.08, 0.15}, done++ / all, text)) return false;
        add_scene(name, size);
      }
    report_.scene_growth = fit_scene_growth(report_.scenes);
    return true;
  }

  /// What cannot be refined is timed once, as it is.
  void add_scene(const std::string& name, int size) {
    Scene scene = builtin_scene(name);
    std::string why;
    if (size > 0) {
      if (const auto finer = refined(scene, size, why))
        scene = *finer;
      else if (std::any_of(report_.scenes.begin(), report_.scenes.end(),
                           [&](const SceneSpeed& row) { return row.name == name; }))
        return;
    }
    SceneSpeed row = measure_scene(name, scene, options_.quick ? 0.02 : options_.scene_seconds, 1);
    row.size = why.empty() ? size : 0;
    if (!why.empty()) row.remark += (row.remark.empty() ? "" : "; ") + why;
    report_.scenes.push_back(std::move(row));
  }

  bool measure_contacts() {
    ContactPlan plan{.timing = timing_of(options_), .part = 1, .settle = 0.3};
    plan.timing.budget = 1;
    if (options_.quick) plan.part = 0.5, plan.settle = 0.05, plan.timing.budget = 0.05;
    const std::vector<std::string>& scenes = contact_cost_scenes();
    for (std::size_t k = 0; k < scenes.size(); ++k) {
      const double width = 0.05 / static_cast<double>(scenes.size());
      const Share share{0.15 + width * static_cast<double>(k), 0.15 + width * static_cast<double>(k + 1)};
      bool ended = !goes_on(share, 0, "contact, " + scenes[k]);
      if (ended) return false;
      const ContactCost cost =
          measure_contact(scenes[k], plan, [&](double fraction, const std::string& name) {
            ended = ended || !goes_on(share, fraction, name);
            return !ended;
          });
      if (ended) return false;
      report_.contact.push_back(cost);
    }
    return true;
  }

  bool measure_steps() {
    StepPlan plan{.timing = timing_of(options_), .yardsticks = {}, .longest_step = options_.quick ? 0.1 : 3};
    plan.yardsticks =
        measure_yardsticks({.timing = plan.timing, .array_bytes = options_.quick ? std::size_t{1} << 22 : 0},
                           [&](double fraction, const std::string& name) {
                             return goes_on({0.2, 0.25}, fraction, name);
                           });
    report_.yardsticks = plan.yardsticks;

    DevelopedCloths cloths;
    const std::vector<int>& sizes = sizes_of(options_);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const double width = 0.75 / static_cast<double>(sizes.size());
      const Share share{0.25 + width * static_cast<double>(k), 0.25 + width * static_cast<double>(k + 1)};
      const SizeCosts costs =
          measure_size(sizes[k], wanted_rows(options_, sizes[k]), plan, cloths, report_.rows,
                       [&](double fraction, const std::string& name) {
                         return goes_on(share, fraction, fmt::format("{0} x {0}, {1}", sizes[k], name));
                       });
      report_.rows.insert(report_.rows.end(), costs.rows.begin(), costs.rows.end());
      report_.disagreement = std::max(report_.disagreement, costs.disagreement);
      report_.growth = fit_growth(report_.rows);
      if (!costs.complete) return false;
    }
    return true;
  }

  const SpeedOptions& options_;
  SpeedReport report_;
};

}  // namespace

const std::vector<std::string>& speed_parts() {
  static const std::vector<std::string> parts{"steps", "contact", "scenes", "memory", "start"};
  return parts;
}

std::vector<Wanted> wanted_rows(const SpeedOptions& options, int size) {
  const std::vector<std::string> usual{"semi-implicit-euler", "verlet"};
  const std::vector<std::string>& with_features = options.methods.empty() ? usual : options.methods;
  const bool any_size = !options.sizes.empty() || size <= largest_implicit;
  std::vector<Wanted> wanted;
  for (const int threads : threads_of(options)) {
    const auto add = [&](const std::string& method, const Feature& feature) {
      const bool worth = is_explicit(method) || (any_size && threads == 1);
      if (asks_for(options, feature) && worth) wanted.push_back({method, feature.name, threads});
    };
    for (const std::string& method : options.methods.empty() ? integrator_names() : options.methods)
      add(method, bare_feature());
    for (const std::string& method : with_features)
      for (const Feature& feature : features())
        if (feature.name != bare_feature().name) add(method, feature);
  }
  return wanted;
}

SpeedReport study_speed(const SpeedOptions& options) {
  return Study(options).run();
}

}  // namespace cloth::speed
