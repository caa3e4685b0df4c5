#include "measure/spectrum.h"

#include <algorithm>
#include <cmath>

#include "geometry/dense_decompositions.h"
#include "geometry/split_mix.h"
#include "kernels/mesh_products.h"

namespace cloth {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// u -> M^-1/2 K M^-1/2 u, symmetric, with the eigenvalues of M^-1 K. Vectors lie as Vec3Field does: x, y, z
/// runs.
class ScaledStiffness {
 public:
  ScaledStiffness(const ClothSystem& system, const Vec3Field& position)
      : system_(system), position_(position), scale_(3 * Index(system.size())) {
    const auto n = static_cast<std::size_t>(system.size());
    for (std::size_t i = 0; i < 3 * n; ++i)
      scale_[static_cast<Index>(i)] = std::sqrt(system.inverse_mass[i % n]);
  }

  const VectorXd& scale() const { return scale_; }  ///< 1/sqrt(kg); 0 where pinned

  VectorXd operator*(const VectorXd& vector) const {
    const VectorXd u = scale_.cwiseProduct(vector);
    VectorXd product = VectorXd::Zero(u.size());
    for_each_spring(system_.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
      add_spring(run, i, j, u, product);
    });
    add_bending(u, product);
    add_membrane(u, product);
    return scale_.cwiseProduct(product);
  }

 private:
  /// k (n n^T + (1 - L/|d|) (I - n n^T)) (u_i - u_j) on i, its opposite on j
  void add_spring(const SpringRun& run, std::size_t i, std::size_t j, const VectorXd& u,
                  VectorXd& product) const {
    const Vec3 d = position_[j] - position_[i];
    const double length = d.norm();
    const std::size_t n = position_.size();
    const Vec3 difference(u[i] - u[j], u[n + i] - u[n + j], u[2 * n + i] - u[2 * n + j]);
    Vec3 force = run.stiffness * difference;
    if (length > 0) {
      const Vec3 across = difference - d * (d.dot(difference) / (length * length));
      force -= run.stiffness * run.rest_length / length * across;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      product[axis * n + i] += force[axis];
      product[axis * n + j] -= force[axis];
    }
  }

  /// Sliders as if each were as stiff in every direction, and none yielded.
  void add_bending(const VectorXd& u, VectorXd& product) const {
    const auto n = position_.size();
    const auto add = [&](std::size_t i, std::size_t j, double stiffness) {
      for (std::size_t k = 0; k < 3 * n; k += n) {
        const double force = stiffness * (u[Index(k + i)] - u[Index(k + j)]);
        product[Index(k + i)] += force;
        product[Index(k + j)] -= force;
      }
    };
    for_each_bending_pair(system_.bending_rows, system_.bending, add);
    for_each_slider_pair(system_.sliders, add);
  }

  /// J^T K J u, and the tension of every edge in every direction.
  void add_membrane(const VectorXd& u, VectorXd& product) const {
    if (system_.membrane.empty()) return;
    Vec3Field from(position_.size()), to(position_.size());
    std::copy(u.begin(), u.end(), from.flat().begin());
    add_membrane_product(system_.membrane, 1, position_, from, to);
    for (const MembraneTriangle& t : system_.membrane) {
      const std::array<double, 3> tension = times_k(t, square_changes(t, position_));
      for (std::size_t e = 0; e < 3; ++e) {
        const Vec3 force = 2 * tension[e] * edge_of(t, e, from);
        to.add(cloth::at(t.corner[e]), -force);
        to.add(cloth::at(t.corner[(e + 1) % 3]), force);
      }
    }
    for (std::size_t k = 0; k < to.flat().size(); ++k) product[Index(k)] += to.flat()[k];
  }

  const ClothSystem& system_;
  const Vec3Field& position_;
  VectorXd scale_;
};

/// Numbers in [-1, 1] that are the same everywhere, 0 on pins.
VectorXd start_vector(const VectorXd& scale) {
  SplitMix random(0);
  VectorXd start(scale.size());
  for (double& value : start) value = random.number();
  return (scale.array() > 0).select(start, 0);
}

/// The last component of the eigenvector of length one, in modulus, of the tridiagonal matrix with this
/// diagonal and these numbers beside it. From the entry at which elimination from above and elimination from
/// below leave least, which is accurate however small the last component is (Fernando 1997).
double last_component(const VectorXd& diagonal, const VectorXd& beside, double eigenvalue) {
  const Index n = diagonal.size();
  const double tiny = 1e-300 + 1e-18 * std::abs(eigenvalue);  // in place of a pivot that is 0
  const auto pivot = [&](double value) { return std::abs(value) < tiny ? tiny : value; };
  const VectorXd shifted = diagonal.array() - eigenvalue;
  VectorXd above = shifted, below = shifted;  // pivots of elimination from above and from below
  for (Index i = 1; i < n; ++i) above[i] -= beside[i - 1] * beside[i - 1] / pivot(above[i - 1]);
  for (Index i = n - 1; i-- > 0;) below[i] -= beside[i] * beside[i] / pivot(below[i + 1]);
  Index twist = 0;
  (above + below - shifted).cwiseAbs().minCoeff(&twist);
  double square = 1, component = 1;
  for (Index i = twist; i-- > 0;) {
    component *= beside[i] / pivot(above[i]);
    square += component * component;
  }
  component = 1;
  for (Index i = twist + 1; i < n; ++i) {
    component *= beside[i - 1] / pivot(below[i]);
    square += component * component;
  }
  return std::abs(component) / std::sqrt(square);
}

}  // namespace

Spectrum ritz_extremes(const std::vector<double>& diagonal, const std::vector<double>& coupling,
                       double next) {
  const auto size = static_cast<Index>(diagonal.size());
  const VectorXd main = VectorXd::Map(diagonal.data(), size),
                 beside = VectorXd::Map(coupling.data(), size - 1);
  const VectorXd values = tridiagonal_values(main, beside);
  Spectrum spectrum;
  spectrum.largest = values[size - 1];
  spectrum.smallest = values[0];
  spectrum.largest_residual = next * last_component(main, beside, spectrum.largest);
  spectrum.smallest_residual = next * last_component(main, beside, spectrum.smallest);
  spectrum.iterations = static_cast<int>(size);
  return spectrum;
}

double Spectrum::largest_frequency() const {
  return std::sqrt(std::max(0.0, largest));
}

Spectrum measure_spectrum(const ClothSystem& system, const Vec3Field& position, const LanczosLimits& limits) {
  constexpr double exhausted = 1e-12;  // a coupling this small, relative: the vectors span all there is
  const ScaledStiffness stiffness(system, position);
  const VectorXd start = start_vector(stiffness.scale());
  const auto free = static_cast<Index>((stiffness.scale().array() > 0).count());
  const Index most = std::min<Index>(limits.iterations, free);
  if (most == 0) return {};

  MatrixXd basis(start.size(), most);
  basis.col(0) = start.normalized();
  std::vector<double> diagonal, coupling;
  Spectrum spectrum;
  for (Index k = 0; k < most; ++k) {
    VectorXd next = stiffness * basis.col(k);
    diagonal.push_back(basis.col(k).dot(next));
    const auto so_far = basis.leftCols(k + 1);
    for (int pass = 0; pass < 2; ++pass) next -= so_far * (so_far.transpose() * next).eval();
    const double length = next.norm();
    spectrum = ritz_extremes(diagonal, coupling, length);
    const double scale = std::max(spectrum.largest, -spectrum.smallest);
    if (length <= exhausted * scale || spectrum.largest_residual <= limits.tolerance * spectrum.largest)
      break;
    if (k + 1 == most) break;
    coupling.push_back(length);
    basis.col(k + 1) = next / length;
  }
  return spectrum;
}

}  // namespace cloth
