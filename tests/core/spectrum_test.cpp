#include "measure/spectrum.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "cloth/grid.h"
#include "geometry/dense_decompositions.h"
#include "measure/stability_limit.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::spectrum_test {
namespace {

struct Ratio {
  double structural, shear, flexion;
  std::array<double, 4> free;  // omega_max sqrt(m/k_s) of N = 5, 10, 20, 40
};
constexpr std::array<int, 4> sizes{5, 10, 20, 40};
constexpr std::array<Ratio, 5> ratios{{{1, 1, 1, {2.8740, 3.0967, 3.1602, 3.1765}},
                                       {1, 1, 0.1, {2.6473, 2.7823, 2.8169, 2.8256}},
                                       {1, 0.5, 0.25, {2.3247, 2.4248, 2.4440, 2.4482}},
                                       {1, 0.1, 0.01, {1.9878, 2.0701, 2.0908, 2.0959}},
                                       {1, 0, 0, {1.9021, 1.9754, 1.9938, 1.9985}}}};
constexpr double printed = 0.51e-4;

SpringMaterial material_of(const Ratio& r) {
  return {.structural = r.structural, .shear = r.shear, .flexion = r.flexion, .damping = 0};
}

ClothSystem unit_grid(int rows, int columns, const SpringMaterial& material, std::vector<Pin> pins = {}) {
  ClothSheet sheet = bare_sheet(rows, columns, 1, 1).cloth;  // mass 1 per particle, spacing 1
  sheet.pins = std::move(pins);
  return make_grid(sheet, material);
}

/// All eigenvalues of M^-1 K of the free particles, from the dense matrix.
Eigen::VectorXd dense_spectrum(const ClothSystem& system, const Vec3Field& position) {
  const Eigen::MatrixXd hessian = spring_hessian(system, position);
  std::vector<Eigen::Index> free;
  Eigen::VectorXd scale(hessian.rows());
  for (Eigen::Index row = 0; row < hessian.rows(); ++row) {
    scale[row] = std::sqrt(system.inverse_mass[static_cast<std::size_t>(row / 3)]);
    if (scale[row] > 0) free.push_back(row);
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  const Eigen::MatrixXd reduced = scaled(free, free);
  return symmetric_values(reduced);
}

TEST(Spectrum, HasTheExtremesOfTheDenseMatrix) {
  Random random;
  for (int trial = 0; trial < 12; ++trial) {
    const SpringMaterial material{.structural = random.uniform(0.5, 2),
                                  .shear = random.uniform(0, 2),
                                  .flexion = random.coin() ? 0 : random.uniform(0, 2),
                                  .damping = 0};
    ClothSystem system = unit_grid(random.integer(2, 6), random.integer(2, 6), material,
                                   {NamedPin::top_left, PinnedParticle{1, 1}});
    for (double& inverse : system.inverse_mass) inverse *= random.uniform(0.2, 5);  // any masses
    const ClothState state = crumpled_state(system, random.uniform(0, 0.4), 0, random);
    const Eigen::VectorXd dense = dense_spectrum(system, state.position);
    const Spectrum spectrum =
        measure_spectrum(system, state.position, {.iterations = 200, .tolerance = 1e-9});
    const double largest = dense[dense.size() - 1];
    EXPECT_NEAR(spectrum.largest, largest, 1e-9 * largest);
    EXPECT_NEAR(spectrum.smallest, dense[0], 1e-2 * largest);
  }
}

TEST(Spectrum, LiesInsideTheTrueOneAndWithinItsResiduals) {
  Random random;
  for (const int iterations : {1, 2, 5, 15, 60}) {
    const ClothSystem system = unit_grid(7, 6, material_of(ratios[2]), {NamedPin::top_edge});
    const ClothState state = crumpled_state(system, 0.3, 0, random);
    const Eigen::VectorXd dense = dense_spectrum(system, state.position);
    const Spectrum spectrum = measure_spectrum(system, state.position, {iterations, 0});
    EXPECT_EQ(spectrum.iterations, iterations);
    const double slack = 1e-13 * dense.cwiseAbs().maxCoeff();
    EXPECT_LE(spectrum.largest, dense[dense.size() - 1] + slack);
    EXPECT_GE(spectrum.smallest, dense[0] - slack);
    EXPECT_LE((dense.array() - spectrum.largest).abs().minCoeff(), spectrum.largest_residual + slack);
    EXPECT_LE((dense.array() - spectrum.smallest).abs().minCoeff(), spectrum.smallest_residual + slack);
  }
}

TEST(Spectrum, OfFreeGridsIsTheTables) {
  for (const Ratio& r : ratios)
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const ClothSystem system = unit_grid(sizes[k], sizes[k], material_of(r));
      const double short_of_it = measure_spectrum(system, system.start).largest_frequency();
      const Spectrum spectrum =
          measure_spectrum(system, system.start, {.iterations = 150, .tolerance = 1e-6});
      EXPECT_NEAR(spectrum.largest_frequency(), r.free[k], printed)
          << sizes[k] << " " << r.shear << ", " << spectrum.iterations << " iterations";
      EXPECT_NEAR(short_of_it, r.free[k], 3e-4 * r.free[k]) << sizes[k] << " " << r.shear;
    }
}

struct Stretched {
  double stretch, first, second, smallest;  // 1:1:1 and 1:.5:.25, N = 20; 0: not printed
};

TEST(Spectrum, OfStretchedGridsIsTheTables) {
  for (const Stretched& s :
       {Stretched{0.7, 2.767, 2.261, -6.92}, Stretched{0.9, 3.051, 2.398, -1.79},
        Stretched{1, 3.160, 2.444, 0}, Stretched{1.1, 3.247, 2.481, 0}, Stretched{1.5, 3.469, 2.578, 0},
        Stretched{2, 3.613, 2.666, 0}, Stretched{5, 3.861, 2.867, 0}})
    for (const bool first : {true, false}) {
      const ClothSystem system = unit_grid(20, 20, material_of(ratios[first ? 0 : 2]));
      Vec3Field position = system.start;
      for (double& x : position.flat()) x *= s.stretch;
      const Spectrum spectrum = measure_spectrum(system, position);
      EXPECT_NEAR(spectrum.largest_frequency(), first ? s.first : s.second, 0.51e-3) << s.stretch;
      if (first && s.smallest < 0) {
        EXPECT_NEAR(spectrum.smallest, s.smallest, 0.51e-2) << s.stretch;
        EXPECT_NEAR(std::sqrt(std::max(0.0, -spectrum.smallest)), std::sqrt(-s.smallest), 0.51e-2);
      }
      if (s.stretch >= 1) {
        EXPECT_LT(std::sqrt(std::max(0.0, -spectrum.smallest)), 1e-6);
      }
    }
}

TEST(Spectrum, OfAChainIsThatOfItsModes) {
  // Two rows joined by nothing but structural springs, the lower row and the rest of the frame pinned: a
  // chain.
  constexpr int n = 12;
  std::vector<Pin> pins{NamedPin::bottom_edge, PinnedParticle{0, 0}, PinnedParticle{0, n + 1}};
  ClothSystem system = unit_grid(2, n + 2, only(SpringFamily::structural, 7), pins);
  std::erase_if(system.springs.blocks(), [](const SpringBlock& block) { return block.run.offset != 1; });
  constexpr double stretch = 1.3;
  Vec3Field position = system.start;
  for (double& x : position.flat()) x *= stretch;
  const Eigen::VectorXd dense = dense_spectrum(system, position);
  const Spectrum spectrum = measure_spectrum(system, position, {.iterations = 60, .tolerance = 0});
  const double angle = std::numbers::pi / (2 * (n + 1));
  const double fastest = 2 * std::sqrt(7.0) * std::sin(n * angle);
  const double tension = 7 * (stretch - 1);
  const double slowest = 2 * std::sqrt(tension / stretch) * std::sin(angle);  // across
  EXPECT_NEAR(spectrum.largest_frequency(), fastest, 1e-9 * fastest);
  EXPECT_NEAR(std::sqrt(spectrum.smallest), slowest, 1e-6 * slowest);
  EXPECT_NEAR(dense[0], slowest * slowest, 1e-12);
}

TEST(Spectrum, OfAFreeChainIsThatOfItsModes) {
  constexpr int n = 9;
  ClothSystem system = unit_grid(2, n, only(SpringFamily::structural, 3), {NamedPin::bottom_edge});
  std::erase_if(system.springs.blocks(), [](const SpringBlock& block) { return block.run.offset != 1; });
  const double fastest = 2 * std::sqrt(3.0) * std::sin((n - 1) * std::numbers::pi / (2 * n));
  EXPECT_NEAR(measure_spectrum(system, system.start).largest_frequency(), fastest, 1e-6);
}

TEST(Spectrum, IsBelowTheGuaranteedBoundForEveryCrumpledState) {
  Random random;
  for (const Ratio& r : ratios)
    for (const double deviation : {0.05, 0.3, 1.0, 5.0})
      for (const bool pinned : {false, true}) {
        std::vector<Pin> pins;
        if (pinned) pins = {NamedPin::top_edge, PinnedParticle{5, 5}};
        const ClothSystem system = unit_grid(12, 9, material_of(r), pins);
        const ClothState state = crumpled_state(system, deviation, 0, random);
        const double frequency = measure_spectrum(system, state.position).largest_frequency();
        EXPECT_LE(frequency, guaranteed_frequency(system)) << deviation;
        EXPECT_GE(frequency, 0.4 * guaranteed_frequency(system)) << deviation;
      }
}

TEST(Spectrum, IsTheSameToTheBit) {
  const ClothSystem system = unit_grid(11, 7, material_of(ratios[0]));
  const Spectrum once = measure_spectrum(system, system.start),
                 again = measure_spectrum(system, system.start);
  EXPECT_EQ(once.largest, again.largest);
  EXPECT_EQ(once.smallest, again.smallest);
}

TEST(Spectrum, OfWhatCannotMoveOrHasNoSpringsIsZero) {
  const ClothSystem loose = unit_grid(4, 4, {});
  EXPECT_EQ(measure_spectrum(loose, loose.start).largest, 0);
  EXPECT_EQ(guaranteed_frequency(loose), 0);
  const ClothSystem held =
      unit_grid(2, 4, material_of(ratios[0]), {NamedPin::top_edge, NamedPin::bottom_edge});
  EXPECT_EQ(measure_spectrum(held, held.start).largest, 0);
  EXPECT_EQ(guaranteed_frequency(held), 0);
}

TEST(Spectrum, OfCollapsedParticlesIsFiniteAndBelowTheBound) {
  const ClothSystem system = unit_grid(5, 5, material_of(ratios[0]));
  const Vec3Field collapsed(static_cast<std::size_t>(system.size()));  // every spring of length 0
  const Spectrum spectrum = measure_spectrum(system, collapsed);
  EXPECT_GT(spectrum.largest, 0);
  EXPECT_LE(spectrum.largest_frequency(), guaranteed_frequency(system));
}

/// The largest eigenvalue of the graph Laplacian, each spring k in every direction, by its dense matrix.
double dense_bound(const ClothSystem& system) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(system.size(), system.size());
  const auto scale = [&](int i) { return std::sqrt(system.inverse_mass[static_cast<std::size_t>(i)]); };
  for (const SpringRun& run : system.springs)
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int j = i + run.offset;
      matrix(i, i) += run.stiffness * scale(i) * scale(i),
          matrix(j, j) += run.stiffness * scale(j) * scale(j);
      matrix(i, j) -= run.stiffness * scale(i) * scale(j),
          matrix(j, i) -= run.stiffness * scale(i) * scale(j);
    }
  return std::sqrt(symmetric_values(matrix).maxCoeff());
}

TEST(GuaranteedFrequency, OfASystemIsThatOfItsGraphLaplacian) {
  Random random;
  for (const Ratio& r : ratios)
    for (const int size : {2, 3, 7, 19})
      for (const bool uneven : {false, true}) {
        ClothSystem system = unit_grid(size, size + 1, material_of(r), {NamedPin::top_left});
        if (uneven)
          for (std::size_t i = 0; i < system.mass.size(); ++i) {
            if (system.pinned[i]) continue;
            system.mass[i] = std::pow(10, random.uniform(-2, 1));
            system.inverse_mass[i] = 1 / system.mass[i];
          }
        const double dense = dense_bound(system);
        EXPECT_GE(guaranteed_frequency(system), dense * (1 - 1e-12)) << size;
        EXPECT_LE(guaranteed_frequency(system), dense * (1 + 1e-3)) << size;
      }
}

TEST(GuaranteedFrequency, OfAGridStaysBelowThatOfTheSheetAndComesNear) {
  for (const Ratio& r : ratios)
    for (const int size : {7, 60}) {
      ClothSheet sheet = bare_sheet(size, size, 1, 1).cloth;
      const double bound = guaranteed_frequency(sheet, material_of(r));
      const double free = guaranteed_frequency(make_grid(sheet, material_of(r)));
      EXPECT_LE(free, bound * (1 + 1e-3));
      if (size > 7) {
        EXPECT_GE(free, 0.99 * bound);
      }
      sheet.pins = {NamedPin::top_edge};
      EXPECT_LE(guaranteed_frequency(make_grid(sheet, material_of(r))), free * (1 + 1e-3));
    }
}

TEST(GuaranteedFrequency, CountsSpringsToPinsOnce) {
  // One free particle between pins: every spring is k alone, and the bound is attained.
  const ClothSystem system =
      unit_grid(3, 3, only(SpringFamily::structural, 2),
                {NamedPin::top_edge, NamedPin::bottom_edge, NamedPin::left_edge, NamedPin::right_edge});
  EXPECT_DOUBLE_EQ(guaranteed_frequency(system), std::sqrt(4 * 2.0));
}

/// A tridiagonal matrix of twos and ones has vectors of sines.
TEST(RitzExtremes, HaveTheResidualsOfTheirVectors) {
  for (const int n : {1, 2, 3, 10, 57, 160}) {
    const std::vector<double> twos(std::size_t(n), 2.0), ones(std::size_t(n) - 1, 1.0);
    const Spectrum found = ritz_extremes(twos, ones, 3);
    const double angle = std::numbers::pi / (n + 1);
    const double last = std::sqrt(2.0 / (n + 1)) * std::sin(angle);
    EXPECT_NEAR(found.largest, 2 + 2 * std::cos(angle), 1e-13);
    EXPECT_NEAR(found.smallest, 2 - 2 * std::cos(angle), 1e-13);
    EXPECT_NEAR(found.largest_residual, 3 * last, 1e-9 * last) << n;
    EXPECT_NEAR(found.smallest_residual, 3 * last, 1e-9 * last) << n;
  }
}

/// Of a value that has converged the vector falls from entry to entry by r, b (1/r + r) = value.
TEST(RitzExtremes, HaveAResidualThatIsRightHoweverSmall) {
  const double first = 10, b = 0.5;
  for (const int n : {5, 10, 20, 40}) {
    std::vector<double> diagonal(std::size_t(n), 0.0);
    diagonal[0] = first;
    const Spectrum found = ritz_extremes(diagonal, std::vector<double>(std::size_t(n) - 1, b), 1);
    const double root = std::sqrt(found.largest * found.largest - 4 * b * b);
    const double falling = (found.largest - root) / (2 * b);
    // The n + 1st entry is 0, so that a growing part is there too: v_k = r^k - r^(2 n + 2 - k).
    double square = 0;
    const auto entry = [&](int k) { return std::pow(falling, k) - std::pow(falling, 2 * n + 2 - k); };
    for (int k = 1; k <= n; ++k) square += entry(k) * entry(k);
    const double last = entry(n) / std::sqrt(square);
    EXPECT_NEAR(found.largest_residual, last, 1e-6 * last) << n;
  }
}

}  // namespace
}  // namespace cloth::test::spectrum_test
