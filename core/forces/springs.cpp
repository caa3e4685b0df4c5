#include "forces/springs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cloth/grid.h"
#include "cloth/sums.h"
#include "forces/registry.h"
#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"
#include "scene/scene_cloth.h"

namespace cloth {
namespace {

// Legend: i, j the spring's ends; d = x_j - x_i; L rest length; k stiffness; g the force on i.

/// Springs are taken in chunks: the forces of a chunk are computed side by side, then added to its two ends,
/// so that a run whose ends overlap (offset 1) vectorises as well.
constexpr int chunk_length = VectorKernels::max_springs;

struct Chunk {
  std::array<double, chunk_length> x, y, z;
};

void add_to_ends(const Chunk& g, int first, int offset, int count, Vec3Field& force) {
  double *fx = force.x() + first, *fy = force.y() + first, *fz = force.z() + first;
  for (int s = 0; s < count; ++s) fx[s] += g.x[s], fy[s] += g.y[s], fz[s] += g.z[s];
  fx += offset, fy += offset, fz += offset;
  for (int s = 0; s < count; ++s) fx[s] -= g.x[s], fy[s] -= g.y[s], fz[s] -= g.z[s];
}

template <class Visit>  // visit(run, first, count)
void for_each_chunk(const ClothSystem& system, Visit visit) {
  for (const SpringRun& run : system.springs)
    for (int begin = 0; begin < run.count; begin += chunk_length)
      visit(run, run.first + begin, std::min(chunk_length, run.count - begin));
}

void spring_chunk(const SpringRun& run, int first, int count, const Vec3Field& position, Chunk& g) {
  const double *xi = position.x() + first, *yi = position.y() + first, *zi = position.z() + first;
  const double *xj = xi + run.offset, *yj = yi + run.offset, *zj = zi + run.offset;
  const double k = run.stiffness, L = run.rest_length;
  for (int s = 0; s < count; ++s) {
    const double dx = xj[s] - xi[s], dy = yj[s] - yi[s], dz = zj[s] - zi[s];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double scale = length > 0 ? k * (1 - L / length) : 0;
    g.x[s] = scale * dx, g.y[s] = scale * dy, g.z[s] = scale * dz;
  }
}

void damper_chunk(const SpringRun& run, int first, int count, const Vec3Field& position,
                  const Vec3Field& velocity, double damping, Chunk& g) {
  const double *xi = position.x() + first, *yi = position.y() + first, *zi = position.z() + first;
  const double *xj = xi + run.offset, *yj = yi + run.offset, *zj = zi + run.offset;
  const double *vxi = velocity.x() + first, *vyi = velocity.y() + first, *vzi = velocity.z() + first;
  const double *vxj = vxi + run.offset, *vyj = vyi + run.offset, *vzj = vzi + run.offset;
  for (int s = 0; s < count; ++s) {
    const double dx = xj[s] - xi[s], dy = yj[s] - yi[s], dz = zj[s] - zi[s];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double inverse = length > 0 ? 1 / length : 0;
    const double ex = inverse * dx, ey = inverse * dy, ez = inverse * dz;
    const double closing = (vxi[s] - vxj[s]) * ex + (vyi[s] - vyj[s]) * ey + (vzi[s] - vzj[s]) * ez;
    g.x[s] = damping * closing * ex, g.y[s] = damping * closing * ey, g.z[s] = damping * closing * ez;
  }
}

double run_energy(const SpringRun& run, const Vec3Field& position, const VectorKernels& kernels) {
  if (run.count == 1) {
    const auto i = static_cast<std::size_t>(run.first), j = static_cast<std::size_t>(run.first + run.offset);
    const double elongation = (position[j] - position[i]).norm() - run.rest_length;
    return 0.5 * run.stiffness * (elongation * elongation);
  }
  const ConstVectorRows ends{position.x() + run.first, position.y() + run.first, position.z() + run.first};
  return 0.5 * run.stiffness *
         kernels.squared_stretches(ends, run.offset, run.rest_length, static_cast<std::size_t>(run.count));
}

/// Sum of the squares of the rates (m/s) at which a run's springs stretch.
double squared_rates(const SpringRun& run, const Vec3Field& position, const Vec3Field& velocity) {
  const auto *x = position.x() + run.first, *y = position.y() + run.first, *z = position.z() + run.first;
  const auto *vx = velocity.x() + run.first, *vy = velocity.y() + run.first, *vz = velocity.z() + run.first;
  const std::size_t to = static_cast<std::size_t>(run.offset);
  return ordered_sum(static_cast<std::size_t>(run.count), [=](std::size_t s) {
    const double dx = x[s + to] - x[s], dy = y[s + to] - y[s], dz = z[s + to] - z[s];
    const double square = dx * dx + dy * dy + dz * dz;
    const double rate = (vx[s + to] - vx[s]) * dx + (vy[s + to] - vy[s]) * dy + (vz[s + to] - vz[s]) * dz;
    return square > 0 ? rate * rate / square : 0;
  });
}

/// What VectorKernels::add_spring_slopes() does, to the same bits, for a run of one: a mesh's, for which a
/// kernel's loops are too long.
bool add_slope(const SpringSlopes& of, const Vec3& d, std::size_t spring, SymmetricBlocks& blocks) {
  const double length = std::sqrt(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
  const double inverse = length > 0 ? 1 / length : 0;
  const double exact = length > 0 ? of.stiffness * (1 - of.rest_length * inverse) : of.stiffness;
  const double across = of.clamped && exact < 0 ? 0 : exact;
  blocks.add(spring, block_along(across, of.stiffness + of.damping - across, inverse * d));
  return exact < 0;
}

ConstVectorRows rows_at(const Vec3Field& field, int first) {
  return {field.x() + first, field.y() + first, field.z() + first};
}

/// True if the transverse stiffness of a spring is negative.
template <class Slopes>  // SpringSlopes slopes(run)
bool add_slopes(const ClothSystem& system, const Vec3Field& position, Slopes slopes, Linearisation& to) {
  const auto& kernels = active_kernels<VectorKernels>();
  std::size_t spring = 0;
  bool has_negative = false;
  for (const SpringRun& run : system.springs) {
    const auto i = static_cast<std::size_t>(run.first), j = static_cast<std::size_t>(run.first + run.offset);
    const SpringSlopes of = slopes(run);
    has_negative |= run.count == 1 ? add_slope(of, position[j] - position[i], spring, to.springs)
                                   : kernels.add_spring_slopes(of, rows_at(position, run.first),
                                                               to.springs.sums(spring), run.count);
    spring += static_cast<std::size_t>(run.count);
  }
  return has_negative;
}

class SpringForce : public Force {
 public:
  KernelCoverage join(SweepTerms&) const override { return KernelCoverage::every_pass; }
  bool is_internal() const override { return true; }
  void update(const ClothSystem& system, const Vec3Field& position, double, Vec3Field& force) override {
    Chunk g;
    for_each_chunk(system, [&](const SpringRun& run, int first, int count) {
      spring_chunk(run, first, count, position, g);
      add_to_ends(g, first, run.offset, count, force);
    });
  }
  /// -dp_i/dx_i = k (a a^T + (1 - L/|d|) (I - a a^T)) with a = d/|d|. A spring without direction has no slope
  /// of its own; k I bounds it.
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override {
    const bool has_negative = add_slopes(
        system, position,
        [&](const SpringRun& run) {
          return SpringSlopes{.stiffness = weights.position * run.stiffness,
                              .rest_length = run.rest_length,
                              .offset = run.offset,
                              .clamped = weights.clamped};
        },
        to);
    to.has_compressed = to.has_compressed || has_negative;
  }
};

/// F_i = k_d ((v_j - v_i) . d/|d|) d/|d| on every spring; 0 where |d| = 0. k_d is the same for all springs,
/// or a damping time times the spring's stiffness.
class SpringDamping : public Force {
 public:
  /// `damping` in N s/m, `time` in s; `system` must outlive the force.
  SpringDamping(const ClothSystem& system, double damping, double time)
      : system_(&system), damping_(damping), time_(time) {}

  KernelCoverage join(SweepTerms& terms) const override {
    if ((time_ > 0) != terms.has_shares) return KernelCoverage::none;
    terms.spring_damping = damping_;
    terms.stretch_time = time_;
    return KernelCoverage::every_pass;
  }
  bool is_swept_damper(const SweepTerms& terms) const override {
    return terms.spring_damping > 0 || terms.stretch_time > 0;
  }
  bool is_internal() const override { return true; }
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override {
    Chunk g;
    for_each_chunk(*system_, [&](const SpringRun& run, int first, int count) {
      damper_chunk(run, first, count, position, velocity, of(run), g);
      add_to_ends(g, first, run.offset, count, product);
    });
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.along_springs += damping_;
    damping.stretch_time += time_;
    return false;
  }
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override {
    for (const SpringRun& run : system_->springs)
      power.damping_loss += of(run) * squared_rates(run, position, velocity);
  }
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override {
    add_slopes(
        system, position,
        [&](const SpringRun& run) {
          return SpringSlopes{.stiffness = 0,
                              .rest_length = 0,
                              .offset = run.offset,
                              .clamped = false,
                              .damping = weights.velocity * of(run)};
        },
        to);
  }
  bool has_asymmetric_part() const override { return true; }
  void add_asymmetric_product(const ClothSystem& system, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override {
    const auto& kernels = active_kernels<VectorKernels>();
    for_each_chunk(system, [&](const SpringRun& run, int first, int count) {
      const MovingRows particles{rows_at(position, first), rows_at(velocity, first),
                                 rows_at(direction, first)};
      kernels.add_damper_turns(of(run), particles,
                               {product.x() + first, product.y() + first, product.z() + first}, run.offset,
                               count);
    });
  }

 private:
  double of(const SpringRun& run) const { return damping_ + time_ * run.stiffness; }

  const ClothSystem* system_;
  double damping_;  ///< N s/m
  double time_;     ///< s
};

bool has_stiffness(const SpringRuns& springs) {
  return std::any_of(springs.begin(), springs.end(), [](const SpringRun& run) { return run.stiffness > 0; });
}

/// Of a material.
StageInfo material_stage(const Scene& scene, const ClothSystem& system, SpringFamily family) {
  const std::string name = fmt::format("{} springs", name_of(family));
  const auto count = system.spring_count(family);
  if (system.is_mesh() && count > 0)
    return {name, false, "a mesh's material has triangles; its edges measure strain alone"};
  if (count == 0 && family == SpringFamily::flexion)
    return {name, false, "a material bends by its own elements"};
  if (count == 0) return {name, false, "the material's stiffness for them is 0"};
  const CellSides cell = cell_sides(scene.cloth);
  const CellSprings k = cell_springs(*scene.material, cell.across, cell.down);
  if (family == SpringFamily::shear)
    return {name, true, fmt::format("{} springs of {:.6g} N/m", count, k.diagonal)};
  return {name, true,
          fmt::format("{} springs of {:.6g} N/m across and {:.6g} N/m down, half of that at the borders",
                      count, k.across, k.down)};
}

StageInfo family_stage(const Scene& scene, const ClothSystem& system, SpringFamily family) {
  if (scene.material) return material_stage(scene, system, family);
  const std::string name = fmt::format("{} springs", name_of(family));
  if (auto absent = absent_stage(name, scene, "springs")) return *absent;
  const double stiffness = stiffness_of(*scene.springs, family);
  if (!(stiffness > 0)) return {name, false, fmt::format("springs.{} is 0", name_of(family))};
  const auto count = system.spring_count(family);
  if (count == 0 && family == SpringFamily::shear && system.is_mesh())
    return {name, false, "a mesh has edges and no cells to shear"};
  if (count == 0) return {name, false, "the grid is too small for any"};
  return {name, true, fmt::format("{} springs of {} N/m", count, stiffness)};
}

std::vector<StageInfo> explain_springs(const Scene& scene, const ClothSystem& system) {
  std::vector<StageInfo> stages;
  for (const SpringFamily family : spring_families) stages.push_back(family_stage(scene, system, family));
  return stages;
}

}  // namespace

std::array<double, 3> elastic_energy(const ClothSystem& system, const Vec3Field& position) {
  const VectorKernels& kernels = active_kernels<VectorKernels>();
  std::array<double, 3> energy{};
  for (const SpringRun& run : system.springs)
    energy[static_cast<std::size_t>(run.family)] += run_energy(run, position, kernels);
  return energy;
}

ForceEntry spring_entry() {
  return {.make = [](const Scene&, const ClothSystem& system) -> std::unique_ptr<Force> {
            return has_stiffness(system.springs) ? std::make_unique<SpringForce>() : nullptr;
          },
          .explain = explain_springs};
}

ForceEntry spring_damping_entry() {
  return {.make = [](const Scene& scene, const ClothSystem& system) -> std::unique_ptr<Force> {
            const double damping = scene.springs ? scene.springs->damping : 0,
                         time = scene.material ? scene.material->stretch_damping : 0;
            if (!has_stiffness(system.springs) || !(damping + time > 0)) return nullptr;
            return std::make_unique<SpringDamping>(system, damping, time);
          },
          .work = &Work::damping_loss,
          .explain = [](const Scene& scene, const ClothSystem& system) -> std::vector<StageInfo> {
            if (!system.membrane.empty()) return {};
            return std::vector{coefficient_stage(
                "spring damping", scene, scene.material ? "material.stretch_damping" : "springs.damping")};
          }};
}

}  // namespace cloth
