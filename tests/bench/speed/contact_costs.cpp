#include "bench/speed/contact_costs.h"

#include <algorithm>
#include <cmath>

#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "simulation/simulation.h"

namespace cloth::speed {
namespace {

/// Half as many particles along an edge where all of them would take the bench minutes.
struct TimedScene {
  const char* name;
  double part;
};
constexpr TimedScene timed_scenes[] = {{"slope", 1},    {"corner", 1}, {"twist", 0.5},
                                       {"spikes", 0.5}, {"fold", 0.5}, {"bunny", 0.5}};

int fewer(int particles, double part) {
  constexpr int fewest = 3;
  return std::max(fewest, static_cast<int>(std::lround((particles - 1) * part)) + 1);
}

Scene timed_scene(const std::string& name, double part) {
  Scene scene = builtin_scene(name);
  for (const TimedScene& timed : timed_scenes)
    if (timed.name == name) part *= timed.part;
  scene.cloth.rows = fewer(scene.cloth.rows, part);
  scene.cloth.columns = fewer(scene.cloth.columns, part);
  return scene;
}

Scene without_contact(Scene scene) {
  scene.obstacles.clear();
  scene.contact.reset();
  scene.self_contact.reset();
  return scene;
}

std::size_t triangles_in(const std::vector<Obstacle>& obstacles) {
  std::size_t triangles = 0;
  for (const Obstacle& obstacle : obstacles)
    if (shape_of(obstacle).body == BodyKind::surface) triangles += placed_mesh(obstacle).triangles.size();
  return triangles;
}

/// Goes on until the cloth has lain on something for a while, or to the scene's end.
std::optional<Divergence> settle(Simulation& simulation, double time) {
  bool touched = false;
  double until = simulation.scene().duration;
  while (simulation.time() < until) {
    if (const auto stop = simulation.step()) return stop;
    if (touched || simulation.last_contact().contacts == 0) continue;
    touched = true;
    until = std::min(until, simulation.time() + time);
  }
  return std::nullopt;
}

/// Steps from the same state again and again.
Subject subject_of(const std::string& name, Simulation& simulation, const Checkpoint& start) {
  Subject subject;
  subject.name = name;
  subject.scale = 1e9 / simulation.system().size();
  subject.run = [&simulation, &start](int steps) {
    simulation.restore(start);
    for (int n = 0; n < steps; ++n)
      if (simulation.step()) return false;
    return true;
  };
  return subject;
}

}  // namespace

const std::vector<std::string>& contact_cost_scenes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const TimedScene& timed : timed_scenes) all.emplace_back(timed.name);
    return all;
  }();
  return names;
}

ContactCost measure_contact(const std::string& name, const ContactPlan& plan,
                            const TimingProgress& progress) {
  const Scene scene = timed_scene(name, plan.part);
  ContactCost cost{.scene = name,
                   .rows = scene.cloth.rows,
                   .columns = scene.cloth.columns,
                   .obstacle_triangles = triangles_in(scene.obstacles),
                   .with_itself = scene.self_contact.has_value()};
  Simulation with(scene), without(without_contact(scene));
  if (const auto stop = settle(with, plan.settle)) {
    cost.remark = describe(*stop);
    return cost;
  }
  const Checkpoint start = with.checkpoint();
  std::vector<Subject> subjects{subject_of(name + " without contact", without, start),
                                subject_of(name, with, start)};
  if (!time_interleaved(subjects, plan.timing, progress)) return cost;
  cost.touched = with.last_contact().contacts;
  cost.pairs = with.last_contact().pairs;
  cost.without = spread_of(subjects[0]);
  cost.with = spread_of(subjects[1]);
  cost.ratio = ratio_of(subjects[1], subjects[0]);
  if (subjects[0].broken || subjects[1].broken) cost.remark = "it diverged while it was timed";
  return cost;
}

}  // namespace cloth::speed
