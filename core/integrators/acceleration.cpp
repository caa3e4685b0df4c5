#include "integrators/acceleration.h"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"

namespace cloth {
namespace {

double dot_of(const Vec3Field& a, const Vec3Field& b) {
  return active_kernels<VectorKernels>().dot(a.x(), b.x(), 3 * a.size());
}
void add_to(Vec3Field& to, double scale, const Vec3Field& from) {
  active_kernels<VectorKernels>().add_multiple(scale, from.x(), to.x(), 3 * to.size());
}
Vec3Field difference_of(const Vec3Field& a, const Vec3Field& b) {
  Vec3Field result = a;
  add_to(result, -1, b);
  return result;
}

class Chebyshev : public Acceleration {
 public:
  void restart() override { count_ = 0, radius_ = 0; }

  /// v_{k+1} = omega_{k+1} (v_k - e_k - v_{k-1}) + v_{k-1} (Wang 2015, Eqs. 13 and 18)
  bool propose(const Iterate& now, Vec3Field& next) override {
    next = now.v;
    add_to(next, -1, now.e);
    if (count_ == length) lengthen(now.merit);
    if (count_ == 0) first_merit_ = now.merit;
    if (radius_ == 0 && count_ == plain) {
      radius_ = std::min(largest_radius, std::pow(now.merit / first_merit_, 0.5 / plain));
      count_ = 0, first_merit_ = now.merit;
    }
    const bool accelerates = radius_ > 0 && count_ > 0;
    if (accelerates) {
      const double square = radius_ * radius_;
      omega_ = count_ == 1 ? 2 / (2 - square) : 4 / (4 - square * omega_);
      const auto to = next.flat();
      const auto before = before_.flat();
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = before[k] + omega_ * (to[k] - before[k]);
    }
    before_ = now.v;
    ++count_;
    return accelerates;
  }

 private:
  static constexpr int plain = 2, length = 8;  ///< iterations before, and between two looks at the radius
  static constexpr double largest_radius = 0.995;

  /// Begins the polynomial anew, with a larger radius where the error fell more slowly than by the factor
  /// that the radius promises (after Hageman and Young 1981, ch. 5).
  void lengthen(double merit) {
    const double promised = radius_ / (1 + std::sqrt(1 - radius_ * radius_));
    if (std::pow(merit / first_merit_, 0.5 / length) > promised)
      radius_ = std::min(largest_radius, (1 + radius_) / 2);
    count_ = 0;
  }

  int count_ = 0;  ///< iterations with the present radius
  double omega_ = 1, radius_ = 0, first_merit_ = 0;
  Vec3Field before_;
};

/// The differences of the last iterates.
class History {
 public:
  struct Step {
    Vec3Field v, r, e;
  };

  void clear() { steps_.clear(), has_last_ = false; }
  const std::vector<Step>& steps() const { return steps_; }  ///< the oldest first

  /// Keeps the difference from the last iterate to `now`, if its curvature v . r is positive.
  void add(const Iterate& now) {
    if (has_last_) {
      Step step{difference_of(now.v, last_.v), difference_of(now.r, last_.r), difference_of(now.e, last_.e)};
      if (dot_of(step.v, step.r) > 0) {
        if (steps_.size() == window) steps_.erase(steps_.begin());
        steps_.push_back(std::move(step));
      }
    }
    last_ = {now.v, now.r, now.e}, has_last_ = true;
  }

 private:
  static constexpr std::size_t window = 5;
  std::vector<Step> steps_;
  Step last_;
  bool has_last_ = false;
};

class Anderson : public Acceleration {
 public:
  void restart() override { history_.clear(); }

  /// v_{k+1} = v_k - e_k - sum_j g_j (dv_j - de_j), with g minimising |e_k - sum_j g_j de_j| in the norm of
  /// B^-1, in which a product is e . r.
  bool propose(const Iterate& now, Vec3Field& next) override {
    history_.add(now);
    next = now.v;
    add_to(next, -1, now.e);
    const auto& steps = history_.steps();
    if (steps.empty()) return false;
    const auto size = static_cast<Eigen::Index>(steps.size());
    Eigen::MatrixXd products(size, size);
    Eigen::VectorXd right(size);
    for (Eigen::Index a = 0; a < size; ++a) {
      const History::Step& step = steps[static_cast<std::size_t>(a)];
      right[a] = dot_of(step.e, now.r);
      for (Eigen::Index b = 0; b <= a; ++b)
        products(a, b) = products(b, a) = dot_of(step.e, steps[static_cast<std::size_t>(b)].r);
    }
    const Eigen::VectorXd weight = products.completeOrthogonalDecomposition().solve(right);
    for (Eigen::Index a = 0; a < size; ++a) {
      add_to(next, -weight[a], steps[static_cast<std::size_t>(a)].v);
      add_to(next, weight[a], steps[static_cast<std::size_t>(a)].e);
    }
    return true;
  }

 private:
  History history_;
};

class LimitedMemoryBfgs : public Acceleration {
 public:
  void restart() override { history_.clear(); }

  /// The two loops of Nocedal 1980 with B as the first inverse: B q = e_k - sum_i a_i de_i needs no solve of
  /// its own, because de_i = B dr_i.
  bool propose(const Iterate& now, Vec3Field& next) override {
    history_.add(now);
    const auto& steps = history_.steps();
    Vec3Field q = now.r, direction = now.e;
    std::vector<double> a(steps.size()), curvature(steps.size());
    for (std::size_t i = steps.size(); i-- > 0;) {
      curvature[i] = dot_of(steps[i].v, steps[i].r);
      a[i] = dot_of(steps[i].v, q) / curvature[i];
      add_to(q, -a[i], steps[i].r);
      add_to(direction, -a[i], steps[i].e);
    }
    for (std::size_t i = 0; i < steps.size(); ++i)
      add_to(direction, a[i] - dot_of(steps[i].r, direction) / curvature[i], steps[i].v);
    next = now.v;
    add_to(next, -1, direction);
    return !steps.empty();
  }

 private:
  History history_;
};

}  // namespace

std::unique_ptr<Acceleration> make_acceleration(const std::string& name) {
  if (name == "chebyshev") return std::make_unique<Chebyshev>();
  if (name == "anderson") return std::make_unique<Anderson>();
  if (name == "l-bfgs") return std::make_unique<LimitedMemoryBfgs>();
  assert(name == "none");
  return nullptr;
}

}  // namespace cloth
