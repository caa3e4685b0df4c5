// clothlab-mesh-bench: what a step costs on meshes whose springs have no constant offset, beside the
// reference kernel (structs of particles, index pairs, scalar) timed in the same run. Prints figures; judges
// nothing.
//
//     clothlab-mesh-bench [PARTICLES PER SIDE] [REPEATS]
//
// The step is the reference kernel's: semi-implicit Euler with gravity and viscous damping, no ledger.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "cloth/grid.h"
#include "cloth/mesh_order.h"
#include "kernels/mesh_springs.h"
#include "study/speed/interleaved_timing.h"
#include "study/speed/reference_kernel.h"
#include "study/speed/speed_scenes.h"
#include "support/meshes.h"

namespace {

using namespace cloth;
using namespace cloth::speed;

constexpr double time_step = 1e-5;  // s
constexpr double damping = 0.001;   // N s/m

/// Threads that wait in a loop for their next part, so that a part may be short.
class Team {
 public:
  explicit Team(int threads) {
    for (int k = 1; k < threads; ++k) threads_.emplace_back([this, k] { work(k); });
  }
  ~Team() {
    part_ = nullptr;
    ++round_;
    for (std::thread& thread : threads_) thread.join();
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  void run(const std::function<void(int)>& part) {
    part_ = &part;
    done_ = 0;
    ++round_;
    part(0);
    for (int k = 0; done_ < static_cast<int>(threads_.size()); ++k) wait(k);
  }

 private:
  static void wait(int looked) {
    constexpr int patience = 1000;
    if (looked > patience) std::this_thread::yield();
  }
  void work(int number) {
    for (int seen = 0;; ++seen) {
      for (int k = 0; round_ == seen; ++k) wait(k);
      if (!part_) return;
      (*part_)(number);
      ++done_;
    }
  }

  const std::function<void(int)>* part_ = nullptr;
  std::atomic<int> round_ = 0, done_ = 0;
  std::vector<std::thread> threads_;
};

/// The reference kernel's step around the kernel for meshes.
class MeshStep {
 public:
  MeshStep(const Scene& scene, const ClothSystem& system, int threads)
      : system_(system),
        springs_(system),
        state_(starting_state(system)),
        force_(state_.position.size()),
        threads_(threads),
        team_(threads) {
    for (int axis = 0; axis < 3; ++axis) weight_[axis] = system.mass.front() * scene.gravity.value()[axis];
  }

  void step() {
    each_part([this](int begin, int end) { resist(begin, end); });
    if (threads_ == 1) {
      springs_.add_forces(state_.position, force_);
    } else {
      springs_.add_forces(state_.position, force_, threads_, run_);
    }
    each_part([this](int begin, int end) { move(begin, end); });
  }

  const Vec3Field& position() const { return state_.position; }
  MeshSprings& springs() { return springs_; }
  Vec3Field& force() { return force_; }

 private:
  template <class Visit>  // visit(begin, end)
  void each_part(Visit visit) {
    const int size = system_.size();
    if (threads_ == 1) return visit(0, size);
    team_.run([&](int part) {
      visit(size / threads_ * part, part + 1 < threads_ ? size / threads_ * (part + 1) : size);
    });
  }
  void resist(int begin, int end) {
    const double* velocity[] = {state_.velocity.x(), state_.velocity.y(), state_.velocity.z()};
    double* force[] = {force_.x(), force_.y(), force_.z()};
    for (int axis = 0; axis < 3; ++axis)
      for (int i = begin; i < end; ++i) force[axis][i] = weight_[axis] - damping * velocity[axis][i];
  }
  void move(int begin, int end) {
    double* position[] = {state_.position.x(), state_.position.y(), state_.position.z()};
    double* velocity[] = {state_.velocity.x(), state_.velocity.y(), state_.velocity.z()};
    const double* force[] = {force_.x(), force_.y(), force_.z()};
    const double* inverse_mass = system_.inverse_mass.data();
    for (int axis = 0; axis < 3; ++axis)
      for (int i = begin; i < end; ++i) {
        velocity[axis][i] += time_step * inverse_mass[i] * force[axis][i];
        position[axis][i] += time_step * velocity[axis][i];
      }
  }

  const ClothSystem& system_;
  MeshSprings springs_;
  ClothState state_;
  Vec3Field force_;
  double weight_[3] = {};
  int threads_;
  Team team_;
  RunParts run_ = [this](int, const std::function<void(int)>& part) { team_.run(part); };
};

double least(const Subject& subject) {
  return spread_of(subject).least;
}

void measure(const std::string& name, const Scene& scene, const ClothSystem& given, int repeats) {
  const ClothSystem ordered = renumbered(given, small_bandwidth_order(given));
  ReferenceKernel as_given(scene, given, starting_state(given)),
      reference(scene, ordered, starting_state(ordered));
  MeshStep one(scene, ordered, 1), two(scene, ordered, 2);

  constexpr int steps = 200;
  for (int k = 0; k < steps; ++k) reference.step(time_step), one.step(), two.step();
  const double distance = reference.distance_to(one.position());
  const bool same = one.position() == two.position();

  const double scale = 1e9 / static_cast<double>(given.size());
  const auto repeat = [](auto& subject) {
    return [&subject](int times) {
      for (int k = 0; k < times; ++k) subject.step();
      return true;
    };
  };
  const auto repeat_reference = [](ReferenceKernel& kernel) {
    return [&kernel](int times) {
      for (int k = 0; k < times; ++k) kernel.step(time_step);
      return true;
    };
  };
  std::vector<Subject> subjects{
      {"reference kernel, particles in this order", scale, repeat_reference(reference)},
      {"reference kernel, particles as given", scale, repeat_reference(as_given)},
      {"mesh kernel, springs alone", scale,
       [&](int times) {
         for (int k = 0; k < times; ++k) one.springs().add_forces(one.position(), one.force());
         return true;
       }},
      {"mesh kernel, step", scale, repeat(one)},
      {"mesh kernel, step, two threads", scale, repeat(two)}};
  subjects.back().threads = 2;
  time_interleaved(subjects, {.repeats = repeats, .moment = 0.002}, [](double, const std::string&) { return true; });

  const MeshLayout& layout = one.springs().layout();
  fmt::print(
      "\n{}: {} particles, {} springs, {:.1f} % of the lanes empty, bandwidth {} (as given {}), {} colours\n",
      name, given.size(), ordered.springs.size(),
      100 - 100 * static_cast<double>(ordered.springs.size()) /
                static_cast<double>(layout.neighbour.size() * slice_width),
      bandwidth_of(ordered), bandwidth_of(given), layout.colours.size());
  fmt::print("after {} steps {:.1e} m from the reference; two threads: {}\n", steps, distance,
             same ? "the same bits" : "OTHER BITS");
  fmt::print("  {:<44} {:>7} {:>7}  {}\n", "", "ns", "least", "reference / this, medians and least");
  for (const Subject& s : subjects)
    fmt::print("  {:<44} {:>7.1f} {:>7.1f}  as given {:.2f} {:.2f}, in this order {:.2f} {:.2f}\n", s.name,
               spread_of(s).median, least(s), ratio_of(subjects[1], s).median,
               least(subjects[1]) / least(s), ratio_of(subjects[0], s).median, least(subjects[0]) / least(s));
}

}  // namespace

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::max(4, std::atoi(argv[1])) : 128;
  const int repeats = argc > 2 ? std::max(3, std::atoi(argv[2])) : 21;
  test::Random random;
  Scene scene = hanging_cloth(side, "semi-implicit-euler", bare_feature());
  scene.damping = damping;
  fmt::print("ns per particle and step, medians of {} interleaved repeats; instruction set {}\n", repeats,
             chosen_mesh_kernel().name);
  const ClothSystem grid = make_grid(scene.cloth, scene.springs.value());
  measure("shuffled grid", scene, renumbered(grid, test::random_order(grid.size(), random)), repeats);
  measure("irregular triangulation", scene, test::irregular_triangulation(side, side, 100, true, random),
          repeats);
  return 0;
}
