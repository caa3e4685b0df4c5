#include "support/exact_sign.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace cloth::test {
namespace {

int sign(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// A number as a sum of doubles that do not overlap, the smallest first.
class Expansion {
 public:
  Expansion() = default;

  static Expansion difference(double a, double b) {
    Expansion result;
    result.add(a);
    result.add(-b);
    return result;
  }

  /// Shewchuk's GROW-EXPANSION.
  void add(double value) {
    std::vector<double> sum;
    sum.reserve(parts_.size() + 1);
    for (const double part : parts_) {
      const double total = value + part;  // two-sum (Knuth): total + error is exact
      const double part_taken = total - value, value_taken = total - part_taken;
      const double error = (value - value_taken) + (part - part_taken);
      if (error != 0) sum.push_back(error);
      value = total;
    }
    if (value != 0) sum.push_back(value);
    parts_ = std::move(sum);
  }

  Expansion operator+(const Expansion& other) const {
    Expansion sum = *this;
    for (const double part : other.parts_) sum.add(part);
    return sum;
  }

  Expansion operator-() const {
    Expansion result = *this;
    for (double& part : result.parts_) part = -part;
    return result;
  }

  Expansion operator*(const Expansion& other) const {
    Expansion result;
    for (const double a : parts_) {
      for (const double b : other.parts_) {
        const double product = a * b;
        result.add(std::fma(a, b, -product));
        result.add(product);
      }
    }
    return result;
  }

  int sign() const { return parts_.empty() ? 0 : test::sign(parts_.back()); }

 private:
  std::vector<double> parts_;
};

using Expansion3 = std::array<Expansion, 3>;

Expansion3 difference(const Vec3& a, const Vec3& b) {
  return {Expansion::difference(a.x(), b.x()), Expansion::difference(a.y(), b.y()),
          Expansion::difference(a.z(), b.z())};
}

Expansion minor(const Expansion3& u, const Expansion3& v, std::size_t i, std::size_t j) {
  return u[i] * v[j] + -(u[j] * v[i]);
}

/// The sign where the determinant exceeds its error bound (Shewchuk's o3derrboundA) or has no term at all.
template <class Real>
std::optional<int> filtered_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  constexpr Real half_ulp = std::numeric_limits<Real>::epsilon() / 2;
  using Real3 = Eigen::Matrix<Real, 3, 1>;
  const Real3 p = point.cast<Real>(), u = a.cast<Real>() - p, v = b.cast<Real>() - p, w = c.cast<Real>() - p;
  const Real xy = v.x() * w.y(), yx = w.x() * v.y();
  const Real yz = w.x() * u.y(), zy = u.x() * w.y();
  const Real zx = u.x() * v.y(), xz = v.x() * u.y();
  const Real determinant = u.z() * (xy - yx) + v.z() * (yz - zy) + w.z() * (zx - xz);
  const Real permanent = (std::abs(xy) + std::abs(yx)) * std::abs(u.z()) +
                         (std::abs(yz) + std::abs(zy)) * std::abs(v.z()) +
                         (std::abs(zx) + std::abs(xz)) * std::abs(w.z());
  if (permanent == 0) return 0;
  const Real bound = (7 + 56 * half_ulp) * half_ulp * permanent;
  if (determinant > bound) return -1;
  if (-determinant > bound) return 1;
  return std::nullopt;
}

}  // namespace

int side_of_plane_by_expansions(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const Expansion3 u = difference(b, a), v = difference(c, a), w = difference(point, a);
  return (w[0] * minor(u, v, 1, 2) + w[1] * minor(u, v, 2, 0) + w[2] * minor(u, v, 0, 1)).sign();
}

int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  std::optional<int> side = filtered_side<double>(a, b, c, point);
  if (!side) side = filtered_side<long double>(a, b, c, point);
  return side ? *side : side_of_plane_by_expansions(a, b, c, point);
}

int turn(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double left = (a[x] - c[x]) * (b[y] - c[y]), right = (a[y] - c[y]) * (b[x] - c[x]);
  const double determinant = left - right;
  if (left == 0 && right == 0) return 0;
  constexpr double half_ulp = 0x1p-53;
  const double bound = (3 + 16 * half_ulp) * half_ulp * (std::abs(left) + std::abs(right));  // ccwerrboundA
  if (determinant > bound || -determinant > bound) return sign(determinant);
  const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
  return minor(difference(a, c), difference(b, c), i, j).sign();
}

int side_of_half_space(const Vec3& normal, const Vec3& origin, const Vec3& point) {
  const Expansion3 from_origin = difference(point, origin);
  Expansion sum;
  for (std::size_t k = 0; k < 3; ++k) {
    Expansion component;
    component.add(normal[static_cast<Eigen::Index>(k)]);
    sum = sum + component * from_origin[k];
  }
  return sum.sign();
}

}  // namespace cloth::test
