#include "measure/stability_limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "cloth/grid.h"
#include "geometry/dense_decompositions.h"
#include "integrators/registry.h"
#include "measure/amplification.h"
#include "measure/spectrum.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::stability_limit_test {
namespace {

constexpr std::array<double, 7> ratios{0, 0.01, 0.1, 0.5, 1, 2, 5};  // damping ratios zeta

/// Largest omega h of every method at each of the ratios.
const std::map<std::string, std::array<double, 7>> table{
    {"explicit-euler", {0, 0.02, 0.2, 1, 2, 0.5359, 0.2020}},
    {"semi-implicit-euler", {2, 1.9801, 1.8100, 1.2361, 0.8284, 0.4721, 0.1980}},
    {"verlet", {2, 2, 2, 2, 2, 2, 2}},
    {"rk4", {2.8284, 2.8486, 2.9509, 2.6225, 2.7853, 0.7463, 0.2814}},
    {"dormand-prince", {0.9972, 1.8721, 2.6814, 3.3990, 3.3066, 0.8860, 0.3340}}};

const std::array<std::string, 6> implicit_methods{
    "implicit-euler", "implicit-midpoint", "bdf2", "projective", "xpbd", "vbd"};

TEST(OscillatorLimit, IsTheTablesForEveryMethodAndDampingRatio) {
  for (const auto& [method, limits] : table)
    for (std::size_t k = 0; k < ratios.size(); ++k)
      EXPECT_NEAR(oscillator_limit(method, 1, 2 * ratios[k]), limits[k], 0.51e-4)
          << method << " " << ratios[k];
}

TEST(OscillatorLimit, ScalesWithTheFrequency) {
  for (const auto& [method, limits] : table)
    for (const double ratio : {0.1, 2.0}) {
      const double unit = oscillator_limit(method, 1, 2 * ratio);
      EXPECT_NEAR(1000 * oscillator_limit(method, 1000, 2000 * ratio), unit, 1e-9 * unit) << method;
    }
}

/// The spectral radius of one step of each method for x'' = -x - 2 zeta x', as matrices written out here.
Eigen::Matrix2d step_matrix(const std::string& method, double h, double zeta) {
  Eigen::Matrix2d slope;
  slope << 0, 1, -1, -2 * zeta;
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity(), z = h * slope;
  if (method == "explicit-euler") return one + z;
  const Eigen::Matrix2d fourth = one + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
  if (method == "rk4") return fourth;
  if (method == "dormand-prince") {
    const Eigen::Matrix2d fifth = z * z * z * z * z;
    return fourth + fifth / 120 + fifth * z / 600;
  }
  Eigen::Matrix2d matrix;
  if (method == "semi-implicit-euler") {
    matrix.row(1) << -h, 1 - 2 * zeta * h;
    matrix.row(0) = Eigen::RowVector2d(1, 0) + h * matrix.row(1);
    return matrix;
  }
  const Eigen::RowVector2d half(-h / 2, 1 - zeta * h);  // verlet: v_half of (x, v)
  matrix.row(0) = Eigen::RowVector2d(1, 0) + h * half;
  matrix.row(1) = (half - h / 2 * matrix.row(0)) / (1 + zeta * h);
  return matrix;
}

double spectral_radius(const Eigen::Matrix2d& m) {
  const double half_trace = 0.5 * m.trace(), determinant = m.determinant();
  const double discriminant = half_trace * half_trace - determinant;
  return discriminant < 0 ? std::sqrt(determinant) : std::abs(half_trace) + std::sqrt(discriminant);
}

TEST(OscillatorLimit, IsWhereTheSpectralRadiusPassesOne) {
  for (const auto& [method, limits] : table)
    for (const double zeta : ratios) {
      const double limit = oscillator_limit(method, 1, 2 * zeta);
      if (limit == 0) continue;
      EXPECT_LE(spectral_radius(step_matrix(method, 0.999 * limit, zeta)), 1 + 1e-12) << method << zeta;
      EXPECT_GT(spectral_radius(step_matrix(method, 1.001 * limit, zeta)), 1 + 1e-9) << method << zeta;
    }
}

TEST(OscillatorLimit, IsWhereTheScanMeetsTheClosedForm) {
  for (const auto& [method, limits] : table)
    for (const double zeta : {0.0, 0.003, 0.01, 0.1, 0.7, 1.0, 1.3, 5.0}) {
      const double closed = oscillator_limit(method, 3, 6 * zeta);
      // Growth as (omega h)^2 / 2 (explicit Euler undamped) passes the scan's threshold at some 1e-7.
      EXPECT_NEAR(scanned_limit(method, 3, 6 * zeta), closed, 1e-7) << method << " " << zeta;
    }
}

TEST(OscillatorLimit, OfAScanThatEndsEarlyIsTheSameUpToItsEnd) {
  for (const char* method : {"rk4", "dormand-prince"})
    for (const double zeta : {0.0, 0.01, 0.7, 1.3, 5.0}) {
      const double limit = oscillator_limit(method, 3, 6 * zeta);
      const auto scanned = [&](double end) { return oscillator_limit(method, 3, 6 * zeta, end * limit); };
      for (const double end : {1e-9, 0.1, 0.5}) EXPECT_EQ(scanned(end), infinity) << method << zeta << end;
      EXPECT_GE(scanned(0.99), 0.99 * limit) << method << zeta;
      for (const double end : {1.0, 1.01, 2.0, 1e3}) EXPECT_EQ(scanned(end), limit) << method << zeta << end;
    }
}

TEST(OscillatorLimit, OfRungeKuttaMethodsHasClosedForms) {
  EXPECT_NEAR(oscillator_limit("rk4", 1, 0), 2 * std::numbers::sqrt2, 1e-9);
  for (const double zeta : {1.0, 1.5, 2.0, 5.0}) {
    const double fastest = zeta + std::sqrt(zeta * zeta - 1);
    EXPECT_NEAR(oscillator_limit("rk4", 1, 2 * zeta) * fastest, 2.78529, 0.51e-5) << zeta;
    EXPECT_NEAR(oscillator_limit("dormand-prince", 1, 2 * zeta) * fastest, 3.30657, 0.51e-5) << zeta;
  }
}

TEST(OscillatorLimit, OfDormandPrinceUndampedIsTheRootOfItsGrowth) {
  const double y = oscillator_limit("dormand-prince", 1, 0);
  EXPECT_NEAR(-1 / 1800.0 + y * y / 1600 - std::pow(y, 4) / 14400 + std::pow(y, 6) / 360000, 0, 1e-11);
}

TEST(ImplicitMethods, HaveNoLimit) {
  for (const std::string& method : implicit_methods) {
    EXPECT_TRUE(stable_at_every_step(method)) << method;
    for (const double ratio : ratios) {
      EXPECT_EQ(oscillator_limit(method, 1, 2 * ratio), infinity) << method;
      EXPECT_EQ(scanned_limit(method, 1, 2 * ratio), infinity) << method << " " << ratio;
    }
    EXPECT_EQ(stable_step(method, smooth_scene(6, 6)), infinity) << method;
    EXPECT_EQ(guaranteed_step(method, smooth_scene(6, 6)), infinity) << method;
  }
  for (const auto& [method, limits] : table) EXPECT_FALSE(stable_at_every_step(method)) << method;
}

TEST(GuaranteedStep, IsShorterByTheRatioOfTheFrequencies) {
  Scene scene;
  scene.cloth = bare_sheet(10, 10, 1, 1).cloth;
  scene.springs = SpringMaterial{.structural = 1, .shear = 1, .flexion = 1, .damping = 0};
  scene.integrator.tolerance = 0;  // no error control, which would need no limit
  EXPECT_NEAR(guaranteed_step("verlet", scene).value(), 2 / std::sqrt(49.0 / 3), 1e-12);  // at c = d = -1/6
  EXPECT_NEAR(stable_step("verlet", scene).value(), 0.6285, 0.51e-4);
  EXPECT_NEAR(stable_step("rk4", scene).value(), 0.8889, 0.51e-4);
  EXPECT_NEAR(stable_step("dormand-prince", scene).value(), 0.3134, 0.51e-4);
  scene.springs->damping = 0.3;
  scene.damping = 0.1;
  for (const auto& [method, limits] : table)
    EXPECT_LT(guaranteed_step(method, scene).value(), stable_step(method, scene).value() * (1 + 1e-12))
        << method;
}

TEST(StableStep, IsNoneForExplicitEulerWithoutDampingOfEveryMotion) {
  Scene scene = smooth_scene(6, 6);
  EXPECT_TRUE(stable_step("explicit-euler", scene));
  scene.damping.reset();
  EXPECT_FALSE(stable_step("explicit-euler", scene));  // air damps the normal motion alone
  scene.springs->damping = 0.1;
  EXPECT_FALSE(stable_step("explicit-euler", scene));
}

TEST(StableStep, IsAnyLengthWhereNothingOscillates) {
  for (const auto& [method, limits] : table)
    EXPECT_EQ(stable_step(method, bare_sheet(5, 5)), infinity) << method;
}

TEST(StableStep, IsAnyLengthWhereErrorControlDividesTheStep) {
  const Scene scene = smooth_scene(6, 6);
  EXPECT_GT(scene.integrator.tolerance, 0);
  EXPECT_EQ(stable_step("dormand-prince", scene), infinity);
  EXPECT_EQ(guaranteed_step("dormand-prince", scene), infinity);
}

TEST(StableStep, HoldsForEverySlowerMotionToo) {
  const DampingRates rates{5, 80};
  for (const auto& [method, limits] : table) {
    const double limit = stable_step(method, 100, rates).value();
    for (double omega = 100; omega > 0.01; omega /= 1.07)
      for (double c = 5; c <= 80; c += 3)
        EXPECT_LE(spectral_radius(step_matrix(method, limit * omega, c / (2 * omega))), 1 + 2e-4)
            << method << " omega " << omega << " c " << c;
  }
}

struct Ratio {
  double structural, shear, flexion;
  double five, ten, infinite, guaranteed;  // omega sqrt(m/k_s)
};
constexpr std::array<Ratio, 5> frequencies{{{1, 1, 1, 2.8740, 3.0967, 3.1820, 4.0415},
                                            {1, 1, 0.1, 2.6473, 2.7823, 2.8284, 3.4641},
                                            {1, 0.5, 0.25, 2.3247, 2.4248, 2.4495, 3.0000},
                                            {1, 0.1, 0.01, 1.9878, 2.0701, 2.0976, 2.8284},
                                            {1, 0, 0, 1.9021, 1.9754, 2.0000, 2.8284}}};

SpringMaterial material_of(const Ratio& r) {
  return {.structural = r.structural, .shear = r.shear, .flexion = r.flexion, .damping = 0};
}

ClothSheet unit_sheet(int size) {  // mass 1 per particle, spacing 1
  return bare_sheet(size, size, 1, 1).cloth;
}

TEST(LargestFrequency, IsTheTablesForTheInfiniteGrid) {
  for (const Ratio& r : frequencies) {
    EXPECT_NEAR(largest_frequency(unit_sheet(20), material_of(r)), r.infinite, 0.51e-4);
    EXPECT_NEAR(guaranteed_frequency(unit_sheet(20), material_of(r)), r.guaranteed, 0.51e-4);
  }
}

TEST(LargestFrequency, OfFiniteGridsIsTheTablesAndStaysBelow) {
  for (const Ratio& r : frequencies)
    for (const auto& [size, expected] : {std::pair(5, r.five), std::pair(10, r.ten)}) {
      const ClothSystem system = make_grid(unit_sheet(size), material_of(r));
      const double frequency = largest_eigenfrequency(system, system.start);
      EXPECT_NEAR(frequency, expected, 0.51e-4);
      EXPECT_LE(frequency, largest_frequency(unit_sheet(size), material_of(r)));
    }
}

TEST(LargestFrequency, OfPinnedGridsStaysBelowTheClosedForm) {
  ClothSheet sheet = unit_sheet(8);
  sheet.pins = {NamedPin::top_edge, PinnedParticle{4, 4}};
  for (const Ratio& r : frequencies) {
    const ClothSystem system = make_grid(sheet, material_of(r));
    EXPECT_LE(largest_eigenfrequency(system, system.start), largest_frequency(sheet, material_of(r)));
  }
}

TEST(LargestFrequency, ScannedEqualsTheClosedForm) {
  Random random;
  ClothSheet almost_square = unit_sheet(10);
  almost_square.width *= 1 + 1e-9;  // square no longer, as far as the closed form is concerned
  for (int trial = 0; trial < 100; ++trial) {
    const auto stiffness = [&] {
      return random.integer(0, 3) == 0 ? 0.0 : std::pow(10, random.uniform(-2, 2));
    };
    const SpringMaterial material{
        .structural = 1, .shear = stiffness(), .flexion = stiffness(), .damping = 0};
    const double closed = largest_frequency(unit_sheet(10), material);
    EXPECT_NEAR(largest_frequency(almost_square, material), closed, 5e-6 * closed)
        << material.shear << " " << material.flexion;
  }
}

TEST(LargestFrequency, OfRectangularCellsBoundsTheFiniteGrid) {
  ClothSheet sheet = unit_sheet(10);
  sheet.width *= 2;
  for (const Ratio& r : frequencies) {
    const ClothSystem system = make_grid(sheet, material_of(r));
    const double finite = largest_eigenfrequency(system, system.start);
    const double infinite = largest_frequency(sheet, material_of(r));
    EXPECT_LE(finite, infinite);
    EXPECT_GE(finite, 0.93 * infinite);
  }
}

TEST(GuaranteedFrequency, BoundsEveryCrumpledConfiguration) {
  Random random;
  const ClothSheet sheet = unit_sheet(6);
  for (const Ratio& r : frequencies) {
    const ClothSystem system = make_grid(sheet, material_of(r));
    for (const double deviation : {0.05, 0.3, 1.0, 5.0}) {
      const ClothState state = crumpled_state(system, deviation, 0, random);
      EXPECT_LE(largest_eigenfrequency(system, state.position), guaranteed_frequency(sheet, material_of(r)));
    }
  }
}

SpringMaterial any_material(Random& random) {
  const auto stiffness = [&] {
    return random.integer(0, 3) == 0 ? 0.0 : std::pow(10, random.uniform(-2, 2));
  };
  return {.structural = 1, .shear = stiffness(), .flexion = stiffness(), .damping = 0};
}

TEST(GuaranteedFrequency, OfAGridIsTheMaximumOverAllWaves) {
  Random random;
  for (int trial = 0; trial < 50; ++trial) {
    const SpringMaterial m = any_material(random);
    double largest = 0;
    constexpr int waves = 200;
    for (int i = 0; i <= waves; ++i)
      for (int j = 0; j <= waves; ++j) {
        const double a = std::numbers::pi * i / waves, b = std::numbers::pi * j / waves;
        largest = std::max(largest, 2 * m.structural * (2 - std::cos(a) - std::cos(b)) +
                                        2 * m.shear * (2 - std::cos(a + b) - std::cos(a - b)) +
                                        2 * m.flexion * (2 - std::cos(2 * a) - std::cos(2 * b)));
      }
    const double closed = std::pow(guaranteed_frequency(unit_sheet(10), m), 2);
    EXPECT_LE(largest, closed * (1 + 1e-12)) << m.shear << " " << m.flexion;
    EXPECT_GE(largest, closed * (1 - 2e-3)) << m.shear << " " << m.flexion;
  }
}

TEST(GuaranteedFrequency, IsReachedByAClothStretchedWithoutEnd) {
  // 1000 times its rest length every spring is as stiff across as along it.
  for (const Ratio& r : frequencies) {
    const ClothSystem system = make_grid(unit_sheet(40), material_of(r));
    Vec3Field position = system.start;
    for (double& x : position.flat()) x *= 1000;
    const double found =
        measure_spectrum(system, position, {.iterations = 200, .tolerance = 1e-7}).largest_frequency();
    const double bound = guaranteed_frequency(unit_sheet(40), material_of(r));
    EXPECT_LE(found, bound);
    EXPECT_GE(found, 0.99 * bound) << r.shear << " " << r.flexion;
  }
}

TEST(GuaranteedStep, OfSemiImplicitEulerTakesSpringsAndDampersTogether) {
  Random random;
  for (int trial = 0; trial < 30; ++trial) {
    Scene scene = bare_sheet(8, 8, 1, 1);
    scene.springs = any_material(random);
    scene.springs->damping = std::pow(10, random.uniform(-2, 1));
    scene.damping = random.uniform(0, 0.3);
    const SpringMaterial& springs = *scene.springs;
    const auto weight = [&](double k) { return k > 0 ? springs.damping : 0.0; };
    const SpringMaterial dampers{weight(springs.structural), weight(springs.shear), weight(springs.flexion),
                                 0};
    const double most = *scene.damping + std::pow(guaranteed_frequency(scene.cloth, dampers), 2);
    const double h = guaranteed_step("semi-implicit-euler", scene).value();
    const double apart =
        oscillator_limit("semi-implicit-euler", guaranteed_frequency(scene.cloth, springs), most);
    EXPECT_GE(h, apart * (1 - 1e-12));
    const SpringMaterial both{h * h * springs.structural + 2 * h * weight(springs.structural),
                              h * h * springs.shear + 2 * h * weight(springs.shear),
                              h * h * springs.flexion + 2 * h * weight(springs.flexion), 0};
    EXPECT_NEAR(std::pow(guaranteed_frequency(scene.cloth, both), 2) + 2 * h * *scene.damping, 4, 1e-9);
  }
}

TEST(AHeldParticle, PassesNoFrequencyItWasAllowed) {
  Random random;
  for (int trial = 0; trial < 8; ++trial) {
    const SpringMaterial material = any_material(random);
    const double bound = guaranteed_frequency(unit_sheet(12), material);
    EXPECT_EQ(strongest_held_spring(unit_sheet(12), material, 0.99 * bound), 0);
    const double allowed = random.uniform(1.02, 1.4) * bound;
    const double held = strongest_held_spring(unit_sheet(12), material, allowed);
    EXPECT_GE(held, allowed * allowed - bound * bound);  // Weyl's inequality
    // The graph Laplacian by its dense matrix, one particle held.
    const ClothSystem system = make_grid(unit_sheet(12), material);
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(144, 144);
    for (const SpringRun& run : system.springs)
      for (int i = run.first; i < run.first + run.count; ++i) {
        const int j = i + run.offset;
        laplacian(i, i) += run.stiffness, laplacian(j, j) += run.stiffness;
        laplacian(i, j) -= run.stiffness, laplacian(j, i) -= run.stiffness;
      }
    for (const int particle : {0, 6, 66, 143}) {
      Eigen::MatrixXd with = laplacian;
      with(particle, particle) += held;
      const double largest = symmetric_values(with)[143];
      EXPECT_LE(std::sqrt(largest), allowed * (1 + 1e-6)) << material.shear << " " << material.flexion;
    }
  }
}

TEST(DampingRates, AreThoseOfTheSlowestAndTheFastestDamped) {
  Scene scene = bare_sheet(5, 5, 1, 0.5);
  EXPECT_EQ(damping_rates(scene).most, 0);
  scene.damping = 0.1;
  EXPECT_DOUBLE_EQ(damping_rates(scene).least, 0.2);
  EXPECT_DOUBLE_EQ(damping_rates(scene).most, 0.2);
  scene.air = Air{.drag = 0.3, .wind = Vec3::Zero(), .gust = std::nullopt};
  EXPECT_DOUBLE_EQ(damping_rates(scene).least, 0.2);
  EXPECT_DOUBLE_EQ(damping_rates(scene).most, 0.8);
}

TEST(DampingRates, OfSpringsBoundThoseOfTheGrid) {
  Scene scene = bare_sheet(8, 8, 1, 1);
  scene.springs = SpringMaterial{.structural = 3, .shear = 2, .flexion = 1, .damping = 0.7};
  ClothSystem dampers = make_grid(scene.cloth, {.structural = 0.7, .shear = 0.7, .flexion = 0.7});
  const double rate = std::pow(largest_eigenfrequency(dampers, dampers.start), 2);
  EXPECT_LE(rate, damping_rates(scene).most);
  EXPECT_GE(rate, 0.8 * damping_rates(scene).most);
}

TEST(ProvotStep, IsTooLongForAGrid) {  // 5.00, and 3.14 for structural springs alone
  Scene scene;
  scene.cloth = unit_sheet(10);
  scene.springs = material_of(frequencies[0]);
  EXPECT_NEAR(provot_step(scene) / *stable_step("semi-implicit-euler", scene), 5.00, 0.005);
  scene.springs = material_of(frequencies[4]);
  EXPECT_NEAR(provot_step(scene) / *stable_step("semi-implicit-euler", scene), std::numbers::pi, 1e-9);
}

TEST(StableStep, OfTheWorkedExampleIsThePrintedOne) {  // 1 m^2, N = 30, 0.2 kg, 1:.5:.1
  Scene scene = bare_sheet(30, 30, 1.0 / 29, 0.2 / 900);
  scene.springs = SpringMaterial{.structural = 500, .shear = 250, .flexion = 50, .damping = 0};
  EXPECT_NEAR(largest_frequency(scene.cloth, *scene.springs), 3674, 0.5);
  EXPECT_NEAR(*stable_step("verlet", scene), 0.544e-3, 0.5e-6);
  EXPECT_NEAR(*stable_step("rk4", scene), 0.770e-3, 0.5e-6);
  EXPECT_NEAR(provot_step(scene), 2.09e-3, 0.5e-5);
}

}  // namespace
}  // namespace cloth::test::stability_limit_test
