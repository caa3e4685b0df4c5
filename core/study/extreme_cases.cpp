// The list of extreme cases.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "scene/obstacle_shape.h"
#include "study/extremes.h"

namespace cloth {
namespace {

constexpr double frame = 1.0 / 60;        // s
constexpr double base_step = 0.002;       // s: a quarter of Verlet's limit for the base scene
constexpr double particle_spacing = 0.1;  // m

/// What most cases differ from in one thing: 9 x 9 particles of 10 g, 0.1 m apart, hung by two corners.
Scene base_scene(int rows = 9, int columns = 9) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.width = particle_spacing * (columns - 1);
  scene.cloth.height = particle_spacing * (rows - 1);
  scene.cloth.mass = 0.01 * rows * columns;
  scene.cloth.origin = Vec3::Zero();
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = 0};
  scene.damping = 0.001;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator.time_step = base_step;
  scene.duration = 1e5;  // the bound is on steps
  scene.record.interval = frame;
  return scene;
}

Scene scene_with_stiffness(double stiffness) {
  Scene scene = base_scene();
  scene.springs = SpringMaterial{
      .structural = stiffness, .shear = 0.5 * stiffness, .flexion = 0.1 * stiffness, .damping = 0};
  return scene;
}

/// The same numbers everywhere: a standard engine, and a distribution of our own, which no library changes.
class Random {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  Vec3 vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return {x, y, z};
  }

 private:
  std::mt19937_64 engine_{extreme_seed};
};

template <class Visit>  // visit(i)
void for_each_free(const ClothSystem& system, Visit visit) {
  for (std::size_t i = 0; i < system.pinned.size(); ++i)
    if (!system.pinned[i]) visit(i);
}

std::size_t place_of(const ClothSystem& system, int row, int column) {
  return static_cast<std::size_t>(system.index(row, column));
}

/// Hung straight down a stiff cloth hardly moves, and shows nothing of what a method does to motion: this one
/// starts tilted, to swing, and is pushed.
Scene swinging_scene(double stiffness) {
  Scene scene = scene_with_stiffness(stiffness);
  scene.cloth.down = {0, -1, 0.3};
  return scene;
}

void push(ClothSystem& system, ClothState& state) {
  Random random;
  for_each_free(system, [&](std::size_t i) {
    state.velocity.set(i, Vec3(0.3, 0, 1) + random.vector(0.3));  // m/s
  });
}

void add_stiffness(std::vector<ExtremeCase>& cases) {
  constexpr std::int64_t two_seconds = 120;  // in frames
  for (int decade = 0; decade <= 9; ++decade) {
    Scene scene = swinging_scene(std::pow(10, decade));
    scene.integrator.time_step = frame;
    cases.push_back(
        {fmt::format("stiffness-1e{}", decade),
         fmt::format(
             "Structural springs of 1e{} N/m, shear a half and flexion a tenth of it, at "
             "steps of 1/60 s, two seconds. The cloth starts tilted by 17 degrees and pushed at 1 m/s, "
             "each particle up to 0.3 m/s differently (seed {}).",
             decade, extreme_seed),
         "An explicit method follows its fastest oscillation or it grows: the limit falls with "
         "the root of the stiffness. Error control follows it too, at the cost of thousands of inner "
         "steps. Implicit methods have no limit for small motions about a shape; this cloth swings and "
         "buckles. The midpoint rule damps nothing, so that what it cannot resolve feeds itself. A few "
         "iterations "
         "of projective dynamics do not converge: the cloth moves too slowly. XPBD's one iteration a substep "
         "leaves stiff springs a little too long, and at a high stiffness a little strain is much energy; "
         "so do VBD's iterations, until they are some hundreds.",
         scene, two_seconds, push});
  }
  for (const int decade : {0, 3, 6, 9}) {
    Scene scene = swinging_scene(std::pow(10, decade));
    scene.integrator.time_step.reset();
    scene.duration = 2;
    cases.push_back(
        {fmt::format("stiffness-1e{}-own-step", decade),
         fmt::format("The same springs of 1e{} N/m, each method at its own automatic step, 1/60 s "
                     "at most: two seconds or 2000 steps.",
                     decade),
         "At its own step every method that has one must be stable; methods without a limit run "
         "at 1/60 s, as "
         "above.",
         scene, 2000, push});
  }
}

void add_masses(std::vector<ExtremeCase>& cases) {
  Scene scene = scene_with_stiffness(1e4);
  scene.cloth.mass = 0.001 * 81;
  scene.integrator.time_step = 1e-4;
  cases.push_back(
      {"mass-ratio-1e5",
       "100 kg in the middle of the lower edge of a cloth whose other particles have 1 g, springs of 1e4 "
       "N/m, steps of 0.1 ms.",
       "The light particles set the step, the heavy one the load. Iterations that pass a message from "
       "spring to spring leave the springs too long.",
       scene, 500, [](ClothSystem& system, ClothState&) {
         const std::size_t heavy = place_of(system, system.rows - 1, system.columns / 2);
         system.mass[heavy] *= 1e5;
         system.inverse_mass[heavy] /= 1e5;
       }});
}

void add_steps(std::vector<ExtremeCase>& cases) {
  const auto add = [&](const char* name, const char* words, double step, std::int64_t most) {
    Scene scene = base_scene();
    scene.integrator.time_step = step;
    cases.push_back({name, fmt::format("The base scene at steps of {}, {} of them.", words, most),
                     "Verlet's limit for this scene is 8.2 ms, others' are near it; explicit Euler's is "
                     "2 microseconds.",
                     scene, most});
  };
  add("step-1e-6", "1e-6 s", 1e-6, 300);
  add("step-1e-4", "1e-4 s", 1e-4, 300);
  add("step-1e-2", "1e-2 s", 1e-2, 200);
  add("step-1s", "1 s", 1, 50);
}

void add_damping(std::vector<ExtremeCase>& cases) {
  Scene none = base_scene();
  none.damping.reset();
  const std::string reading =
      "Without damping nothing hides what a method adds. Explicit Euler amplifies every oscillation at every "
      "step: it has no stable one.";
  cases.push_back({"no-damping", "The base scene without any damping.", reading, none, 500});
  none.integrator.time_step.reset();
  none.duration = 2;
  cases.push_back(
      {"no-damping-own-step", "The same, each method at its own automatic step.", reading, none, 2000});

  Scene enormous = base_scene();
  enormous.damping = 1e4;
  enormous.springs->damping = 1e3;
  cases.push_back({"enormous-damping",
                   "Viscous damping of 1e4 N s/m on particles of 10 g and spring damping of 1e3 N s/m: "
                   "nothing should move.",
                   "A method that takes damping explicitly is limited by it as by a stiff spring: here to a "
                   "microsecond.",
                   enormous, 300});
}

void add_rates(std::vector<ExtremeCase>& cases) {
  const auto limited = [](double rate) {
    Scene scene = base_scene();
    scene.deformation = Deformation{.rate = rate, .springs = {"structural", "shear"}};
    return scene;
  };
  const std::string reading =
      "The limiter works on what the method gives it: where the method has diverged, no rate helps. What is "
      "left above the rate is in the table.";
  cases.push_back(
      {"rate-0", "Structural and shear springs may not stretch at all.", reading, limited(0), 300});
  cases.push_back({"rate-0.1-percent", "Structural and shear springs may stretch by 0.1 %.", reading,
                   limited(0.001), 300});
  cases.push_back({"unreachable-pins",
                   "A rate of 10 %, and one of the two pins a third of the width further out than the cloth "
                   "at rest is wide: no shape keeps the rate.",
                   "The right answer is unreachable: it is found from the pins' distance before the first "
                   "step, and the run goes on with the violation that the sweeps leave.",
                   limited(0.1), 300, [](ClothSystem& system, ClothState& state) {
                     state.position.add(place_of(system, 0, system.columns - 1), {system.diagonal / 3, 0, 0});
                   }});
}

void add_shapes(std::vector<ExtremeCase>& cases) {
  cases.push_back({"zero-length-springs",
                   "All shear springs have a rest length of zero and pull the cells together.",
                   "A spring of no length has no direction where its ends meet: its force is zero there.",
                   base_scene(), 300, [](ClothSystem& system, ClothState&) {
                     for (SpringBlock& block : system.springs.blocks())
                       if (block.run.family == SpringFamily::shear) block.run.rest_length = 0;
                   }});
  Scene limited = base_scene();
  limited.deformation = Deformation{};
  cases.push_back({"coincident-particles",
                   "Every second particle starts exactly on its left neighbour, with a rate of 10 %.",
                   "Ends that meet have no direction, and the direction turns round where they pass each "
                   "other: a force that jumps, in which every method is of low order. What is too long at "
                   "the start is brought within the rate before the first step.",
                   limited, 300, [](ClothSystem& system, ClothState& state) {
                     for_each_free(system, [&](std::size_t i) {
                       if (i % static_cast<std::size_t>(system.columns) % 2 == 1)
                         state.position.set(i, state.position[i - 1]);
                     });
                   }});
  Scene airy = base_scene();
  airy.air = Air{.drag = 0.01, .wind = {0, 0, 5}, .gust = {}};
  cases.push_back({"collapsed-to-a-point", "All particles, the pins too, start in one point, in a wind.",
                   "All directions and normals are zero until something parts the particles; then springs "
                   "push ends apart that are almost in one point, with a force that turns round where they "
                   "pass each other: energy is made there, less with shorter steps.",
                   airy, 300, [](ClothSystem&, ClothState& state) {
                     for (std::size_t i = 0; i < state.position.size(); ++i)
                       state.position.set(i, Vec3::Zero());
                   }});
  cases.push_back(
      {"scrambled",
       fmt::format("Every free particle starts at random in a cube of 1 m (seed {}).", extreme_seed),
       "The start holds many times the energy of the cloth's fall, and stretched springs "
       "oscillate faster than at rest.",
       airy, 300, [](ClothSystem& system, ClothState& state) {
         Random random;
         for_each_free(system, [&](std::size_t i) { state.position.set(i, random.vector(0.5)); });
       }});
  Scene compressed = base_scene();
  compressed.gravity.reset();
  compressed.damping.reset();
  compressed.cloth.pins = {NamedPin::left_edge, NamedPin::right_edge};
  cases.push_back({"compressed-5-percent",
                   fmt::format("Two opposite edges pinned 5 % too near to each other, the cloth flat but for "
                               "0.001 mm at random (seed {}), neither gravity nor damping: it buckles.",
                               extreme_seed),
                   "Flat is an equilibrium that no small disturbance survives; a method may lose the energy "
                   "of the buckling but not add to it.",
                   compressed, 500, [](ClothSystem& system, ClothState& state) {
                     Random random;
                     double* x = state.position.x();
                     for (std::size_t i = 0; i < state.position.size(); ++i) x[i] *= 0.95;
                     for_each_free(system, [&](std::size_t i) {
                       state.position.add(i, {0, 0, random.uniform(-1e-6, 1e-6)});
                     });
                   }});
}

void add_grids(std::vector<ExtremeCase>& cases) {
  cases.push_back({"cloth-2x2", "The smallest cloth: four particles, two of them pinned, no flexion spring.",
                   "Two free particles oscillate as any cloth does, so each method has its limit here too.",
                   base_scene(2, 2), 300});
  Scene rope = base_scene(2, 500);
  rope.cloth.pins = {NamedPin::left_edge};
  cases.push_back({"cloth-2x500", "A band of 2 x 500 particles, 50 m long, held at one end.",
                   "The springs are those of the base scene, and so are the limits.", rope, 150});
  Scene pinned = base_scene();
  pinned.cloth.pins.clear();
  for (int row = 0; row < pinned.cloth.rows; ++row)
    for (int column = 0; column < pinned.cloth.columns; ++column)
      pinned.cloth.pins.emplace_back(PinnedParticle{row, column});
  cases.push_back({"all-pinned", "Every particle pinned: nothing can move.",
                   "No method may move what is pinned.", pinned, 300});
  Scene free = base_scene();
  free.cloth.pins.clear();
  free.gravity.reset();
  free.damping.reset();
  cases.push_back({"free-without-gravity",
                   "No pins, no gravity, no damping: the cloth spins at 10 rad/s in its plane for a second.",
                   "Energy and angular momentum should stay as they are.", free, 500,
                   [](ClothSystem& system, ClothState& state) {
                     const Vec3 centre = 0.5 * (system.start[0] + system.start[system.mass.size() - 1]);
                     for_each_free(system, [&](std::size_t i) {
                       state.velocity.set(i, Vec3(0, 0, 10).cross(state.position[i] - centre));
                     });
                   }});
}

void add_outside(std::vector<ExtremeCase>& cases) {
  Scene hurricane = scene_with_stiffness(1e3);
  hurricane.air = Air{.drag = 0.05, .wind = {0, 0, 100}, .gust = {}};
  hurricane.integrator.time_step = 0.001;
  cases.push_back(
      {"hurricane",
       "A wind of 100 m/s square on the cloth, 5 N on every particle of 10 g, springs of 1e3 N/m, "
       "steps of 1 ms.",
       "The corners are stretched to several times their length, which raises the frequencies by "
       "up to a half.",
       hurricane, 500});
  Scene around = base_scene();
  around.obstacles = {Obstacle{.shape = &sphere_shape(), .center = around.cloth.origin, .radius = 0.25}};
  cases.push_back(
      {"obstacle-around-a-pin",
       "A ball of 0.25 m with one of the two pins in its centre: the pin stays, its neighbours "
       "are put on the surface, their springs stretched for good. A run refuses such a start.",
       "Putting them there adds elastic energy that no work accounts for: growth, in every method, is that "
       "of "
       "the start. Springs that are stretched for good oscillate a little faster, within the margin of the "
       "base step.",
       around, 300});
  Scene bullet = base_scene();
  bullet.obstacles = {Obstacle{.shape = &box_shape(), .center = {0.4, -0.4, -0.25}, .size = {2, 2, 0.01}}};
  cases.push_back(
      {"particle-at-1-km/s",
       "The middle particle starts at 1 km/s toward a box 10 mm thick and 0.25 m away: 2 m in the "
       "first step.",
       "Contact looks at positions after a step, so a particle that moves further than the box is "
       "thick can pass it unseen; the warning says so.",
       bullet, 300, [](ClothSystem& system, ClothState& state) {
         state.velocity.set(place_of(system, system.rows / 2, system.columns / 2), {0, 0, -1000});
       }});
  Scene far = base_scene();
  far.cloth.origin = {1e6, 1e6, 1e6};
  cases.push_back({"1e6-m-away",
                   "The base scene a million metres from the origin along every axis: positions are rounded "
                   "to 1e-10 m, a billionth of a spring.",
                   "Nothing but the last digits may differ from the base scene.", far, 300});
}

}  // namespace

const std::vector<ExtremeCase>& extreme_cases() {
  static const auto list = [] {
    std::vector<ExtremeCase> cases;
    add_stiffness(cases);
    add_masses(cases);
    add_steps(cases);
    add_damping(cases);
    add_rates(cases);
    add_shapes(cases);
    add_grids(cases);
    add_outside(cases);
    return cases;
  }();
  return list;
}

}  // namespace cloth
