#include "bench/solvers/newton_system.h"

#include <algorithm>
#include <cmath>

#include "cloth/sums.h"
#include "forces/force_model.h"
#include "geometry/split_mix.h"
#include "integrators/implicit/linear_solver.h"
#include "scene/scene_mesh.h"
#include "simulation/simulation.h"

namespace cloth::solvers {
namespace {

constexpr double step = 1.0 / 60;  // s
constexpr int wanted_iteration = 4;

double norm(const Vec3Field& field) {
  return std::sqrt(dot(field.flat(), field.flat()));
}

/// Of 0 to 1 from the generator's next number.
double part(SplitMix& random) {
  return static_cast<double>(random.bits() >> 11) * 0x1p-53;
}

/// 1 m x 1 m in the plane y = 0 from z = 0, which is pinned: points up to a quarter of a cell off, cells cut
/// along the one or the other diagonal, always the same.
void cut_to_triangles(ClothSheet& cloth, int size) {
  SplitMix random(2);
  const double cell = 1.0 / (size - 1);
  TriangleMesh surface;
  cloth.pins.clear();
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const bool is_inside = row > 0 && row + 1 < size && column > 0 && column + 1 < size;
      const double off = is_inside ? 0.5 * cell : 0;
      const double x = cell * column + off * (part(random) - 0.5),
                   z = cell * row + off * (part(random) - 0.5);
      surface.vertices.emplace_back(x, 0, z);
      if (row == 0) cloth.pins.push_back(PinnedParticle{0, column});
    }
  for (int row = 0; row + 1 < size; ++row)
    for (int column = 0; column + 1 < size; ++column) {
      const int p = row * size + column, q = p + 1, s = p + size, r = s + 1;
      const bool falls = part(random) < 0.5;
      surface.triangles.push_back(falls ? Triangle{p, s, r} : Triangle{p, s, q});
      surface.triangles.push_back(falls ? Triangle{p, r, q} : Triangle{q, s, r});
    }
  cloth.mesh = made_mesh("sheet.obj", surface);
  cloth.rows = 1, cloth.columns = size * size;
  cloth.origin = Vec3::Zero();
}

Scene scene_of(ClothShape shape, int size) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = size;
  scene.springs = SpringMaterial{.structural = 1000, .shear = 500, .flexion = 100};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator.method = "implicit-euler";
  scene.integrator.time_step = step;
  const bool is_smooth = shape != ClothShape::buckled;
  scene.cloth.pins = is_smooth ? std::vector<Pin>{NamedPin::top_edge}
                               : std::vector<Pin>{NamedPin::top_left, NamedPin::top_right};
  scene.cloth.down = is_smooth ? Vec3(0, 0, 1) : Vec3(0, -0.95, 0.3);
  if (shape == ClothShape::mesh) cut_to_triangles(scene.cloth, size);
  return scene;
}

/// Narrower by 15 %, and off its plane by up to a fiftieth of a cell, always the same.
void squeeze(ClothSystem& system, ClothState& state) {
  SplitMix random(1);
  const double cell =
      system.springs.begin() == system.springs.end() ? 0 : (*system.springs.begin()).rest_length;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    Vec3 x = state.position[i];
    x.x() *= 0.85;
    if (const double p = part(random); !system.pinned[i]) x.z() += 0.02 * cell * (2 * p - 1);
    state.position.set(i, x);
  }
}

/// Newton's method for one step, as integrators/implicit/implicit_stage.h has it, by factors; stops where
/// the system that is wanted stands.
class OneStep {
 public:
  OneStep(const Scene& scene, const ClothState& state, NewtonSystem& result)
      : forces_(scene, result.system),
        start_(state),
        velocity_(state.velocity),
        position_(state.position),
        force_(state.position.size()),
        result_(result) {}

  void find() {
    evaluate();
    const double first = norm(residual_);
    for (result_.iteration = 1;; ++result_.iteration) {
      linearise();
      if (result_.iteration == wanted_iteration || norm(residual_) < 1e-7 * first) break;
      go_along();
    }
    result_.position = position_;
    result_.right_hand_side = residual_;
    for (double& value : result_.right_hand_side.flat()) value = -value;
  }

 private:
  void evaluate() {
    position_ = start_.position;
    add_scaled(step, velocity_, position_);
    forces_.update(position_, start_.time + step);
    forces_.force(position_, velocity_, force_);
    residual_ = Vec3Field(velocity_.size());
    for (std::size_t i = 0; i < velocity_.size(); ++i)
      if (!result_.system.pinned[i])
        residual_.set(i, result_.system.mass[i] * (velocity_[i] - start_.velocity[i]) - step * force_[i]);
  }

  void linearise() {
    LinearisationWeights weights{.position = step * step, .velocity = step, .clamped = false};
    forces_.linearise(position_, weights, result_.matrix);
    weights.clamped = true;
    forces_.linearise(position_, weights, result_.clamped);
    result_.is_exact = factors_.factorise(result_.system, result_.matrix);
    if (result_.is_exact) return;
    result_.matrix = result_.clamped;
    factors_.factorise(result_.system, result_.matrix);
  }

  void go_along() {
    Vec3Field direction(residual_.size());
    factors_.solve(residual_, direction);
    const Vec3Field from = velocity_;
    const double before = norm(residual_);
    double length = 1;
    for (int trial = 0; trial < 8; ++trial, length /= 2) {
      velocity_ = from;
      add_scaled(-length, direction, velocity_);
      evaluate();
      if (norm(residual_) < before) break;
    }
  }

  ForceModel forces_;
  CholeskyFactors factors_;
  const ClothState& start_;
  Vec3Field velocity_, position_, force_, residual_;
  NewtonSystem& result_;
};

}  // namespace

double NewtonSystem::relative_residual(const Vec3Field& solution) const {
  Vec3Field product(solution.size());
  matrix.multiply(system, solution, product);
  add_scaled(-1, right_hand_side, product);
  return norm(product) / norm(right_hand_side);
}

std::unique_ptr<NewtonSystem> newton_system(ClothShape shape, int size) {
  const Scene scene = scene_of(shape, size);
  const bool is_smooth = shape != ClothShape::buckled;
  Simulation simulation(scene, is_smooth ? Preparation{} : squeeze);
  simulation.advance(is_smooth ? 20 : 5);
  auto result = std::make_unique<NewtonSystem>();
  result->system = simulation.system();
  OneStep(scene, simulation.state(), *result).find();
  double compressed = 0, springs = 0;
  const Vec3Field& x = simulation.state().position;
  for_each_spring(result->system.springs,
                  [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
                    springs += 1;
                    if ((x[i] - x[j]).norm() < run.rest_length * (1 - 1e-6)) compressed += 1;
                  });
  result->compressed_part = compressed / springs;
  return result;
}

RowPattern::RowPattern(const ClothSystem& system) : row_(system.pinned.size(), -1) {
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (system.pinned[i]) continue;
    row_[i] = static_cast<int>(rows_.particle.size());
    rows_.particle.push_back(static_cast<int>(i));
  }
  const std::size_t free = rows_.particle.size();
  std::vector<std::vector<int>> neighbours(free);
  for (std::size_t k = 0; k < free; ++k) neighbours[k].push_back(static_cast<int>(k));
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
    if (row_[i] < 0 || row_[j] < 0) return;
    neighbours[static_cast<std::size_t>(row_[i])].push_back(row_[j]);
    neighbours[static_cast<std::size_t>(row_[j])].push_back(row_[i]);
  });
  rows_.begin.push_back(0);
  for (std::vector<int>& list : neighbours) {
    std::sort(list.begin(), list.end());
    for (int component = 0; component < 3; ++component) {
      for (const int other : list)
        for (int c = 0; c < 3; ++c) rows_.column.push_back(3 * other + c);
      rows_.begin.push_back(static_cast<int>(rows_.column.size()));
    }
  }
  rows_.value.assign(rows_.column.size(), 0);
  const auto place_of = [&](int block_row, int block_column) {
    const std::vector<int>& list = neighbours[static_cast<std::size_t>(block_row)];
    const auto at = std::lower_bound(list.begin(), list.end(), block_column) - list.begin();
    Place place{};
    for (std::size_t c = 0; c < 3; ++c)
      place.begin[c] = static_cast<std::size_t>(rows_.begin[3 * static_cast<std::size_t>(block_row) + c]) +
                       3 * static_cast<std::size_t>(at);
    return place;
  };
  for (std::size_t k = 0; k < free; ++k)
    diagonal_.push_back(place_of(static_cast<int>(k), static_cast<int>(k)));
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t, std::size_t i, std::size_t j) {
    if (row_[i] < 0 || row_[j] < 0) return;
    upper_.push_back(place_of(row_[i], row_[j]));
    lower_.push_back(place_of(row_[j], row_[i]));
  });
}

void RowPattern::put(const Place& place, double scale, const SymmetricBlock& block) {
  const double m[3][3] = {
      {block.xx, block.xy, block.xz}, {block.xy, block.yy, block.yz}, {block.xz, block.yz, block.zz}};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) rows_.value[place.begin[r] + c] += scale * m[r][c];
}

const SparseRows& RowPattern::fill(const ClothSystem& system, const Linearisation& matrix) {
  std::fill(rows_.value.begin(), rows_.value.end(), 0.0);
  for (std::size_t k = 0; k < diagonal_.size(); ++k)
    put(diagonal_[k], 1, matrix.nodes[static_cast<std::size_t>(rows_.particle[k])]);
  std::size_t pair = 0;
  for_each_spring(system.springs, [&](const SpringRun&, std::size_t spring, std::size_t i, std::size_t j) {
    const SymmetricBlock block = matrix.springs[spring];
    if (row_[i] >= 0) put(diagonal_[static_cast<std::size_t>(row_[i])], 1, block);
    if (row_[j] >= 0) put(diagonal_[static_cast<std::size_t>(row_[j])], 1, block);
    if (row_[i] < 0 || row_[j] < 0) return;
    put(upper_[pair], -1, block);
    put(lower_[pair++], -1, block);
  });
  return rows_;
}

std::vector<double> packed(const SparseRows& rows, const Vec3Field& field) {
  std::vector<double> values;
  values.reserve(3 * rows.particle.size());
  for (const int particle : rows.particle) {
    const Vec3 v = field[static_cast<std::size_t>(particle)];
    values.insert(values.end(), {v.x(), v.y(), v.z()});
  }
  return values;
}

void unpack(const SparseRows& rows, const std::vector<double>& values, Vec3Field& field) {
  field.fill(0);
  for (std::size_t k = 0; k < rows.particle.size(); ++k)
    field.set(static_cast<std::size_t>(rows.particle[k]),
              {values[3 * k], values[3 * k + 1], values[3 * k + 2]});
}

}  // namespace cloth::solvers
