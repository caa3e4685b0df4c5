// The passes of the explicit methods over the particles of a general mesh. Included once for every
// instruction set, after its Lanes; everything here has internal linkage.
//
// A particle's force is summed in registers over all its springs. Each spring is therefore computed twice,
// once for each end: this is faster than adding the force to the other end in memory, and the order of the
// sum does not depend on the number of threads.
#pragma once

#include "kernels/mesh_pass.h"
#include "kernels/step_updates.h"

namespace cloth::kernels {
namespace {

/// Access to stiffness and tension, for the three ways in which MeshSlots stores them: at() calls
/// scale(k, kL) with the lanes from index `place` on.
struct SpringsOfKinds {
  Lanes::Table stiffness, tension;
  const unsigned char* kind;
  template <class Scale>
  CLOTHLAB_INLINE V at(int place, const Scale& scale) const {
    const Lanes::Kinds kinds = Lanes::kinds(kind + place);
    return scale(Lanes::pick(stiffness, kinds), Lanes::pick(tension, kinds));
  }
};
struct StiffnessOfKinds {
  Lanes::Table stiffness;
  const double* tension;
  const unsigned char* kind;
  template <class Scale>
  CLOTHLAB_INLINE V at(int place, const Scale& scale) const {
    return scale(Lanes::pick(stiffness, Lanes::kinds(kind + place)), Lanes::load(tension + place));
  }
};
struct SpringsInFull {
  const double *stiffness, *tension;
  template <class Scale>
  CLOTHLAB_INLINE V at(int place, const Scale& scale) const {
    return scale(Lanes::load(stiffness + place), Lanes::load(tension + place));
  }
};

template <class Visit>  // visit(springs)
inline void with_springs(const MeshSlots& slots, const Visit& visit) {
  if (slots.stiffness)
    visit(SpringsInFull{slots.stiffness, slots.tension});
  else if (slots.tension)
    visit(StiffnessOfKinds{Lanes::table(slots.stiffness_of_kind), slots.tension, slots.kind});
  else
    visit(SpringsOfKinds{Lanes::table(slots.stiffness_of_kind), Lanes::table(slots.tension_of_kind),
                         slots.kind});
}

inline Row row_of(const FieldPointers& field) {
  return {field.x, field.y, field.z};
}

template <bool Edge>
CLOTHLAB_INLINE void load_block(const MeshPass& pass, int j, int count) {
  if (pass.kicks)
    kick_drift_block<Edge>(row_of(pass.position), row_of(pass.velocity), row_of(pass.force),
                           pass.inverse_mass, Lanes::set(0.5 * pass.step), Lanes::set(pass.step),
                           Lanes::set(pass.damping), j, count);
  const Vector x = load_part<Edge>(row_of(pass.position), j, count);
  Lanes::put(pass.vectors + 4 * j, x.x, x.y, x.z);
  if (!(pass.spring_damping > 0)) return;
  const Vector v = load_part<Edge>(row_of(pass.velocity), j, count);
  Lanes::put(pass.velocities + 4 * j, v.x, v.y, v.z);
}

void load_vectors(const MeshPass& pass, int begin, int end) {
  int j = begin;
  for (; j + Lanes::width <= end && j + Lanes::width <= pass.particles; j += Lanes::width)
    load_block<false>(pass, j, Lanes::width);
  for (; j < end; j += Lanes::width) load_block<true>(pass, j, pass.particles - j);
}

/// Adds to `force` the springs' forces on the particles of a slice from its lane `part` on.
template <class Springs, class Scale>
CLOTHLAB_INLINE Vector plus_springs(Vector force, const MeshPass& pass, const Springs& springs,
                                    const Vector& here, int slice, int part, const Scale& scale) {
  const int end = pass.slots.slot_begin[slice + 1] * slice_width + part;
  for (int at = pass.slots.slot_begin[slice] * slice_width + part; at < end; at += slice_width) {
    Vector other;
    Lanes::gather(pass.vectors, pass.slots.neighbour + at, other.x, other.y, other.z);
    const Vector d = other - here;
    const V s = Lanes::fma(d.z, d.z, Lanes::fma(d.y, d.y, Lanes::mul(d.x, d.x)));
    force = plus(force, springs.at(at, [&](V k, V kL) { return scale(s, k, kL); }), d);
  }
  return force;
}

/// The same with exact_scale, for springs of length 0 or whose squared length is not finite.
template <class Springs>
[[gnu::noinline]] Vector plus_springs_exactly(const Vector& force, const MeshPass& pass,
                                              const Springs& springs, const Vector& here, int slice,
                                              int part) {
  return plus_springs(force, pass, springs, here, slice, part,
                      [](V s, V k, V kL) { return Lanes::exact_scale(s, k, kL); });
}

template <bool Edge, class Springs>
CLOTHLAB_INLINE Vector mesh_force(const MeshPass& pass, const Springs& springs, const Vector& here, int slice,
                                  int part, int count) {
  const Vector other =
      initial<Edge>(row_of(pass.load), vector_of(pass.weight), slice * slice_width + part, count);
  const Vector force = plus_springs(other, pass, springs, here, slice, part,
                                    [](V s, V k, V kL) { return Lanes::scale(s, k, kL); });
  if (Lanes::is_in_doubt(Lanes::add(force.x, Lanes::add(force.y, force.z)))) [[unlikely]]
    return plus_springs_exactly(other, pass, springs, here, slice, part);
  return force;
}

/// The same with dampers along the springs, or these alone. Adds half of the power that each damper
/// dissipates, in W, to `loss`, because every spring is computed at both its ends.
template <Law law, bool Edge, class Springs>
CLOTHLAB_INLINE Vector damped_force(const MeshPass& pass, const Springs& springs, const Particles& here,
                                    int slice, int part, int count, V& loss) {
  const V damping = Lanes::set(pass.spring_damping), zero = Lanes::zero();
  Vector force{zero, zero, zero};
  if constexpr (law == Law::damped)
    force = initial<Edge>(row_of(pass.load), vector_of(pass.weight), slice * slice_width + part, count);
  V both = zero;
  const int end = pass.slots.slot_begin[slice + 1] * slice_width + part;
  for (int at = pass.slots.slot_begin[slice] * slice_width + part; at < end; at += slice_width) {
    Particles other;
    const int* neighbour = pass.slots.neighbour + at;
    Lanes::gather(pass.vectors, neighbour, other.position.x, other.position.y, other.position.z);
    Lanes::gather(pass.velocities, neighbour, other.velocity.x, other.velocity.y, other.velocity.z);
    const Vector d = other.position - here.position;
    const V inverse = Lanes::inverse_root<true>(squared(d));
    const V scale = springs.at(at, [&](V k, V kL) {
      const V damper = damper_scale(here, other, d, inverse, Lanes::where_positive(k, damping), both);
      return law == Law::damper ? damper : Lanes::add(Lanes::fnma(kL, inverse, k), damper);
    });
    force = plus(force, scale, d);
  }
  loss = Lanes::fma(Lanes::set(0.5), both, loss);
  return force;
}

/// For each block: before(), then force and `update` for each slice, then after(block, power dissipated by
/// dampers in W).
template <Law law, class Update, class Before, class After>
void mesh_pass(const MeshPass& pass, Update& update, const Before& before, const After& after) {
  with_springs(pass.slots, [&](const auto& springs) {
    int loaded = pass.begin * block_width;
    const ConstRow position = row_of(pass.position), velocity = row_of(pass.velocity);
    V loss = Lanes::zero();
    const auto at = [&]<bool Edge>(int slice, int part, int j, int count) {
      const Vector here = load_part<Edge>(position, j, count);
      Vector force;
      if constexpr (law == Law::elastic)
        force = mesh_force<Edge>(pass, springs, here, slice, part, count);
      else
        force = damped_force<law, Edge>(pass, springs, {here, load_part<Edge>(velocity, j, count)}, slice,
                                        part, count, loss);
      update.template operator()<Edge>(j, count, here, force);
    };
    for (int block = pass.begin; block < pass.end; ++block) {
      if (pass.load_until && loaded < pass.load_until[block]) {
        load_vectors(pass, loaded, pass.load_until[block]);
        loaded = pass.load_until[block];
      }
      before();
      loss = Lanes::zero();
      for (int slice = block * block_slices; slice < (block + 1) * block_slices; ++slice)
        for (int part = 0; part < slice_width; part += Lanes::width) {
          const int j = slice * slice_width + part, count = pass.particles - j;
          if (count <= 0) break;
          if (count >= Lanes::width)
            at.template operator()<false>(slice, part, j, Lanes::width);
          else
            at.template operator()<true>(slice, part, j, count);
        }
      after(block, loss);
    }
  });
}

template <Law law>
void mesh_euler_of(const MeshPass& pass) {
  EulerUpdate<Share::equal> update{};
  update.step = Lanes::set(pass.step), update.damping = Lanes::set(pass.damping);
  update.drift_first = pass.drift_first;
  update.position = row_of(pass.position), update.velocity = row_of(pass.velocity);
  update.inverse_mass = pass.inverse_mass;
  mesh_pass<law>(
      pass, update, [&] { update.before = update.after = Lanes::zero(); },
      [&](int block, V loss) {
        pass.squares[0][block] = Lanes::sum(update.before);
        pass.squares[1][block] = Lanes::sum(update.after);
        if constexpr (law == Law::damped) pass.dampers[block] = Lanes::sum(loss);
      });
}
void mesh_euler(const MeshPass& pass) {
  pass.spring_damping > 0 ? mesh_euler_of<Law::damped>(pass) : mesh_euler_of<Law::elastic>(pass);
}

void mesh_verlet(const MeshPass& pass) {
  VerletUpdate<Share::equal> update{};
  update.half_step = Lanes::set(0.5 * pass.step);
  update.centred = Lanes::set(centring(pass.step, pass.damping, pass.mass_of_free));
  update.velocity = row_of(pass.velocity), update.force = row_of(pass.force);
  update.inverse_mass = pass.inverse_mass;
  mesh_pass<Law::elastic>(
      pass, update, [&] { update.after = Lanes::zero(); },
      [&](int block, V) { pass.squares[1][block] = Lanes::sum(update.after); });
}

void mesh_verlet_between(const MeshPass& pass) {
  VerletBetweenUpdate<Share::equal> update{};
  update.half_step = Lanes::set(0.5 * pass.step), update.step = Lanes::set(pass.step);
  update.centred = Lanes::set(centring(pass.step, pass.damping, pass.mass_of_free));
  update.damping = Lanes::set(pass.damping);
  update.position = row_of(pass.position), update.velocity = row_of(pass.velocity);
  update.inverse_mass = pass.inverse_mass;
  mesh_pass<Law::elastic>(
      pass, update, [&] { update.after = Lanes::zero(); },
      [&](int block, V) { pass.squares[1][block] = Lanes::sum(update.after); });
}

template <Law law>
void mesh_runge_kutta_of(const MeshPass& pass) {
  const MeshStage& stage = pass.stage;
  StageUpdate<Share::equal> update{};
  update.weight = Lanes::set(stage.weight), update.ahead = Lanes::set(stage.ahead);
  update.damping = Lanes::set(pass.damping);
  update.is_last = stage.is_last;
  update.stage_velocity = row_of(pass.velocity);
  update.inverse_mass = pass.inverse_mass;
  update.sum_position = row_of(stage.sum_position), update.sum_velocity = row_of(stage.sum_velocity);
  update.next_sum_position = row_of(stage.next_sum_position);
  update.next_sum_velocity = row_of(stage.next_sum_velocity);
  update.state_position = row_of(stage.state_position), update.state_velocity = row_of(stage.state_velocity);
  update.next_position = row_of(stage.next_position), update.next_velocity = row_of(stage.next_velocity);
  mesh_pass<law>(
      pass, update, [&] { update.squares = update.after = Lanes::zero(); },
      [&](int block, V loss) {
        pass.squares[0][block] = Lanes::sum(update.squares);
        pass.squares[1][block] = Lanes::sum(update.after);
        if constexpr (law == Law::damped) pass.dampers[block] = Lanes::sum(loss);
      });
}
void mesh_runge_kutta(const MeshPass& pass) {
  pass.spring_damping > 0 ? mesh_runge_kutta_of<Law::damped>(pass) : mesh_runge_kutta_of<Law::elastic>(pass);
}

void mesh_evaluate(const MeshPass& pass) {
  EvaluateUpdate update{row_of(pass.force)};
  mesh_pass<Law::elastic>(
      pass, update, [] {}, [](int, V) {});
}

void mesh_damp(const MeshPass& pass) {
  DampUpdate update{row_of(pass.force)};
  mesh_pass<Law::damper>(
      pass, update, [] {}, [&](int block, V loss) { pass.dampers[block] = Lanes::sum(loss); });
}

void mesh_sum_squares(const MeshPass& pass) {
  const ConstRow velocity = row_of(pass.velocity);
  for (int block = pass.begin; block < pass.end; ++block) {
    V sum = Lanes::zero();
    int j = block * block_width;
    const int end = j + block_width < pass.particles ? j + block_width : pass.particles;
    for (; j + Lanes::width <= end; j += Lanes::width)
      sum = plus_square(sum, load_part<false>(velocity, j, Lanes::width));
    if (j < end) sum = plus_square(sum, load_part<true>(velocity, j, end - j));
    pass.squares[1][block] = Lanes::sum(sum);
  }
}

constexpr MeshKernels mesh_kernels{load_vectors,     mesh_euler,    mesh_verlet, mesh_verlet_between,
                                   mesh_runge_kutta, mesh_evaluate, mesh_damp,   mesh_sum_squares};

}  // namespace
}  // namespace cloth::kernels
