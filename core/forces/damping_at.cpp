#include "forces/damping_at.h"

#include "cloth/normals.h"

namespace cloth {
namespace {

/// Calls visit(particle) for the other end of every spring of `block` that ends at particle i.
template <class Visit>
void for_each_neighbour(const SpringBlock& block, int i, const Visit& visit) {
  const auto has = [&](int first_end) {
    const int k = first_end - block.run.first;
    if (k < 0) return false;
    const int row = block.stride > 0 ? k / block.stride : 0;
    return row < block.rows && k - row * block.stride < block.run.count;
  };
  if (has(i)) visit(static_cast<std::size_t>(i + block.run.offset));
  if (has(i - block.run.offset)) visit(static_cast<std::size_t>(i - block.run.offset));
}

}  // namespace

bool knows_damping_at(const ClothSystem& system, const SweepTerms& terms) {
  constexpr std::size_t directions = 6;  // of a grid's springs; each particle's are looked for in all blocks
  return !system.is_mesh() && system.springs.blocks().size() <= directions && terms.uniform_mass &&
         !terms.has_shares && !(terms.stretch_time > 0) && !(terms.bending_time > 0) && !terms.sliders;
}

Vec3 damping_at(const ClothSystem& system, const SweepTerms& terms, const Vec3Field& position,
                const Vec3Field& velocity, std::size_t particle) {
  const Vec3 x = position[particle], v = velocity[particle];
  Vec3 product = terms.damping * v;
  if (terms.spring_damping > 0)
    for (const SpringBlock& block : system.springs.blocks())
      for_each_neighbour(block, static_cast<int>(particle), [&](std::size_t other) {
        const Vec3 d = position[other] - x;
        const double square = d.squaredNorm();
        if (square > 0) product += (terms.spring_damping * (v - velocity[other]).dot(d) / square) * d;
      });
  if (terms.air) {
    const Vec3 n = particle_normal(system.rows, system.columns, position, particle);
    const double along = n.dot(v);
    product += terms.air_drag * along * n + terms.air_friction * (v - along * n);
  }
  return product;
}

double power_of_damping(const ClothSystem& system, const SweepTerms& terms, const Vec3Field& position,
                        const Vec3Field& velocity, const SparseField& change) {
  double power = 0;
  const auto add = [&](std::size_t i) {
    power -= damping_at(system, terms, position, velocity, i).dot(change[i]);
  };
  if (change.is_everywhere())
    for (std::size_t i = 0; i < change.size(); ++i) add(i);
  else
    for (const std::uint32_t i : change.particles()) add(i);
  return power;
}

}  // namespace cloth
