#include "forces/force.h"

namespace cloth {

Work& Work::operator+=(const Work& other) {
  damping_loss += other.damping_loss;
  air += other.air;
  brush += other.brush;
  pull += other.pull;
  return *this;
}

Work operator*(double scale, Work work) {
  work.damping_loss *= scale;
  work.air *= scale;
  work.brush *= scale;
  work.pull *= scale;
  return work;
}

void Force::add_damping(const Vec3Field&, const Vec3Field&, Vec3Field&) const {}
bool Force::add_node_damping(NodeDamping&) const {
  return true;
}
void Force::add_power(const Vec3Field&, const Vec3Field&, Work&) const {}
void Force::add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights&,
                              Linearisation&) const {}
void Force::add_asymmetric_product(const ClothSystem&, const Vec3Field&, const Vec3Field&, const Vec3Field&,
                                   Vec3Field&) const {}

}  // namespace cloth
