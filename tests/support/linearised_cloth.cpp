#include "support/linearised_cloth.h"

#include <gtest/gtest.h>

#include "geometry/dense_decompositions.h"
#include "support/random.h"
#include "support/states.h"

namespace cloth::test {

LinearisedCloth::LinearisedCloth(const Scene& scene, double h, double deviation)
    : run(scene, "implicit-euler"), step(h) {
  Random random;
  run.state = crumpled_state(run.system, deviation, 0.5, random);
  run.forces.update(run.state.position, 0);
  linearise(true, clamped), linearise(false, exact);
}

void LinearisedCloth::linearise(bool clamps, Linearisation& to) {
  run.forces.linearise(run.state.position, {.position = step * step, .velocity = step, .clamped = clamps},
                       to);
}

Vec3Field LinearisedCloth::residual() const {
  Random random;
  Vec3Field field = random.field(size(), 1e-3);
  for (std::size_t i = 0; i < size(); ++i)
    if (run.system.pinned[i]) field.set(i, Vec3::Zero());
  return field;
}

Eigen::MatrixXd LinearisedCloth::matrix() const {
  return matrix_of([&](const Vec3Field& in, Vec3Field& out) { clamped.multiply(run.system, in, out); });
}

/// Column by column.
Eigen::MatrixXd LinearisedCloth::matrix_of(const LinearMap& map) const {
  const auto numbers = static_cast<Eigen::Index>(3 * size());
  Eigen::MatrixXd matrix(numbers, numbers);
  Vec3Field unit(size()), image(size());
  for (Eigen::Index k = 0; k < numbers; ++k) {
    const auto number = static_cast<std::size_t>(k);
    const bool pinned = run.system.pinned[number % size()];
    unit.fill(0);
    if (!pinned) unit.flat()[number] = 1;
    map(unit, image);
    for (Eigen::Index i = 0; i < numbers; ++i) matrix(i, k) = image.flat()[static_cast<std::size_t>(i)];
    if (pinned) matrix(k, k) = 1;
  }
  return matrix;
}

void expect_a_cycle_that_reduces_every_error(const Scene& scene, double h, double deviation, double most) {
  const LinearisedCloth cloth(scene, h, deviation);
  SCOPED_TRACE(::testing::Message() << cloth.size() << " particles");
  MultigridSolver solver;
  ASSERT_TRUE(MultigridSolver::suits(cloth.run.system));
  ASSERT_TRUE(cloth.prepare(solver));
  const Eigen::MatrixXd a = cloth.matrix();
  const Eigen::MatrixXd b =
      cloth.matrix_of([&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); });
  EXPECT_LE((b - b.transpose()).norm(), 1e-4 * b.norm());
  const Eigen::MatrixXd root = cholesky_factor(a).value();
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(a.rows(), a.cols()) - Eigen::MatrixXd(root.transpose() * b * root);
  EXPECT_LT(spectral_norm(left), most);
}

void expect_the_solution_of_factors(const Scene& scene, double h, double deviation, int most_iterations) {
  const LinearisedCloth cloth(scene, h, deviation);
  MultigridSolver solver;
  ASSERT_TRUE(cloth.prepare(solver));
  CholeskyFactors factors;
  ASSERT_TRUE(factors.factorise(cloth.run.system, cloth.clamped));
  const Vec3Field residual = cloth.residual();
  Vec3Field expected(cloth.size()), solution(cloth.size());
  factors.solve(residual, expected);
  ConjugateGradients gradients;
  const KrylovReport report = gradients.solve(
      cloth.run.system, cloth.clamped,
      [&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); }, residual, 1e-10, solution);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, most_iterations);
  EXPECT_LE(largest_distance(solution, expected), 1e-8 * largest_norm(expected));
}

int iterations_to_a_thousandth(const Scene& scene, double h, double deviation) {
  const LinearisedCloth cloth(scene, h, deviation);
  MultigridSolver solver;
  if (!cloth.prepare(solver)) return -1;
  Vec3Field solution(cloth.size());
  ConjugateGradients gradients;
  const LinearMap cycle = [&](const Vec3Field& in, Vec3Field& out) { solver.precondition(in, out); };
  return gradients.solve(cloth.run.system, cloth.clamped, cycle, cloth.residual(), 1e-3, solution).iterations;
}

}  // namespace cloth::test
