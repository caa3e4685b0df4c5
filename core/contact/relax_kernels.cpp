#include "contact/relax_kernels.h"

#include "kernels/four.h"

namespace cloth {
namespace {

using kernels::load_four, kernels::product, kernels::store_four;
using Vector = kernels::Four;

/// The friction impulse that stops the slip, or as much of it as friction times the normal impulse allows.
CLOTHLAB_INLINE Vector friction_for(const ContactRow& row, Vector friction_impulse, Vector across) {
  const Vector wanted = friction_impulse - row.inverse_mobility * across;
  const double most = row.friction * row.normal_impulse, square = product(wanted, wanted);
  return square > most * most ? most / __builtin_sqrt(square) * wanted : wanted;
}

CLOTHLAB_INLINE void relax_one(ContactRow& row, ContactValue* values) {
  double* const value[4] = {values[row.slot[0]].of, values[row.slot[1]].of, values[row.slot[2]].of,
                            values[row.slot[3]].of};
  const Vector point = (row.weight[0] * load_four(value[0]) + row.weight[1] * load_four(value[1])) +
                       (row.weight[2] * load_four(value[2]) + row.weight[3] * load_four(value[3]));
  const Vector normal = load_four(row.normal);
  const double level = product(normal, point);
  const double wanted = row.normal_impulse + (row.bound - level) * row.inverse_mobility;
  const double change = (wanted > 0 ? wanted : 0) - row.normal_impulse;
  if (change == 0 && row.normal_impulse == 0) return;
  row.normal_impulse += change;
  Vector total = change * normal;
  if (row.friction > 0) {
    const Vector across = point - load_four(row.rest) - (level - row.rest_level) * normal;
    const Vector before = load_four(row.friction_impulse), now = friction_for(row, before, across);
    store_four(row.friction_impulse, now);
    total += now - before;
  }
  for (int k = 0; k < 4; ++k) store_four(value[k], load_four(value[k]) + row.response[k] * total);
}

void relax(ContactRow* rows, const int* order, int count, ContactValue* values) {
  for (int k = 0; k < count; ++k) relax_one(rows[order[k]], values);
}

bool note_moved(const ContactValue* values, ContactValue* before, unsigned char* moved, int count,
                double squared_tolerance) {
  bool any = false;
  for (int k = 0; k < count; ++k) {
    const Vector now = load_four(values[k].of), change = now - load_four(before[k].of);
    store_four(before[k].of, now);
    moved[k] = product(change, change) > squared_tolerance;
    any = any || moved[k];
  }
  return any;
}

constexpr RelaxKernels table{relax, note_moved};

}  // namespace

const RelaxKernels& RelaxKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
