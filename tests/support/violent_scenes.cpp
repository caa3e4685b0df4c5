#include "support/violent_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "cloth/grid.h"
#include "geometry/bounds.h"
#include "scene/obstacle_shape.h"

namespace cloth::test {
namespace {

/// splitmix64 (Steele et al. 2014).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  int integer(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double part) { return uniform(0, 1) < part; }
  Vec3 vector() {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    return {x, y, z};
  }

 private:
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

ClothSheet drawn_sheet(Draw& draw) {
  ClothSheet sheet;
  sheet.rows = draw.integer(5, 22);
  sheet.columns = draw.integer(5, 22);
  sheet.width = 1;
  sheet.height = static_cast<double>(sheet.rows - 1) / (sheet.columns - 1);
  sheet.mass = draw.logarithmic(0.05, 2);
  sheet.origin = {0, 0, 0};
  sheet.across = {1, 0, 0};
  sheet.down = draw.chance(0.5) ? Vec3(0, -1, 0) : Vec3(0, -1, draw.uniform(-10, 10)).normalized();
  constexpr std::array<std::array<int, 4>, 5> choices{
      {{-1, -1, -1, -1}, {0, -1, -1, -1}, {1, 2, -1, -1}, {3, 4, -1, -1}, {1, 2, 5, 6}}};
  constexpr std::array<NamedPin, 7> names{NamedPin::top_edge,    NamedPin::top_left,   NamedPin::top_right,
                                          NamedPin::left_edge,   NamedPin::right_edge, NamedPin::bottom_left,
                                          NamedPin::bottom_right};
  for (const int pin : choices[static_cast<std::size_t>(draw.integer(0, 4))])
    if (pin >= 0) sheet.pins.emplace_back(names[static_cast<std::size_t>(pin)]);
  return sheet;
}

/// As soft as its own weight stretches it thirtyfold, as stiff as a thousandth; other families in any ratio.
SpringMaterial drawn_springs(const ClothSheet& sheet, Draw& draw) {
  const double mass = sheet.mass / (sheet.rows * sheet.columns);
  const double strain = draw.logarithmic(1e-3, 30);
  SpringMaterial springs;
  springs.structural = sheet.rows * mass * 9.81 / (strain / (sheet.columns - 1));
  springs.shear = springs.flexion = 0;
  const double kind = draw.uniform(0, 1);
  if (kind >= 0.3 && (kind < 0.6 || kind >= 0.7))
    springs.shear = springs.structural * draw.logarithmic(1e-2, kind < 0.6 ? 1e3 : 10);
  if (kind >= 0.6) springs.flexion = springs.structural * draw.logarithmic(1e-2, kind < 0.7 ? 1e3 : 100);
  return springs;
}

void draw_damping(Scene& scene, Draw& draw) {
  SpringMaterial& springs = *scene.springs;
  const double mass = scene.cloth.mass / (scene.cloth.rows * scene.cloth.columns);
  const double critical =
      2 * std::sqrt(std::max({springs.structural, springs.shear, springs.flexion}) * mass);
  const double kind = draw.uniform(0, 1);
  springs.damping = 0;
  if (kind >= 0.5 && (kind < 0.65 || kind >= 0.8))
    scene.damping = critical * draw.logarithmic(1e-4, kind < 0.65 ? 0.1 : 0.01);
  if (kind >= 0.65) springs.damping = critical * draw.logarithmic(1e-4, kind < 0.8 ? 1 : 0.3);
  if (draw.chance(0.3)) {
    scene.air = Air{.drag = critical * draw.logarithmic(1e-3, 1),
                    .wind = draw.vector() * draw.logarithmic(0.3, 10),
                    .gust = std::nullopt};
    scene.air->gust = Gust{.amplitude = draw.uniform(0, 1.5), .frequency = draw.logarithmic(0.2, 5)};
  }
}

/// What is done to the flat cloth before the first step; free particles alone move.
Preparation drawn_start(const ClothSheet& sheet, Draw& draw) {
  const int kind = draw.integer(0, 4);
  const double cell = 1.0 / (sheet.columns - 1);
  const double size = kind == 1   ? draw.logarithmic(0.1, 10)
                      : kind == 2 ? draw.uniform(0.5, 3)
                                  : draw.logarithmic(0.1, 4);
  const Vec3 velocity = draw.chance(0.4) ? Vec3(draw.vector() * draw.logarithmic(0.1, 10)) : Vec3(0, 0, 0);
  const std::uint64_t seed = static_cast<std::uint64_t>(draw.integer(0, 1 << 30));
  return [=](ClothSystem& system, ClothState& state) {
    Draw noise(seed);
    const Vec3 corner = system.start[0], middle = system.start[system.start.size() / 2];
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      Vec3 x = system.start[i];
      const Vec3 shift = noise.vector(), jitter = noise.vector();
      if (kind == 1) x = middle + size * cell * shift;
      if (kind == 2) x.x() += size * (x - corner).y();
      if (kind == 3 && (i / static_cast<std::size_t>(system.columns)) % 2 == 1)
        x += size * cell * Vec3(0, 0.5, 0.8);
      if (kind == 4) x = corner + (1 + size) * (x - corner);
      if (system.pinned[i]) continue;
      state.position.set(i, x + 1e-4 * cell * jitter);
      state.velocity.set(i, velocity);
    }
  };
}

/// A hand that swings one particle about, or none.
std::function<void(Simulation&)> drawn_hand(const ClothSheet& sheet, Draw& draw) {
  const bool pulls = draw.chance(0.5);
  const int particle = draw.integer(0, sheet.rows * sheet.columns - 1);
  const double reach = draw.logarithmic(0.2, 3), frequency = draw.logarithmic(0.05, 3);
  const Vec3 way = draw.vector(), other_way = draw.vector();
  if (!pulls) return [](Simulation&) {};
  return [=](Simulation& simulation) {
    if (simulation.state().step % 4 != 0) return;
    const double phase = 2 * std::numbers::pi * frequency * simulation.time();
    const Vec3 home = simulation.system().start[static_cast<std::size_t>(particle)];
    simulation.set_pull(
        Pull{particle, home + reach * (std::sin(phase) * way + (1 - std::cos(1.7 * phase)) * other_way)});
  };
}

/// Below everything that the start puts somewhere, so that none of it starts inside.
void draw_obstacle(ViolentScene& violent, Draw& draw) {
  Scene& scene = violent.scene;
  ClothSystem system = make_grid(scene.cloth, *scene.springs);
  ClothState state = starting_state(system);
  violent.start(system, state);
  Vec3 low = state.position[0], high = low;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    low = low.cwiseMin(state.position[i]);
    high = high.cwiseMax(state.position[i]);
  }
  Obstacle obstacle;
  obstacle.friction = draw.chance(0.3) ? draw.uniform(1, 5) : draw.uniform(0, 1);
  obstacle.restitution = draw.chance(0.5) ? draw.uniform(0, 1) : 0;
  constexpr double gap = 0.02;  // m
  const Vec3 below((low.x() + high.x()) / 2, low.y() - gap, (low.z() + high.z()) / 2);
  const int kind = draw.integer(0, 2);
  obstacle.shape = kind == 0 ? &sphere_shape() : kind == 1 ? &box_shape() : &plane_shape();
  obstacle.radius = draw.uniform(0.1, 0.6);
  obstacle.center = below - Vec3(0, obstacle.radius, 0);
  obstacle.size = Vec3(1, 1, 1) * draw.uniform(0.1, 1);
  if (kind == 1) obstacle.center = below - Vec3(0, obstacle.size.y() / 2, 0);
  obstacle.point = below;
  obstacle.normal = {0, 1, 0};
  if (violent.family == "continuous contact") {
    obstacle.velocity = {0, draw.uniform(-0.5, 2), 0};
    scene.contact = ContactSettings{.thickness = 0.005};
  }
  scene.obstacles = {obstacle};
}

}  // namespace

ViolentScene violent_scene(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed * 0x100000001b3u + number * 7919 + 13);
  ViolentScene violent;
  Scene& scene = violent.scene;
  scene.cloth = drawn_sheet(draw);
  scene.springs = drawn_springs(scene.cloth, draw);
  if (!draw.chance(0.08)) scene.gravity = Vec3(0, -9.81, 0);
  draw_damping(scene, draw);
  const std::array<const char*, 5> methods{"verlet", "verlet", "semi-implicit-euler", "semi-implicit-euler",
                                           "rk4"};
  scene.integrator = {.method = methods[static_cast<std::size_t>(draw.integer(0, 4))]};
  scene.record.interval = draw.logarithmic(2e-3, 0.1);
  violent.start = drawn_start(scene.cloth, draw);
  violent.before_step = drawn_hand(scene.cloth, draw);
  const double family = draw.uniform(0, 1);
  violent.family = family < 0.5    ? "plain"
                   : family < 0.75 ? "limited"
                   : family < 0.93 ? "contact"
                                   : "continuous contact";
  violent.steps = violent.family == "plain" ? 3000 : violent.family == "continuous contact" ? 150 : 1000;
  if (violent.family == "limited" || draw.chance(0.1)) {
    scene.deformation = Deformation{.rate = draw.logarithmic(3e-3, 0.5)};
    violent.steps = std::min<std::int64_t>(violent.steps, 600);
  }
  if (violent.family.find("contact") != std::string::npos) draw_obstacle(violent, draw);
  return violent;
}

ViolentRun run_violent(const ViolentScene& violent, std::int64_t steps) {
  Simulation simulation(violent.scene, violent.start);
  const double first = simulation.time_step();
  ViolentRun run;
  for (std::int64_t n = 0; n < std::min(steps, violent.steps) && !run.divergence; ++n) {
    violent.before_step(simulation);
    run.divergence = simulation.step();
    if (n % ledger_interval == 0) {
      const double error = std::abs(simulation.measure().energy_error()) / simulation.energy_scale();
      run.largest_error = std::max(run.largest_error, error);
    }
  }
  run.mean_step = simulation.time() / static_cast<double>(simulation.state().step) / first;
  run.shortened = simulation.step_changes().size();
  return run;
}

}  // namespace cloth::test
