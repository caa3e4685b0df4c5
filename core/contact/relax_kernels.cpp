#include "contact/relax_kernels.h"

#include "kernels/four.h"
#include "kernels/three.h"

namespace cloth {
namespace {

using kernels::load_four, kernels::product, kernels::store_four;
using Vector = kernels::Four;  // of one particle or contact
using Lanes = kernels::Four;   // a number of each of four contacts

using Vectors = kernels::Three<Lanes>;  // of four contacts

CLOTHLAB_INLINE Lanes root(const Lanes& a) {
  return Lanes{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]), __builtin_sqrt(a[3])};
}
CLOTHLAB_INLINE Vectors load_vectors(const double (&from)[3][4]) {
  return {load_four(from[0]), load_four(from[1]), load_four(from[2])};
}

/// Whether one of these, which are at least 0, is not 0.
CLOTHLAB_INLINE bool any(const Lanes& of) {
  const Lanes negative = Lanes{0, 0, 0, 0} - of;
#ifdef __AVX__
  return __builtin_ia32_movmskpd256(negative) != 0;
#else
  return negative[0] < 0 || negative[1] < 0 || negative[2] < 0 || negative[3] < 0;
#endif
}

// Without AVX, GCC 12 takes shuffles of four doubles apart into single numbers; with it, vectors that are put
// together number by number take more shuffles than these.
#ifdef __AVX__
/// The first three numbers of four vectors, side by side.
CLOTHLAB_INLINE Vectors side_by_side(const Vector (&of)[4]) {
  const Vector xz_of_01 = __builtin_shufflevector(of[0], of[1], 0, 4, 2, 6),
               y_of_01 = __builtin_shufflevector(of[0], of[1], 1, 5, 3, 7),
               xz_of_23 = __builtin_shufflevector(of[2], of[3], 0, 4, 2, 6),
               y_of_23 = __builtin_shufflevector(of[2], of[3], 1, 5, 3, 7);
  return {__builtin_shufflevector(xz_of_01, xz_of_23, 0, 1, 4, 5),
          __builtin_shufflevector(y_of_01, y_of_23, 0, 1, 4, 5),
          __builtin_shufflevector(xz_of_01, xz_of_23, 2, 3, 6, 7)};
}

/// The vector of each, with 0 as the fourth number.
CLOTHLAB_INLINE void one_by_one(const Vectors& of, Vector (&to)[4]) {
  const Vector none{0, 0, 0, 0};
  const Vector xy_of_02 = __builtin_shufflevector(of.x, of.y, 0, 4, 2, 6),
               xy_of_13 = __builtin_shufflevector(of.x, of.y, 1, 5, 3, 7),
               z_of_02 = __builtin_shufflevector(of.z, none, 0, 4, 2, 6),
               z_of_13 = __builtin_shufflevector(of.z, none, 1, 5, 3, 7);
  to[0] = __builtin_shufflevector(xy_of_02, z_of_02, 0, 1, 4, 5);
  to[1] = __builtin_shufflevector(xy_of_13, z_of_13, 0, 1, 4, 5);
  to[2] = __builtin_shufflevector(xy_of_02, z_of_02, 2, 3, 6, 7);
  to[3] = __builtin_shufflevector(xy_of_13, z_of_13, 2, 3, 6, 7);
}
#else
CLOTHLAB_INLINE Vectors side_by_side(const Vector (&of)[4]) {
  return {Lanes{of[0][0], of[1][0], of[2][0], of[3][0]}, Lanes{of[0][1], of[1][1], of[2][1], of[3][1]},
          Lanes{of[0][2], of[1][2], of[2][2], of[3][2]}};
}
CLOTHLAB_INLINE void one_by_one(const Vectors& of, Vector (&to)[4]) {
  for (int k = 0; k < 4; ++k) to[k] = Vector{of.x[k], of.y[k], of.z[k], 0};
}
#endif

CLOTHLAB_INLINE Vectors points_of(const FourContacts& contacts, const ContactValue* values) {
  Vector point[4];
  for (int k = 0; k < 4; ++k) {
    const auto& weight = contacts.weight[k];
    const auto& slot = contacts.slot[k];
    point[k] = (weight[0] * load_four(values[slot[0]].of) + weight[1] * load_four(values[slot[1]].of)) +
               (weight[2] * load_four(values[slot[2]].of) + weight[3] * load_four(values[slot[3]].of));
  }
  return side_by_side(point);
}

/// Friction impulses that would stop the slip, or as much of them as the most that there can be.
CLOTHLAB_INLINE Vectors within(const Lanes& most, const Vectors& wanted) {
  const Lanes square = dot(wanted, wanted), part = most / root(square), whole{1, 1, 1, 1};
  return (square > most * most ? part : whole) * wanted;
}

/// The changes of the impulses; false where there are none.
CLOTHLAB_INLINE bool relax_four(FourContacts& contacts, const Vectors& point, Vector (&impulse)[4]) {
  const Vectors normal = load_vectors(contacts.normal);
  const Lanes none{0, 0, 0, 0}, level = dot(normal, point), before = load_four(contacts.normal_impulse),
                                inverse_mobility = load_four(contacts.inverse_mobility);
  const Lanes wanted = before + (load_four(contacts.bound) - level) * inverse_mobility;
  const Lanes kept = wanted > none ? wanted : none;
  if (!any(kept + before)) return false;
  const Lanes change = kept - before, now = before + change;
  const Vectors rubbed = load_vectors(contacts.friction_impulse);
  const Vectors across =
      point - load_vectors(contacts.rest) - (level - load_four(contacts.rest_level)) * normal;
  const Vectors rubs = within(load_four(contacts.friction) * now, rubbed - inverse_mobility * across);
  store_four(contacts.normal_impulse, now);
  store_four(contacts.friction_impulse[0], rubs.x);
  store_four(contacts.friction_impulse[1], rubs.y);
  store_four(contacts.friction_impulse[2], rubs.z);
  one_by_one(change * normal + (rubs - rubbed), impulse);
  return true;
}

CLOTHLAB_INLINE void move(const FourContacts& contacts, const Vector (&impulse)[4], ContactValue* values) {
  for (int row = 0; row < 4; ++row)
    for (int k = 0; k < 4; ++k) {
      double* const value = values[contacts.slot[row][k]].of;
      store_four(value, load_four(value) + contacts.response[row][k] * impulse[row]);
    }
}

CLOTHLAB_INLINE void relax_batch(ContactBatch& batch, ContactValue* values) {
  const Vectors first = points_of(batch.four[0], values), second = points_of(batch.four[1], values);
  Vector of_first[4], of_second[4];
  const bool first_acts = relax_four(batch.four[0], first, of_first);
  if (relax_four(batch.four[1], second, of_second)) move(batch.four[1], of_second, values);
  if (first_acts) move(batch.four[0], of_first, values);
}

void relax(ContactBatch* batches, const int* order, int count, ContactValue* values) {
  for (int k = 0; k < count; ++k) relax_batch(batches[order[k]], values);
}

int note_moved(const ContactValue* values, ContactValue* before, unsigned char* moved, int count,
               double squared_tolerance) {
  int number = 0;
  for (int k = 0; k < count; ++k) {
    const Vector now = load_four(values[k].of), change = now - load_four(before[k].of);
    store_four(before[k].of, now);
    moved[k] = product(change, change) > squared_tolerance;
    number += moved[k];
  }
  return number;
}

constexpr RelaxKernels table{relax, note_moved};

}  // namespace

const RelaxKernels& RelaxKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
