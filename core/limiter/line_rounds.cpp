// TensionRounds for any springs: lines one after the other, only active springs.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cloth/sums.h"
#include "limiter/tension_rounds.h"

namespace cloth {
namespace {

class LineRounds : public TensionRounds {
 public:
  LineRounds(const std::vector<TensionSpring>& springs, const ClothSystem& system)
      : springs_(springs),
        lines_(spring_lines(springs, system)),
        node_(static_cast<std::size_t>(system.size())) {}

  void begin(const TensionTask& task, const std::vector<double>& inverse_mass,
             const std::vector<double>& tension, const Vec3Field& position) override;
  TensionResidual evaluate() override;
  void sweep_lines(bool backwards) override;
  int solve_together() override;
  void end(std::vector<double>& tension, Vec3Field& position) const override;

 private:
  /// A spring that is over its limit or has a tension, and its equation.
  struct Active {
    std::size_t spring, first, second;
    double both;          ///< w_first + w_second
    Vec3 direction;       ///< a
    double over;          ///< C less what the softness allows
    double link = 0;      ///< off the diagonal: to the one before it in its line
    double pivot = 0;     ///< reciprocal, of the tridiagonal factors
    bool linked = false;  ///< to the one before it
  };

  bool make_active(std::size_t spring, Active& active) const;
  void link(const Active& before, Active& active) const;
  void append_active(std::size_t line, std::vector<Active>& list) const;
  void sweep_line(std::size_t line);
  void move(const Active& active, double tension);
  void precondition(const std::vector<double>& residual, std::vector<double>& result) const;
  void pull(const std::vector<double>& tension);
  double multiply(const std::vector<double>& tension, double ridge, std::vector<double>& result) const;
  int conjugate_gradients();
  void take_step();
  double square() const { return task_.time_step * task_.time_step; }

  std::vector<TensionSpring> springs_;
  SpringLines lines_;
  TensionTask task_;
  std::vector<double> weight_;  ///< inverse masses
  std::vector<double> tension_;
  Vec3Field position_;

  std::vector<Active> active_;  ///< of the last evaluation, line by line
  std::vector<Active> along_;   ///< of one line
  std::vector<double> step_, residual_, solved_, direction_, product_;
  std::vector<Vec3> node_;  ///< w J^T of tensions
};

void LineRounds::begin(const TensionTask& task, const std::vector<double>& inverse_mass,
                       const std::vector<double>& tension, const Vec3Field& position) {
  task_ = task;
  weight_ = inverse_mass;
  tension_ = tension;
  position_ = position;
}

void LineRounds::end(std::vector<double>& tension, Vec3Field& position) const {
  tension = tension_;
  position = position_;
}

/// False where the spring is not active.
bool LineRounds::make_active(std::size_t s, Active& active) const {
  const TensionSpring& spring = springs_[s];
  const std::size_t i = spring.first, j = spring.second;
  const double both = weight_[i] + weight_[j];
  if (!(both > 0)) return false;
  const Vec3 d = position_[j] - position_[i];
  const double length = d.norm();
  const double over = length - spring.limit - square() * task_.softness * both * tension_[s];
  if (!(over > 0) && !(tension_[s] > 0)) return false;
  active.spring = s, active.first = spring.first, active.second = spring.second;
  active.both = both, active.over = over;
  active.direction = length > 0 ? Vec3(d / length) : Vec3(Vec3::Zero());
  return true;
}

/// The entry of J W J^T for two springs that share one particle.
void LineRounds::link(const Active& before, Active& active) const {
  const bool first = active.first == before.first || active.first == before.second;
  const std::size_t joint = first ? active.first : active.second;
  const double sign = (joint == active.first) == (joint == before.first) ? 1 : -1;
  active.link = sign * weight_[joint] * before.direction.dot(active.direction);
  active.linked = true;
}

/// Appends the active springs of a line.
void LineRounds::append_active(std::size_t line, std::vector<Active>& list) const {
  bool follows = false;  // the spring before it is active
  for (std::size_t k = lines_.begin[line]; k < lines_.begin[line + 1]; ++k) {
    Active active{};
    const bool is_active = make_active(lines_.springs[k], active);
    if (is_active && follows) link(list.back(), active);
    if (is_active) list.push_back(active);
    follows = is_active;
  }
}

TensionResidual LineRounds::evaluate() {
  TensionResidual found;
  active_.clear();
  for (std::size_t line = 0; line < lines_.count(); ++line) append_active(line, active_);
  for (const Active& active : active_) {
    const double relative = active.over / springs_[active.spring].rest_length;
    found.excess = std::max(found.excess, relative);
    if (tension_[active.spring] > 0) found.slack = std::max(found.slack, -relative);
  }
  return found;
}

void LineRounds::move(const Active& active, double tension) {
  const std::size_t i = active.first, j = active.second;
  const Vec3 shift = square() * tension * active.direction;
  position_.add(i, weight_[i] * shift);
  position_.add(j, -weight_[j] * shift);
}

void LineRounds::sweep_lines(bool backwards) {
  for (std::size_t k = 0; k < lines_.count(); ++k) sweep_line(backwards ? lines_.count() - 1 - k : k);
}

void LineRounds::sweep_line(std::size_t line) {
  along_.clear();
  append_active(line, along_);
  const double per_square = 1 / square();
  step_.resize(along_.size());
  for (std::size_t k = 0; k < along_.size(); ++k) {
    Active& active = along_[k];
    const double diagonal = active.both * (1 + least_ridge + task_.softness);
    const double before = active.linked ? active.link * along_[k - 1].pivot : 0;
    active.pivot = 1 / (diagonal - before * active.link);
    const double known = active.linked ? active.link * step_[k - 1] : 0;
    step_[k] = (active.over * per_square - known) * active.pivot;
  }
  // Back substitution sees clipped tensions of later springs, not of earlier ones.
  for (std::size_t k = along_.size(); k-- > 0;) {
    if (k + 1 < along_.size() && along_[k + 1].linked)
      step_[k] -= along_[k].pivot * along_[k + 1].link * step_[k + 1];
    double& tension = tension_[along_[k].spring];
    step_[k] = std::max(step_[k], -tension);
    tension += step_[k];
    move(along_[k], step_[k]);
  }
}

void LineRounds::precondition(const std::vector<double>& residual, std::vector<double>& result) const {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const double known = active_[k].linked ? active_[k].link * result[k - 1] : 0;
    result[k] = (residual[k] - known) * active_[k].pivot;
  }
  for (std::size_t k = active_.size(); k-- > 1;)
    if (active_[k].linked) result[k - 1] -= active_[k - 1].pivot * active_[k].link * result[k];
}

/// node_ <- W J^T tension
void LineRounds::pull(const std::vector<double>& tension) {
  std::fill(node_.begin(), node_.end(), Vec3::Zero());
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Vec3 force = tension[k] * active_[k].direction;
    node_[active_[k].first] += force;
    node_[active_[k].second] -= force;
  }
  for (std::size_t i = 0; i < node_.size(); ++i) node_[i] *= weight_[i];
}

/// result <- (J W J^T + ridge diagonal) tension, after pull(tension). Returns tension . result.
double LineRounds::multiply(const std::vector<double>& tension, double ridge,
                            std::vector<double>& result) const {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Active& active = active_[k];
    const Vec3 difference = node_[active.first] - node_[active.second];
    result[k] = active.direction.dot(difference) + ridge * active.both * tension[k];
  }
  return dot(tension, result);
}

int LineRounds::conjugate_gradients() {
  const std::size_t count = active_.size();
  const double ridge = ridge_of(task_);
  for (std::size_t k = 0; k < count; ++k) {
    Active& active = active_[k];
    const double before = active.linked ? active.link * active_[k - 1].pivot : 0;
    active.pivot = 1 / (active.both * (1 + ridge) - before * active.link);
  }
  const double per_square = 1 / square();
  double largest = 0, shortest = springs_[0].rest_length;
  residual_.resize(count), solved_.resize(count), direction_.resize(count), product_.resize(count);
  step_.assign(count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    residual_[k] = active_[k].over * per_square;
    largest = std::max(largest, std::abs(residual_[k]));
    shortest = std::min(shortest, springs_[active_[k].spring].rest_length);
  }
  const double enough =
      std::max(enough_of_residual * largest, enough_of_tolerance * task_.tolerance * shortest * per_square);
  precondition(residual_, solved_);
  direction_ = solved_;
  double product = dot(residual_, solved_);
  int iterations = 0;
  while (iterations < max_cg_iterations && product > 0) {
    pull(direction_);
    const double length = product / multiply(direction_, ridge, product_);
    ++iterations;
    largest = 0;
    for (std::size_t k = 0; k < count; ++k) {
      step_[k] += length * direction_[k];
      residual_[k] -= length * product_[k];
      largest = std::max(largest, std::abs(residual_[k]));
    }
    if (largest <= enough) break;
    precondition(residual_, solved_);
    const double next = dot(residual_, solved_), share = next / product;
    product = next;
    for (std::size_t k = 0; k < count; ++k) direction_[k] = solved_[k] + share * direction_[k];
  }
  return iterations;
}

/// Tensions stay at least 0. Where that clips one, the step is only as long as it reduces C.
void LineRounds::take_step() {
  bool clipped = false;
  double gain = 0, length = 1;
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const double least = -tension_[active_[k].spring];
    if (step_[k] < least) step_[k] = least, clipped = true;
    gain += step_[k] * active_[k].over;
  }
  pull(step_);
  if (clipped)
    length = gain > 0 ? std::min(1.0, gain / (square() * multiply(step_, task_.softness, product_))) : 0;
  if (!(length > 0)) {
    length = 1;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const Active& active = active_[k];
      step_[k] = std::max(steepest_share * active.over / (square() * active.both), -tension_[active.spring]);
    }
    pull(step_);
  }
  for (std::size_t k = 0; k < active_.size(); ++k) {
    double& tension = tension_[active_[k].spring];
    tension = std::max(0.0, tension + length * step_[k]);
  }
  const double shift = length * square();
  for (std::size_t i = 0; i < node_.size(); ++i)
    if (weight_[i] > 0) position_.add(i, shift * node_[i]);
}

int LineRounds::solve_together() {
  if (active_.empty()) return 0;
  const int iterations = conjugate_gradients();
  take_step();
  return iterations;
}

}  // namespace

std::unique_ptr<TensionRounds> make_line_rounds(const std::vector<TensionSpring>& springs,
                                                const ClothSystem& system) {
  return std::make_unique<LineRounds>(springs, system);
}

}  // namespace cloth
