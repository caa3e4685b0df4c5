#include "kernels/mesh_sweep.h"

#include <algorithm>
#include <cassert>

#include "cloth/sums.h"
#include "kernels/instruction_set.h"
#include "kernels/kutta.h"

namespace cloth {
namespace {

using kernels::block_width;
using kernels::FieldPointers;
using kernels::MeshPass;

constexpr int after = 4, dampers = 5, all_sums = 9;  // among the sums; the stages' squares come first

FieldPointers pointers(Vec3Field& field) {
  return {field.x(), field.y(), field.z()};
}

}  // namespace

MeshSweep::MeshSweep(const ClothSystem& system, std::optional<double> mass)
    : SpringSweep(mass),
      layout_(make_mesh_layout(system)),
      kernels_(&active_kernels<kernels::MeshKernels>()),
      inverse_mass_(system.inverse_mass),
      vectors_((static_cast<std::size_t>(kernels::padding_index(layout_.slices)) + 1) * 4),
      squares_(static_cast<std::size_t>(layout_.blocks) * all_sums) {
  std::copy(std::begin(kernels::nowhere), std::end(kernels::nowhere), vectors_.end() - 4);
  number_ = inverse_of(layout_.order);
  for (std::size_t k = 0; k < layout_.order.size(); ++k)
    inverse_mass_[k] = system.inverse_mass[static_cast<std::size_t>(layout_.order[k])];
}

int MeshSweep::threads() const {
  return std::clamp(layout_.particles / fewest_particles, 1, team_size());
}

/// visit(begin, end) for the shares of `of` blocks, each on a thread.
template <class Visit>
void MeshSweep::for_each_share(int of, Visit visit) {
  if (sharing_ == 1) return visit(0, of);
  const auto begin = [&](int share) { return static_cast<int>(static_cast<long>(of) * share / sharing_); };
  team()->run(sharing_, [&](int share) { visit(begin(share), begin(share + 1)); });
}

/// The field itself, or a copy in the layout's order.
Vec3Field& MeshSweep::take(Vec3Field& field, Vec3Field& copy) {
  if (layout_.order.empty()) return field;
  if (copy.size() != field.size()) copy = Vec3Field(field.size());
  for_each_share(layout_.particles, [&](int begin, int end) {
    const int* order = layout_.order.data();
    const double *x = field.x(), *y = field.y(), *z = field.z();
    double *to_x = copy.x(), *to_y = copy.y(), *to_z = copy.z();
    for (int k = begin; k < end; ++k) to_x[k] = x[order[k]], to_y[k] = y[order[k]], to_z[k] = z[order[k]];
  });
  return copy;
}

void MeshSweep::give_back(const Vec3Field& copy, Vec3Field& field) {
  if (layout_.order.empty()) return;
  for_each_share(layout_.particles, [&](int begin, int end) {
    const int* number = number_.data();
    const double *x = copy.x(), *y = copy.y(), *z = copy.z();
    double *to_x = field.x(), *to_y = field.y(), *to_z = field.z();
    for (int i = begin; i < end; ++i) to_x[i] = x[number[i]], to_y[i] = y[number[i]], to_z[i] = z[number[i]];
  });
}

MeshPass MeshSweep::pass_with(const SweepLoads& loads, double step) {
  MeshPass pass;
  pass.slots = layout_.slots();
  pass.particles = layout_.particles;
  pass.vectors = vectors_.data();
  pass.inverse_mass = inverse_mass_.data();
  if (loads.load) pass.load = read(*loads.load, inner_.load);
  for (int axis = 0; axis < 3; ++axis) pass.weight[axis] = loads.weight[axis];
  pass.damping = loads.damping;
  pass.spring_damping = loads.spring_damping;
  if (loads.spring_damping > 0) {
    velocities_.resize(vectors_.size());  // the padding particle is at rest
    pass.velocities = velocities_.data();
  }
  pass.dampers = squares_.data() + dampers * layout_.blocks;
  pass.mass_of_free = has_common_mass() ? mass() : 1;
  pass.step = step;
  pass.squares[0] = squares_.data();
  pass.squares[1] = squares_.data() + layout_.blocks;
  return pass;
}

void MeshSweep::load_all(const MeshPass& pass) {
  for_each_share(layout_.blocks, [&](int begin, int end) {
    kernels_->load(pass, begin * block_width,
                   std::min(end * block_width, layout_.slices * kernels::slice_width));
  });
}

/// One thread loads just ahead of what it needs, several load all beforehand.
void MeshSweep::run(MeshPass& pass, Kernel kernel) {
  if (sharing_ == 1) {
    pass.load_until = layout_.load_until.data();
  } else {
    load_all(pass);
  }
  run_loaded(pass, kernel);
}

void MeshSweep::run_loaded(const MeshPass& pass, Kernel kernel) {
  for_each_share(layout_.blocks, [&](int begin, int end) {
    MeshPass share = pass;
    share.begin = begin, share.end = end;
    kernel(share);
  });
}

double MeshSweep::sum_of(int which) const {
  const auto blocks = static_cast<std::size_t>(layout_.blocks);
  return ordered_sum(blocks, [p = squares_.data() + static_cast<std::size_t>(which) * blocks](std::size_t k) {
    return p[k];
  });
}

/// steps(pass, first, count) takes steps of the state for the sums [first, first + count).
template <class Steps>
void MeshSweep::step_state(std::size_t all, double step, const SweepLoads& loads, ClothState& state,
                           const Steps& steps) {
  in_jobs(kind_of(all), all, [&](std::size_t first, std::size_t count, int threads) {
    sharing_ = threads;
    Vec3Field &position = take(state.position, inner_.position),
              &velocity = take(state.velocity, inner_.velocity);
    MeshPass pass = pass_with(loads, step);
    pass.position = pointers(position), pass.velocity = pointers(velocity);
    steps(pass, first, count);
    give_back(position, state.position);
    give_back(velocity, state.velocity);
  });
}

void MeshSweep::euler(double step, bool drift_first, const SweepLoads& loads, std::span<StepSums> sums,
                      ClothState& state) {
  assert(has_common_mass() && (!loads.load || sums.size() == 1));
  step_state(sums.size(), step, loads, state, [&](MeshPass& pass, std::size_t first, std::size_t count) {
    pass.drift_first = drift_first;
    for (StepSums& of_step : sums.subspan(first, count)) {
      run(pass, kernels_->euler);
      of_step = {sum_of(0), sum_of(1)};
      if (loads.spring_damping > 0) of_step.dampers = sum_of(dampers);
    }
  });
}

double MeshSweep::verlet(double step, const SweepLoads& loads, Vec3Field& force, ClothState& state) {
  double squares = 0;
  verlet_steps(step, loads, {&squares, 1}, force, state);
  return squares;
}

/// The first step kicks and drifts while it loads, the others at the end of the step before.
void MeshSweep::verlet_steps(double step, const SweepLoads& loads, std::span<double> squares,
                             Vec3Field& force, ClothState& state) {
  assert(has_common_mass() && !loads.load && loads.spring_damping == 0);
  step_state(squares.size(), step, loads, state, [&](MeshPass& pass, std::size_t first, std::size_t count) {
    Vec3Field& p = take(force, inner_.force);
    pass.force = pointers(p);
    for (std::size_t k = 0; k < count; ++k) {
      pass.kicks = k == 0;
      run(pass, k + 1 < count ? kernels_->verlet_between : kernels_->verlet);
      squares[first + k] = sum_of(1);
    }
    give_back(p, force);
  });
}

void MeshSweep::runge_kutta(double step, const SweepLoads& loads, std::span<StageSums> sums,
                            ClothState& state) {
  assert(has_common_mass() && !loads.load);
  for (Vec3Field* field : {&stage_.position, &stage_.velocity, &sum_.position, &sum_.velocity})
    if (field->size() != state.position.size()) *field = Vec3Field(state.position.size());
  step_state(sums.size(), step, loads, state, [&](MeshPass& pass, std::size_t first, std::size_t count) {
    const FieldPointers position = pass.position, velocity = pass.velocity;
    for (StageSums& of_step : sums.subspan(first, count)) {
      runge_kutta_step(pass, step, position, velocity);
      for (int stage = 0; stage < 4; ++stage) {
        const auto s = static_cast<std::size_t>(stage);
        of_step.squares[s] = sum_of(stage);
        of_step.dampers[s] = loads.spring_damping > 0 ? sum_of(dampers + stage) : 0;
      }
      of_step.after = sum_of(after);
    }
  });
}

void MeshSweep::runge_kutta_step(MeshPass& pass, double step, const FieldPointers& x,
                                 const FieldPointers& v) {
  const FieldPointers sum_x = pointers(sum_.position), sum_v = pointers(sum_.velocity),
                      next_x = pointers(stage_.position), next_v = pointers(stage_.velocity);
  for (int s = 0; s < kutta_stages; ++s) {
    const bool first = s == 0, last = s + 1 == kutta_stages;
    pass.position = first ? x : next_x, pass.velocity = first ? v : next_v;
    pass.stage = {.weight = step * kutta[s].weight,
                  .ahead = last ? 0 : step * kutta[s + 1].node,
                  .is_last = last,
                  .sum_position = first ? x : sum_x,
                  .sum_velocity = first ? v : sum_v,
                  .next_sum_position = last ? x : sum_x,
                  .next_sum_velocity = last ? v : sum_v,
                  .state_position = x,
                  .state_velocity = v,
                  .next_position = next_x,
                  .next_velocity = next_v};
    pass.squares[0] = squares_.data() + s * layout_.blocks;
    pass.squares[1] = squares_.data() + after * layout_.blocks;
    pass.dampers = squares_.data() + (dampers + s) * layout_.blocks;
    run(pass, kernels_->runge_kutta);
  }
}

/// One pass that writes to `result`, in whatever order the layout has. `inputs(pass)` sets what the pass
/// reads.
template <class Inputs>
void MeshSweep::compute(PassKind kind, Kernel kernel, const SweepLoads& loads, Vec3Field& result,
                        const Inputs& inputs) {
  in_jobs(kind, 1, [&](std::size_t, std::size_t, int threads) {
    sharing_ = threads;
    MeshPass pass = pass_with(loads, 0);
    inputs(pass);
    const bool in_place = layout_.order.empty();
    if (!in_place && inner_.force.size() != result.size()) inner_.force = Vec3Field(result.size());
    Vec3Field& inner = in_place ? result : inner_.force;
    pass.force = pointers(inner);
    run(pass, kernel);
    give_back(inner, result);
  });
}

/// A field that a pass only reads.
FieldPointers MeshSweep::read(const Vec3Field& field, Vec3Field& copy) {
  return pointers(take(const_cast<Vec3Field&>(field), copy));
}

void MeshSweep::evaluate(const SweepLoads& loads, const Vec3Field& position, Vec3Field& force) {
  compute(PassKind::evaluation, kernels_->evaluate, loads, force,
          [&](MeshPass& pass) { pass.position = read(position, inner_.position); });
}

double MeshSweep::damp(const SweepLoads& loads, const Vec3Field& position, const Vec3Field& velocity,
                       Vec3Field& product) {
  compute(PassKind::dampers, kernels_->damp, loads, product, [&](MeshPass& pass) {
    pass.position = read(position, inner_.position);
    pass.velocity = read(velocity, inner_.velocity);
  });
  return sum_of(dampers);
}

double MeshSweep::squares(const Vec3Field& velocity) {
  in_jobs(PassKind::sums, 1, [&](std::size_t, std::size_t, int threads) {
    sharing_ = threads;
    MeshPass pass = pass_with({}, 0);
    pass.velocity = read(velocity, inner_.velocity);
    run_loaded(pass, kernels_->sum_squares);
  });
  return sum_of(1);
}

}  // namespace cloth
