#include "geometry/exact_signs.h"

#include <array>
#include <cmath>

namespace cloth {
namespace {

constexpr double half_ulp = 0x1p-53;

int sign_of(double value) {
  return (value > 0) - (value < 0);
}

/// A sum of at most N doubles that do not overlap, the smallest first, none of them 0.
template <std::size_t N>
class Expansion {
 public:
  void append(double part) {
    if (part != 0) parts_[size_++] = part;
  }
  std::size_t size() const { return size_; }
  double operator[](std::size_t k) const { return parts_[k]; }
  /// The largest part is larger than all others together.
  int sign() const { return size_ == 0 ? 0 : sign_of(parts_[size_ - 1]); }
  Expansion operator-() const {
    Expansion negative = *this;
    for (std::size_t k = 0; k < size_; ++k) negative.parts_[k] = -parts_[k];
    return negative;
  }

 private:
  std::array<double, N> parts_;
  std::size_t size_ = 0;
};

/// sum + error is exact.
struct Rounded {
  double sum, error;
};

/// TWO-SUM (Knuth).
Rounded two_sum(double a, double b) {
  const double sum = a + b, b_taken = sum - a, a_taken = sum - b_taken;
  return {sum, (a - a_taken) + (b - b_taken)};
}

Rounded two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

Expansion<2> difference(double a, double b) {
  const Rounded rounded = two_sum(a, -b);
  Expansion<2> result;
  result.append(rounded.error);
  result.append(rounded.sum);
  return result;
}

/// FAST-EXPANSION-SUM: the parts of both, the smallest first, are added up one after the other.
template <std::size_t M, std::size_t N>
Expansion<M + N> operator+(const Expansion<M>& a, const Expansion<N>& b) {
  Expansion<M + N> result;
  std::size_t i = 0, j = 0;
  const auto next = [&] {
    const bool takes_a = j == b.size() || (i < a.size() && std::abs(a[i]) < std::abs(b[j]));
    return takes_a ? a[i++] : b[j++];
  };
  if (a.size() + b.size() == 0) return result;
  double sum = next();
  while (i < a.size() || j < b.size()) {
    const Rounded rounded = two_sum(sum, next());
    result.append(rounded.error);
    sum = rounded.sum;
  }
  result.append(sum);
  return result;
}

/// SCALE-EXPANSION.
template <std::size_t N>
Expansion<2 * N> operator*(const Expansion<N>& a, double factor) {
  Expansion<2 * N> result;
  if (a.size() == 0) return result;
  Rounded total = two_product(a[0], factor);
  result.append(total.error);
  for (std::size_t k = 1; k < a.size(); ++k) {
    const Rounded product = two_product(a[k], factor);
    const Rounded low = two_sum(total.sum, product.error);
    result.append(low.error);
    total = two_sum(product.sum, low.sum);
    result.append(total.error);
  }
  result.append(total.sum);
  return result;
}

template <std::size_t N>
Expansion<4 * N> operator*(const Expansion<N>& a, const Expansion<2>& b) {
  const double low = b.size() > 1 ? b[0] : 0, high = b.size() > 0 ? b[b.size() - 1] : 0;
  return a * low + a * high;
}

using Difference3 = std::array<Expansion<2>, 3>;

Difference3 difference(const Vec3& a, const Vec3& b) {
  return {difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z())};
}

Expansion<16> minor_of(const Difference3& u, const Difference3& v, std::size_t i, std::size_t j) {
  return u[i] * v[j] + -(u[j] * v[i]);
}

/// (b - a) x (c - a) . (point - a).
int exact_side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const Difference3 u = difference(b, a), v = difference(c, a), w = difference(point, a);
  return (minor_of(u, v, 1, 2) * w[0] + minor_of(u, v, 2, 0) * w[1] + minor_of(u, v, 0, 1) * w[2]).sign();
}

}  // namespace

/// The bounds of the errors of both determinants are Shewchuk's o3derrboundA and ccwerrboundA.
int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point) {
  const Vec3 u = b - a, v = c - a, w = point - a;
  const double yz = u.y() * v.z(), zy = u.z() * v.y(), zx = u.z() * v.x(), xz = u.x() * v.z(),
               xy = u.x() * v.y(), yx = u.y() * v.x();
  const double determinant = w.x() * (yz - zy) + w.y() * (zx - xz) + w.z() * (xy - yx);
  const double size = std::abs(w.x()) * (std::abs(yz) + std::abs(zy)) +
                      std::abs(w.y()) * (std::abs(zx) + std::abs(xz)) +
                      std::abs(w.z()) * (std::abs(xy) + std::abs(yx));
  if (size == 0) return 0;
  constexpr double bound = (7 + 56 * half_ulp) * half_ulp;
  return std::abs(determinant) > bound * size ? sign_of(determinant) : exact_side_of_plane(a, b, c, point);
}

int turn_around(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double left = (b[x] - a[x]) * (c[y] - a[y]), right = (b[y] - a[y]) * (c[x] - a[x]);
  const double size = std::abs(left) + std::abs(right);
  if (size == 0) return 0;
  constexpr double bound = (3 + 16 * half_ulp) * half_ulp;
  if (std::abs(left - right) > bound * size) return sign_of(left - right);
  return (difference(b[x], a[x]) * difference(c[y], a[y]) +
          -(difference(b[y], a[y]) * difference(c[x], a[x])))
      .sign();
}

}  // namespace cloth
