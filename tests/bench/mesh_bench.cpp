// clothlab-mesh-bench: what a step costs on meshes whose springs have no constant offset, beside the
// reference kernel (structs of particles, index pairs, scalar) timed in the same run. Prints figures; judges
// nothing.
//
//     clothlab-mesh-bench [PARTICLES PER SIDE] [REPEATS]
//
// The step is the reference kernel's: semi-implicit Euler with gravity and viscous damping, no ledger.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/speed/interleaved_timing.h"
#include "bench/speed/reference_kernel.h"
#include "bench/speed/speed_scenes.h"
#include "cloth/grid.h"
#include "cloth/mesh_order.h"
#include "kernels/instruction_set.h"
#include "kernels/mesh_sweep.h"
#include "support/meshes.h"

namespace {

using namespace cloth;
using namespace cloth::speed;

constexpr double time_step = 1e-5;  // s
constexpr double damping = 0.001;   // N s/m

/// The reference kernel's step, by the pass that the program makes.
class MeshStep {
 public:
  MeshStep(const Scene& scene, const ClothSystem& system, int threads)
      : sweep_(system, common_mass(system)), state_(starting_state(system)), team_(threads) {
    sweep_.set_team(&team_, ThreadUse::always);
    loads_.weight = sweep_.mass() * scene.gravity.value();
    loads_.damping = damping;
  }

  void step() { steps(1); }
  void steps(int count) {
    std::vector<StepSums> sums(static_cast<std::size_t>(count));
    sweep_.euler(time_step, false, loads_, sums, state_);
  }
  void evaluate() {
    if (force_.size() != state_.position.size()) force_ = Vec3Field(state_.position.size());
    sweep_.evaluate(loads_, state_.position, force_);
  }
  const Vec3Field& position() const { return state_.position; }
  const MeshLayout& layout() const { return sweep_.layout(); }

 private:
  MeshSweep sweep_;
  ClothState state_;
  Vec3Field force_;
  WorkerTeam team_;
  SweepLoads loads_;
};

double least(const Subject& subject) {
  return spread_of(subject).least;
}

/// A subject for every call of `work`, which makes `steps` steps.
template <class Work>
Subject subject(const std::string& name, const ClothSystem& system, Work work, int steps = 1) {
  const double scale = 1e9 / static_cast<double>(system.size()) / steps;
  return {name, scale, [work](int times) {
            for (int k = 0; k < times; ++k) work();
            return true;
          }};
}

void print(const std::vector<Subject>& subjects) {
  fmt::print("  {:<48} {:>7} {:>7}  {}\n", "", "ns", "least", "reference / this, medians and least");
  for (const Subject& s : subjects)
    fmt::print("  {:<48} {:>7.1f} {:>7.1f}  as given {:.2f} {:.2f}, in this order {:.2f} {:.2f}\n", s.name,
               spread_of(s).median, least(s), ratio_of(subjects[1], s).median, least(subjects[1]) / least(s),
               ratio_of(subjects[0], s).median, least(subjects[0]) / least(s));
}

void measure(const std::string& name, const Scene& scene, const ClothSystem& given, int repeats) {
  const ClothSystem ordered = test::renumbered(given, order_for_sweeps(given));
  ReferenceKernel as_given(scene, given, starting_state(given)),
      reference(scene, ordered, starting_state(ordered));
  MeshStep one(scene, ordered, 1), two(scene, ordered, 2), mesh_as_given(scene, given, 1);

  constexpr int steps = 200, at_once = 32;
  for (int k = 0; k < steps; ++k) reference.step(time_step), one.step(), two.step();
  const double distance = reference.distance_to(one.position());
  const bool same = one.position() == two.position();

  std::vector<Subject> subjects{
      subject("reference kernel, particles in this order", given, [&] { reference.step(time_step); }),
      subject("reference kernel, particles as given", given, [&] { as_given.step(time_step); }),
      subject("forces alone", given, [&] { one.evaluate(); }),
      subject("step", given, [&] { one.step(); }),
      subject("step, two threads", given, [&] { two.step(); }),
      subject("step, particles as given", given, [&] { mesh_as_given.step(); }),
      subject(
          "32 steps at once, particles as given", given, [&] { mesh_as_given.steps(at_once); }, at_once)};
  subjects[4].threads = 2;
  time_interleaved(subjects, {.repeats = repeats, .moment = 0.002},
                   [](double, const std::string&) { return true; });

  const MeshLayout& layout = one.layout();
  fmt::print(
      "\n{}: {} particles, {} springs, {:.1f} % of the lanes empty, bandwidth {} (as given {}), {} from "
      "tables\n",
      name, given.size(), ordered.springs.size(),
      100 - 200 * static_cast<double>(ordered.springs.size()) /
                static_cast<double>(layout.neighbour.size() * kernels::slice_width),
      bandwidth_of(ordered), bandwidth_of(given),
      layout.kind.empty()      ? "nothing"
      : layout.tension.empty() ? "stiffness and tension"
                               : "stiffness");
  fmt::print("after {} steps {:.1e} m from the reference; two threads: {}\n", steps, distance,
             same ? "the same bits" : "OTHER BITS");
  print(subjects);
}

}  // namespace

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::max(4, std::atoi(argv[1])) : 128;
  const int repeats = argc > 2 ? std::max(3, std::atoi(argv[2])) : 21;
  test::Random random;
  Scene scene = hanging_cloth(side, "semi-implicit-euler", bare_feature());
  scene.damping = damping;
  fmt::print("ns per particle and step, medians of {} interleaved repeats; instruction set {}\n", repeats,
             name_of(active_instruction_set()));
  const ClothSystem grid = make_grid(scene.cloth, scene.springs.value());
  measure("shuffled grid", scene, test::renumbered(grid, test::random_order(grid.size(), random)), repeats);
  measure("irregular triangulation", scene, test::irregular_triangulation(side, side, 100, true, random),
          repeats);
  return 0;
}
