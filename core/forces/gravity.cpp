#include "forces/gravity.h"

#include <fmt/format.h>

#include "cloth/sums.h"
#include "forces/registry.h"

namespace cloth {

namespace {

class Gravity : public Force {
 public:
  explicit Gravity(const Vec3& acceleration) : acceleration_(acceleration) {}

  KernelCoverage join(SweepTerms& terms) const override {
    if (!terms.uniform_mass) return KernelCoverage::none;
    terms.gravity = acceleration_;
    return KernelCoverage::every_pass;
  }
  void update(const ClothSystem& system, const Vec3Field&, double, Vec3Field& force) override {
    const double* mass = system.mass.data();
    double* components[] = {force.x(), force.y(), force.z()};
    for (int axis = 0; axis < 3; ++axis) {
      const double g = acceleration_[axis];
      if (g != 0)
        for (std::size_t i = 0; i < force.size(); ++i) components[axis][i] += mass[i] * g;
    }
  }

 private:
  Vec3 acceleration_;  ///< m/s^2
};

std::vector<StageInfo> explain_gravity(const Scene& scene, const ClothSystem&) {
  if (auto absent = absent_stage("gravity", scene, "gravity")) return {*absent};
  if (!(scene.gravity->squaredNorm() > 0)) return {{"gravity", false, "gravity is 0"}};
  const Vec3& g = *scene.gravity;
  return {{"gravity", true, fmt::format("[{}, {}, {}] m/s^2", g.x(), g.y(), g.z())}};
}

}  // namespace

double gravity_energy(const ClothSystem& system, const Vec3& acceleration, const Vec3Field& position) {
  const double* now[] = {position.x(), position.y(), position.z()};
  const double* then[] = {system.start.x(), system.start.y(), system.start.z()};
  double energy = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (acceleration[axis] != 0)
      energy -= acceleration[axis] *
                ordered_sum(position.size(), [m = system.mass.data(), x = now[axis], x0 = then[axis]](
                                                 std::size_t i) { return m[i] * (x[i] - x0[i]); });
  return energy;
}

ForceEntry gravity_entry() {
  return {.make = [](const Scene& scene, const ClothSystem&) -> std::unique_ptr<Force> {
            if (!(gravity_of(scene).squaredNorm() > 0)) return nullptr;
            return std::make_unique<Gravity>(*scene.gravity);
          },
          .explain = explain_gravity};
}

}  // namespace cloth
