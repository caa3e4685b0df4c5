#include "contact/touch_kernels.h"

#include "kernels/three.h"

namespace cloth {
namespace {

constexpr int size = TouchBlock::size;

/// Minimum and maximum without a function of the standard library, and without a branch.
CLOTHLAB_INLINE double least(double a, double b) {
  return a < b ? a : b;
}
CLOTHLAB_INLINE double most(double a, double b) {
  return a > b ? a : b;
}
CLOTHLAB_INLINE double clamp(double a, double low, double high) {
  return least(most(a, low), high);
}

using Vector = kernels::Three<double>;

CLOTHLAB_INLINE Vector choose(bool first, const Vector& a, const Vector& b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}
CLOTHLAB_INLINE Vector get(const TouchBlock::Vectors& from, int k) {
  return {from[0][k], from[1][k], from[2][k]};
}
CLOTHLAB_INLINE void set(TouchBlock::Vectors& to, int k, const Vector& v) {
  to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z;
}

CLOTHLAB_INLINE Vector vector_of(const double (&of)[3]) {
  return {of[0], of[1], of[2]};
}

/// The nearest point of the surface; whether the particle is inside.
struct NearestPoint {
  Vector point, normal;
  bool is_inside;
};

struct HalfSpace {
  Vector point, normal;

  CLOTHLAB_INLINE NearestPoint nearest_to(const Vector& at) const {
    const double height = dot(normal, at - point);
    return {at - height * normal, normal, height < 0};
  }
};

/// The centre itself is equally far from every point of the surface: up, as in penetration().
struct Ball {
  Vector center;
  double radius;

  CLOTHLAB_INLINE NearestPoint nearest_to(const Vector& at) const {
    const Vector out = at - center;
    const double squared = dot(out, out), distance = __builtin_sqrt(squared);
    const bool has_side = squared > 0;
    const double x = has_side ? out.x / distance : 0, y = has_side ? out.y / distance : 1,
                 z = has_side ? out.z / distance : 0;
    return {{center.x + radius * x, center.y + radius * y, center.z + radius * z},
            {x, y, z},
            squared < radius * radius};
  }
};

/// On the face of least depth, of equal ones the first.
struct Box {
  Vector center, half;

  CLOTHLAB_INLINE NearestPoint nearest_to(const Vector& at) const {
    const Vector in = at - center;
    const Vector side = {in.x < 0 ? -1.0 : 1.0, in.y < 0 ? -1.0 : 1.0, in.z < 0 ? -1.0 : 1.0};
    const Vector depth = {half.x - side.x * in.x, half.y - side.y * in.y, half.z - side.z * in.z};
    const double least_depth = least(depth.x, least(depth.y, depth.z));
    const bool by_x = depth.x == least_depth, by_y = !by_x & (depth.y == least_depth), by_z = !by_x & !by_y;
    const Vector face = {center.x + side.x * half.x, center.y + side.y * half.y, center.z + side.z * half.z};
    return {{by_x ? face.x : at.x, by_y ? face.y : at.y, by_z ? face.z : at.z},
            {by_x ? side.x : 0, by_y ? side.y : 0, by_z ? side.z : 0},
            least_depth > 0};
  }
};

template <class Solid>
int find_inside(const Solid solid, TouchBlock& block) {
  double number = 0;
  for (int k = 0; k < size; ++k) {
    const NearestPoint nearest = solid.nearest_to(get(block.position, k));
    const double touched = nearest.is_inside & (block.is_free[k] != 0) ? 1 : 0;
    block.touched[k] = touched, number += touched;
    set(block.point, k, nearest.point), set(block.normal, k, nearest.normal);
  }
  return static_cast<int>(number);
}

int find_touched(const TouchSolid& solid, TouchBlock& block) {
  const Vector center = vector_of(solid.center);
  switch (solid.kind) {
    case TouchSolid::Kind::half_space:
      return find_inside(HalfSpace{center, vector_of(solid.normal)}, block);
    case TouchSolid::Kind::ball:
      return find_inside(Ball{center, solid.radius}, block);
    case TouchSolid::Kind::box:
      return find_inside(Box{center, vector_of(solid.half)}, block);
  }
  return 0;
}

/// m/s, the approach speed to which restitution applies. A particle without contact in the last step: its
/// mean speed in this step. One with contact: its speed at the beginning of the step, because what the step
/// adds is load. 0 below twice what gravity or the load adds in a step, or a cloth at rest would keep
/// bouncing.
CLOTHLAB_INLINE double approach_of(const TouchLaw& law, const TouchBlock& block, int k,
                                   const Vector& normal) {
  const Vector began = get(block.start_velocity, k);
  const double mean = dot(normal, get(block.integrated_position, k) - get(block.start, k)) / law.step;
  const double load = dot(normal, began - get(block.integrated_velocity, k));
  const double approach = block.held[k] != 0 ? -dot(normal, began) : -mean;
  return approach > 2 * most(law.gravity_speed, load) ? approach : 0;
}

/// J, of the impulse that stops a particle. The part that changes its velocity acts instantaneously: its work
/// is taken with the mean of the velocities before and after. The rest balances a load that acted during the
/// whole step: its work is taken along the displacement, of mean velocity `gone`. The load of springs that
/// were solved for with contact, `normal_load`, acts while the particle touches, which does no work. (The
/// same for contacts of several particles: contact_work.h.)
CLOTHLAB_INLINE double stopping_work(double mass, double normal_load, const Vector& normal,
                                     const Vector& change, const Vector& before, const Vector& stopped,
                                     const Vector& gone) {
  const double inward = dot(change, normal), impulse = normal_load + most(0, mass * inward);
  const Vector rubbing = mass * (change - inward * normal);
  const Vector mean = 0.5 * (before + stopped), turn = stopped - before;
  const double along = dot(normal, turn), impact = clamp(along * mass, 0, impulse);
  const Vector turned = turn - along * normal;
  const double start = dot(normal, before), end = dot(normal, stopped);
  const Vector start_across = before - start * normal, end_across = stopped - end * normal;
  const bool slows = dot(end_across, end_across) < dot(start_across, start_across);
  const double square = dot(turned, turned);
  const double part = slows & (square > 0) ? clamp(dot(rubbing, turned) / square, 0, mass) : 0;
  const Vector stopping = part * turned;
  const double load = most(0, impulse - normal_load - impact);
  return impact * dot(normal, mean) + load * dot(normal, gone) + dot(stopping, mean) +
         dot(rubbing - stopping, gone);
}

/// The velocity after contact with this rebound, in m/s; `normal_load` in m/s too.
CLOTHLAB_INLINE Vector answer_of(const TouchLaw& law, const Vector& velocity, const Vector& normal,
                                 double inward, double rebound, double normal_load) {
  const Vector tangential = velocity - inward * normal;
  const double speed = __builtin_sqrt(dot(tangential, tangential));
  const double lost = law.friction * (rebound - inward + normal_load) / speed;
  const double kept = speed > 0 ? most(0, 1 - lost) : 0;
  return kept * tangential + rebound * normal;
}

/// J: the work with the rebound, of which the largest part s, at most 1, is left that returns no more energy
/// than contact has taken: square s^2 + linear s <= -work.
CLOTHLAB_INLINE double limit_rebound(double mass, double work, const Vector& stopped, Vector& answer) {
  constexpr double above_zero = 1e-300;  // without a rebound no part matters
  const Vector rebound = answer - stopped;
  const double square = 0.5 * mass * dot(rebound, rebound), linear = mass * dot(stopped, rebound);
  const double root = __builtin_sqrt(linear * linear + 4 * square * most(-work, 0)) - linear;
  answer = stopped + clamp(root / (2 * most(square, above_zero)), 0, 1) * rebound;
  return work + 0.5 * mass * (dot(answer, answer) - dot(stopped, stopped));
}

template <bool reflects, bool rebounds>
void respond_by(const TouchLaw law, TouchBlock& block) {
  for (int k = 0; k < size; ++k) {
    const bool touched = block.touched[k] != 0;
    const Vector normal = get(block.normal, k), velocity = get(block.velocity, k),
                 before = get(block.before, k);
    const double mass = block.mass[k], inward = dot(velocity, normal), load = block.normal_load[k] / mass;
    const bool moves_in = inward < 0;
    const Vector still = reflects ? law.friction * (velocity - inward * normal)
                                  : answer_of(law, velocity, normal, inward, 0, load);
    const Vector stopped = choose(moves_in, still, velocity);
    const Vector gone = (1 / law.step) * (get(block.point, k) - get(block.start, k));
    double work =
        stopping_work(mass, block.normal_load[k], normal, stopped - velocity, before, stopped, gone);
    Vector answer = stopped;
    double outcome = 1;
    if (reflects || rebounds) {
      const double approach = reflects ? -inward : approach_of(law, block, k, normal);
      const Vector bounced = reflects
                                 ? still + (law.friction * approach) * normal
                                 : answer_of(law, velocity, normal, inward, law.restitution * approach, load);
      answer = choose(moves_in, choose(approach > 0, bounced, stopped), stopped);
      work = limit_rebound(mass, work, stopped, answer);
      const Vector change = answer - stopped;
      outcome = dot(change, change) > 0 ? 2 : 1;
    }
    set(block.position, k, choose(touched, get(block.point, k), get(block.position, k)));
    set(block.velocity, k, choose(touched, answer, velocity));
    set(block.before, k, choose(touched, answer, before));
    block.work[k] += touched ? work : 0;
    block.outcome[k] = most(block.outcome[k], touched ? outcome : 0);
  }
}

void respond(const TouchLaw& law, TouchBlock& block) {
  if (law.reflects)
    respond_by<true, false>(law, block);
  else if (law.restitution > 0)
    respond_by<false, true>(law, block);
  else
    respond_by<false, false>(law, block);
}

constexpr TouchKernels table{find_touched, respond};

}  // namespace

const TouchKernels& TouchKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
