// TensionRounds for any springs: lines one after the other. While few springs are over their limit or have a
// tension, the others are looked at only where one of their ends has moved.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "cloth/sums.h"
#include "limiter/placed_springs.h"
#include "limiter/tension_rounds.h"

namespace cloth {
namespace {

class LineRounds : public TensionRounds {
 public:
  LineRounds(std::span<const TensionSpring> springs, const ClothSystem& system)
      : placed_(springs, system),
        is_candidate_(springs.size(), 0),
        is_moved_(static_cast<std::size_t>(system.size()), 0),
        node_(static_cast<std::size_t>(system.size())) {}

  void begin(const TensionTask& task, const TensionProblem& problem) override;
  TensionResidual evaluate() override;
  void sweep_lines(bool backwards) override;
  int solve_together() override;
  bool have_outgrown() const override { return takes_all_; }
  void end(bool changed) override;

 private:
  /// A spring that is over its limit or has a tension, and its equation.
  struct Active {
    std::size_t spring, first, second;
    std::uint32_t place;
    double rest_length;   ///< m
    double both;          ///< w_first + w_second
    Vec3 direction;       ///< a
    double over;          ///< C less what the softness allows
    double link = 0;      ///< off the diagonal: to the one before it in its line
    double pivot = 0;     ///< reciprocal, of the tridiagonal factors
    bool linked = false;  ///< to the one before it
  };

  void add_candidate(std::uint32_t place);
  void take_all_if_many();
  void add_neighbours_of_moved();
  bool is_over(std::uint32_t place) const;
  bool make_active(std::uint32_t place, Active& active) const;
  void link(const Active& before, Active& active) const;
  void append_active(std::uint32_t place, std::vector<Active>& list) const;
  void sweep_line(std::size_t begin, std::size_t end);
  void move(std::size_t particle, const Vec3& shift);
  void precondition(const std::vector<double>& residual, std::vector<double>& result) const;
  void pull(const std::vector<double>& tension);
  double multiply(const std::vector<double>& tension, double ridge, std::vector<double>& result) const;
  int conjugate_gradients();
  void take_step();
  double square() const { return task_.time_step * task_.time_step; }

  PlacedSprings placed_;

  // Of the present solve.
  TensionTask task_;
  const std::vector<double>* weight_ = nullptr;  ///< inverse masses
  std::vector<double>* tension_ = nullptr;
  SpringTensions* tensions_ = nullptr;
  Vec3Field* position_ = nullptr;
  SparseField* from_ = nullptr;

  std::vector<std::uint32_t> candidates_;  ///< places that may be active; ascending after evaluate()
  bool takes_all_ = false;                 ///< candidates_ are all places
  std::vector<std::uint8_t> is_candidate_;
  std::vector<std::uint32_t> moved_;  ///< particles, since the last evaluation
  std::vector<std::uint8_t> is_moved_;
  std::vector<Active> active_;  ///< of the last evaluation, line by line
  std::vector<Active> along_;   ///< of one line
  std::vector<double> step_, residual_, solved_, direction_, product_;
  std::vector<Vec3> node_;  ///< J^T of tensions, at the ends of active springs
};

void LineRounds::begin(const TensionTask& task, const TensionProblem& problem) {
  task_ = task;
  weight_ = &problem.inverse_mass;
  tensions_ = &problem.tension, tension_ = &problem.tension.write();
  position_ = &problem.position, from_ = &problem.from;
  const auto take = [this](std::size_t s) {
    const PlacedSpring& spring = placed_.at[placed_.place[s]];
    if ((*weight_)[spring.first] + (*weight_)[spring.second] > 0)
      add_candidate(placed_.place[s]);
    else
      (*tension_)[s] = 0;
  };
  if (problem.tension.is_few())
    for (const std::uint32_t s : problem.tension.held()) take(s);
  else
    for (std::size_t s = 0; s < tension_->size(); ++s)
      if ((*tension_)[s] > 0) take(s);
  for (const std::uint32_t s : problem.over) add_candidate(placed_.place[s]);
  std::sort(candidates_.begin(), candidates_.end());
  takes_all_ = false;
  take_all_if_many();
}

void LineRounds::end(bool) {
  for (const std::uint32_t i : moved_) is_moved_[i] = 0;
  for (std::uint32_t& place : candidates_) {
    is_candidate_[place] = 0;
    place = placed_.at[place].spring;
  }
  moved_.clear();
  tensions_->list_held(candidates_);
  candidates_.clear();
}

void LineRounds::add_candidate(std::uint32_t place) {
  if (is_candidate_[place]) return;
  is_candidate_[place] = 1;
  candidates_.push_back(place);
}

/// A front of taut springs would advance by one spring in each evaluation; a sweep over all lines carries it
/// across the cloth.
void LineRounds::take_all_if_many() {
  if (takes_all_ || candidates_.size() <= SpringTensions::most(placed_.at.size())) return;
  takes_all_ = true;
  candidates_.resize(placed_.at.size());
  std::iota(candidates_.begin(), candidates_.end(), 0U);
  std::fill(is_candidate_.begin(), is_candidate_.end(), std::uint8_t{1});
}

bool LineRounds::is_over(std::uint32_t place) const {
  const PlacedSpring& spring = placed_.at[place];
  const Vec3 d = (*position_)[spring.second] - (*position_)[spring.first];
  return d.squaredNorm() > spring.limit * spring.limit;
}

void LineRounds::add_neighbours_of_moved() {
  const std::size_t count = candidates_.size();
  for (const std::uint32_t i : moved_) {
    is_moved_[i] = 0;
    for (std::uint32_t k = placed_.begin[i]; k < placed_.begin[i + 1]; ++k) {
      const std::uint32_t place = placed_.around[k];
      if (!is_candidate_[place] && is_over(place)) add_candidate(place);
    }
  }
  moved_.clear();
  const auto middle = candidates_.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(middle, candidates_.end());
  std::inplace_merge(candidates_.begin(), middle, candidates_.end());
}

/// False where the spring is not active.
bool LineRounds::make_active(std::uint32_t place, Active& active) const {
  const PlacedSpring& spring = placed_.at[place];
  const std::size_t i = spring.first, j = spring.second;
  const double both = (*weight_)[i] + (*weight_)[j];
  if (!(both > 0)) return false;
  const Vec3 d = (*position_)[j] - (*position_)[i];
  const double length = d.norm(), tension = (*tension_)[spring.spring];
  const double over = length - spring.limit - square() * task_.softness * both * tension;
  if (!(over > 0) && !(tension > 0)) return false;
  active.spring = spring.spring, active.first = spring.first, active.second = spring.second;
  active.place = place, active.rest_length = spring.rest_length;
  active.both = both, active.over = over;
  active.direction = (length > 0 ? 1 / length : 0) * d;
  return true;
}

/// The entry of J W J^T for two springs that share one particle.
void LineRounds::link(const Active& before, Active& active) const {
  const bool first = active.first == before.first || active.first == before.second;
  const std::size_t joint = first ? active.first : active.second;
  const double sign = (joint == active.first) == (joint == before.first) ? 1 : -1;
  active.link = sign * (*weight_)[joint] * before.direction.dot(active.direction);
  active.linked = true;
}

void LineRounds::append_active(std::uint32_t place, std::vector<Active>& list) const {
  Active active{};
  if (!make_active(place, active)) return;
  if (!list.empty() && list.back().place + 1 == place && placed_.at[place].line == placed_.at[place - 1].line)
    link(list.back(), active);
  list.push_back(active);
}

/// Springs that are no longer active are candidates no more; a neighbour that moves brings them back.
TensionResidual LineRounds::evaluate() {
  add_neighbours_of_moved();
  active_.clear();
  if (takes_all_) {
    for (const std::uint32_t place : candidates_) append_active(place, active_);
  } else {
    for (const std::uint32_t place : candidates_) {
      const std::size_t count = active_.size();
      append_active(place, active_);
      is_candidate_[place] = active_.size() > count;
    }
    std::erase_if(candidates_, [this](std::uint32_t place) { return !is_candidate_[place]; });
    take_all_if_many();
  }
  TensionResidual found;
  for (const Active& active : active_) {
    const double relative = active.over / active.rest_length;
    found.excess = std::max(found.excess, relative);
    if ((*tension_)[active.spring] > 0) found.slack = std::max(found.slack, -relative);
  }
  return found;
}

void LineRounds::move(std::size_t i, const Vec3& shift) {
  if (!is_moved_[i]) {
    is_moved_[i] = 1;
    moved_.push_back(static_cast<std::uint32_t>(i));
    if (!from_->has(i)) from_->set(i, (*position_)[i]);
  }
  position_->add(i, shift);
}

void LineRounds::sweep_lines(bool backwards) {
  const auto line = [this](std::size_t k) { return placed_.at[candidates_[k]].line; };
  const std::size_t count = candidates_.size();
  if (backwards)
    for (std::size_t end = count, begin; end > 0; end = begin) {
      for (begin = end - 1; begin > 0 && line(begin - 1) == line(end - 1);) --begin;
      sweep_line(begin, end);
    }
  else
    for (std::size_t begin = 0, end; begin < count; begin = end) {
      for (end = begin + 1; end < count && line(end) == line(begin);) ++end;
      sweep_line(begin, end);
    }
}

/// Of the candidates [begin, end), all of one line.
void LineRounds::sweep_line(std::size_t begin, std::size_t end) {
  along_.clear();
  for (std::size_t k = begin; k < end; ++k) append_active(candidates_[k], along_);
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
    double& tension = (*tension_)[along_[k].spring];
    step_[k] = std::max(step_[k], -tension);
    tension += step_[k];
    const Vec3 shift = square() * step_[k] * along_[k].direction;
    for (const auto& [i, sign] : {std::pair{along_[k].first, 1}, std::pair{along_[k].second, -1}})
      if ((*weight_)[i] > 0) move(i, sign * (*weight_)[i] * shift);
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

/// node_ <- J^T tension
void LineRounds::pull(const std::vector<double>& tension) {
  for (const Active& active : active_) node_[active.first] = node_[active.second] = Vec3::Zero();
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Vec3 force = tension[k] * active_[k].direction;
    node_[active_[k].first] += force;
    node_[active_[k].second] -= force;
  }
}

/// result <- (J W J^T + ridge diagonal) tension, after pull(tension). Returns tension . result.
double LineRounds::multiply(const std::vector<double>& tension, double ridge,
                            std::vector<double>& result) const {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Active& active = active_[k];
    const Vec3 difference =
        (*weight_)[active.first] * node_[active.first] - (*weight_)[active.second] * node_[active.second];
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
  double largest = 0, shortest = active_[0].rest_length;
  residual_.resize(count), solved_.resize(count), direction_.resize(count), product_.resize(count);
  step_.assign(count, 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    residual_[k] = active_[k].over * per_square;
    largest = std::max(largest, std::abs(residual_[k]));
    shortest = std::min(shortest, active_[k].rest_length);
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
    const double least = -(*tension_)[active_[k].spring];
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
      step_[k] =
          std::max(steepest_share * active.over / (square() * active.both), -(*tension_)[active.spring]);
    }
    pull(step_);
  }
  for (std::size_t k = 0; k < active_.size(); ++k) {
    double& tension = (*tension_)[active_[k].spring];
    tension = std::max(0.0, tension + length * step_[k]);
  }
  const double shift = length * square();
  for (const Active& active : active_)
    for (const std::size_t i : {active.first, active.second}) {
      if ((*weight_)[i] > 0) move(i, shift * (*weight_)[i] * node_[i]);
      node_[i] = Vec3::Zero();  // moved once, however many springs meet there
    }
}

int LineRounds::solve_together() {
  if (active_.empty()) return 0;
  const int iterations = conjugate_gradients();
  take_step();
  return iterations;
}

}  // namespace

std::unique_ptr<TensionRounds> make_line_rounds(std::span<const TensionSpring> springs,
                                                const ClothSystem& system) {
  return std::make_unique<LineRounds>(springs, system);
}

}  // namespace cloth
