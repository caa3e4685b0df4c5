#include "exact/strip_tests.h"

#include <algorithm>
#include <cmath>

namespace cloth::exact {
namespace {

using Eigen::Vector2d, Eigen::Vector3d, Eigen::VectorXd;

constexpr double half = 0.5;

/// Solutions are followed on this part of the steps and solved for on all of them where they lead: the error
/// of order 4 of the former is that of a first guess.
constexpr int rough = 5;

/// Where a strip starts, how it is loaded there and how far it goes.
struct Shot {
  ElasticaPoint start;
  ElasticaLoad load;
  double length = half;

  static constexpr int steps = 2000;

  ElasticaPoint end(int part = 1) const { return end_of_elastica(start, load, length, steps / part); }
};

/// A half from its first point to the plane of symmetry, whose y follows. Shot from both ends and met between
/// them: under tension cloth hangs nearly straight, and the error of a shot grows there exponentially, like
/// exp(integral of sqrt(tension)). As the tension falls from Gamma/2 to 0, they meet above the middle.
struct Half {
  ElasticaPoint first, last;
  ElasticaLoad load;  ///< at the first point

  static constexpr int upper_steps = 1400, steps = 4000;
  static constexpr double upper_part = half * upper_steps / steps;

  ElasticaLoad at_last() const { return {load.horizontal, load.vertical + load.weight * half, load.weight}; }
  std::vector<ElasticaPoint> upper() const {
    return integrate_elastica(first, load, upper_part, upper_steps);
  }
  std::vector<ElasticaPoint> lower() const {
    return integrate_elastica(last, at_last(), upper_part - half, steps - upper_steps);
  }
  VectorXd gap(int part = 1) const {
    const ElasticaPoint above = end_of_elastica(first, load, upper_part, upper_steps / part);
    const ElasticaPoint below =
        end_of_elastica(last, at_last(), upper_part - half, (steps - upper_steps) / part);
    return Vector3d(above.x - below.x, above.angle - below.angle, (above.curvature - below.curvature) / 10);
  }
};

void measure(StripShape& shape) {
  const auto [left, right] = std::minmax_element(shape.points.begin(), shape.points.end(),
                                                 [](auto& a, auto& b) { return a.x < b.x; });
  const auto [low, high] = std::minmax_element(shape.points.begin(), shape.points.end(),
                                               [](auto& a, auto& b) { return a.y < b.y; });
  shape.height = high->y - low->y;
  shape.width = (right->x - left->x) * (shape.is_half ? 2 : 1);
  shape.drop = shape.points.front().y - shape.points.back().y;
}

StripShape shape_of(const Shot& shot, bool is_half) {
  StripShape shape;
  shape.is_half = is_half;
  shape.load = shot.load;
  if (shot.start.arc > 0) shape.points.push_back({0, shot.start.x - shot.start.arc, 0, rightward, 0});
  const std::vector<ElasticaPoint> bent = integrate_elastica(shot.start, shot.load, shot.length, Shot::steps);
  shape.points.insert(shape.points.end(), bent.begin(), bent.end());
  shape.resting = shot.start.arc * (is_half ? 2 : 1);
  measure(shape);
  return shape;
}

StripShape shape_of(const Half& hanging) {
  StripShape shape;
  shape.is_half = true;
  shape.load = hanging.load;
  shape.points = hanging.upper();
  std::vector<ElasticaPoint> lower = hanging.lower();
  const double lift = shape.points.back().y - lower.back().y;
  for (ElasticaPoint& point : lower) point.y += lift;
  shape.points.insert(shape.points.end(), lower.rbegin() + 1, lower.rend());
  measure(shape);
  return shape;
}

/// Whether the half goes to the other side of the plane of symmetry at `x`, where its mirror image is.
bool crosses(const StripShape& shape, double x, double side) {
  return std::any_of(shape.points.begin(), shape.points.end(),
                     [&](const ElasticaPoint& point) { return side * (point.x - x) < -1e-9; });
}

std::optional<StripShape> unless_crossing(const StripShape& shape, double x, double side) {
  if (crosses(shape, x, side)) return std::nullopt;
  return shape;
}

/// What has to vanish, on all steps or a part of them.
using SteppedConditions = std::function<VectorXd(double along, const VectorXd& unknowns, int part)>;

/// From one end of `along` to the other; the solution there is that of all steps.
std::optional<VectorXd> follow(const SteppedConditions& conditions, const VectorXd& solution, double from,
                               double to) {
  const auto guess = follow_solution(
      [&](double along, const VectorXd& u) { return conditions(along, u, rough); }, solution, from, to);
  if (!guess) return std::nullopt;
  const auto found = solve_by_newton([&](const VectorXd& u) { return conditions(to, u, 1); }, *guess);
  const bool is_of_the_branch = found && (*found - *guess).norm() <= 0.3 * (1 + guess->norm());
  return is_of_the_branch ? found : std::nullopt;
}

/// Follows the half from one end of `along` to the other.
using HalfFamily = std::function<Half(double along, const VectorXd& unknowns)>;
std::optional<VectorXd> follow_half(const HalfFamily& half_of, const VectorXd& solution, double from,
                                    double to) {
  return follow([&](double along, const VectorXd& u, int part) { return half_of(along, u).gap(part); },
                solution, from, to);
}

/// Right half of what hangs from a point at the origin, by symmetry with half the weight on it. Unknown: the
/// curvatures of both ends and the horizontal force.
Half hanging_half(double gamma, double first_angle, const VectorXd& unknowns) {
  return {{0, 0, 0, first_angle, unknowns[0]},
          {half, 0, 0, -rightward, unknowns[1]},
          {unknowns[2], -gamma / 2, gamma}};
}

std::optional<StripShape> hanging_loop(double gamma, double first_angle) {
  // From the circle, which is the weightless ring, to the angle of the ends, then to the weight.
  auto found = std::optional<VectorXd>(Vector3d(-2 * pi, -2 * pi, 0));
  found = follow_half([&](double angle, const VectorXd& u) { return hanging_half(0, angle, u); }, *found,
                      rightward, first_angle);
  if (found)
    found =
        follow_half([&](double weight, const VectorXd& u) { return hanging_half(weight, first_angle, u); },
                    *found, 0, gamma);
  if (!found) return std::nullopt;
  return unless_crossing(shape_of(hanging_half(gamma, first_angle, *found)), 0, 1);
}

/// Left half of a strip between two clamps; unknowns as above.
Half sagging_half(double gamma, double span, const VectorXd& unknowns) {
  return {{0, 0, 0, rightward, unknowns[0]},
          {half, span / 2, 0, rightward, unknowns[1]},
          {unknowns[2], -gamma / 2, gamma}};
}

/// Right half of the standing ring. Unknown: the curvature at the floor where that is positive and minus the
/// length that lies flat where it is negative, for one of the two is zero; the horizontal force.
Shot standing_half(double gamma, const VectorXd& unknowns) {
  const double lying = std::max(0.0, -unknowns[0]);
  return {{lying, lying, 0, rightward, std::max(0.0, unknowns[0])},
          {unknowns[1], gamma * (lying - half), gamma},
          half - lying};
}

/// The fold from where it lifts off the floor. Unknown: its length and the floor's reaction.
Shot free_fold_shot(const VectorXd& unknowns) {
  return {{0, 0, 0, rightward, 0}, {0, -unknowns[1], 1}, unknowns[0]};
}

/// Unknown: the length that lies flat, the horizontal and the vertical force where it lifts off.
Shot clamped_fold_shot(double gamma, const VectorXd& unknowns) {
  return {{unknowns[0], unknowns[0], 0, rightward, 0}, {unknowns[1], unknowns[2], gamma}, 1 - unknowns[0]};
}

/// Left half of the wrinkle on a floor.
Shot wrinkle_half(double gamma, double horizontal) {
  return {{0, 0, 0, rightward, 0}, {horizontal, -gamma / 2, gamma}, half};
}

}  // namespace

std::optional<StripShape> heart_loop(double gamma) {
  return hanging_loop(gamma, upward);
}

std::optional<StripShape> pear_loop(double gamma) {
  return hanging_loop(gamma, downward);
}

std::optional<StripShape> hanging_ring(double gamma) {
  return hanging_loop(gamma, rightward);
}

std::optional<StripShape> standing_ring(double gamma) {
  const auto closes = [&](double weight, const VectorXd& unknowns, int part) -> VectorXd {
    const ElasticaPoint end = standing_half(weight, unknowns).end(part);
    return Vector2d(end.x, end.angle - leftward);
  };
  auto found = std::optional<VectorXd>(Vector2d(2 * pi, 0));
  found = follow(closes, *found, 0, gamma);
  if (!found) return std::nullopt;
  const StripShape shape = shape_of(standing_half(gamma, *found), true);
  if (shape.points.back().y <= 0) return std::nullopt;
  return unless_crossing(shape, 0, 1);
}

std::optional<StripShape> free_fold() {
  // Neither is y = 0 at the end asked for: curvature^2/2 = Gamma y there, because curvature^2/2 + n . t -
  // Gamma y is the same everywhere, so that it follows, and as a condition would have a double root.
  const auto lies_flat = [](const VectorXd& unknowns) -> VectorXd {
    const ElasticaPoint end = free_fold_shot(unknowns).end();
    return Vector2d(end.angle - leftward, end.curvature);
  };
  const auto found = solve_by_newton(lies_flat, Vector2d(3.9, 3.75));
  if (!found) return std::nullopt;
  return shape_of(free_fold_shot(*found), false);
}

double clamped_fold_limit() {
  const StripShape fold = free_fold().value();
  return std::pow(fold.points.back().arc - fold.points.back().x, 3);
}

std::optional<StripShape> clamped_fold(double gamma) {
  const double limit = clamped_fold_limit();
  if (gamma > limit) return std::nullopt;
  const auto comes_back = [](double weight, const VectorXd& unknowns, int part) -> VectorXd {
    const ElasticaPoint end = clamped_fold_shot(weight, unknowns).end(part);
    return Vector3d(end.x, end.y, end.angle - leftward);
  };
  const StripShape fold = free_fold().value();
  const double length = std::cbrt(limit);  // in the bending length
  const Vector3d at_limit(-fold.points.back().x / length, 0, fold.load.vertical * length * length);
  const auto found = follow(comes_back, at_limit, limit, gamma);
  if (!found) return std::nullopt;
  return shape_of(clamped_fold_shot(gamma, *found), false);
}

std::optional<StripShape> standing_wrinkle(double gamma) {
  const auto is_level_on_top = [](double weight, const VectorXd& unknowns, int part) -> VectorXd {
    const ElasticaPoint end = wrinkle_half(weight, unknowns[0]).end(part);
    return VectorXd::Constant(1, (end.angle - rightward) / weight);
  };
  // A low wrinkle is the buckled beam on a floor: n_x = -4 z^2, where tan z = z.
  constexpr double z = 4.493409457909064;
  const auto low = VectorXd::Constant(1, -4 * z * z);
  const auto found = follow(is_level_on_top, low, std::min(gamma, 1.0) / 1e3, gamma);
  if (!found) return std::nullopt;
  const StripShape shape = shape_of(wrinkle_half(gamma, (*found)[0]), true);
  return unless_crossing(shape, shape.points.back().x, -1);
}

std::optional<StripShape> hanging_wrinkle(double gamma, double span) {
  // A strip that is hardly shorter buckles as a sine: angle -a sin(2 pi s) from the horizontal, a^2/4 = 1 -
  // span.
  const double wide = std::max(span, 0.98), a = 2 * std::sqrt(1 - wide);
  auto found = solve_by_newton([&](const VectorXd& u) { return sagging_half(0, wide, u).gap(); },
                               Vector3d(-2 * pi * a, 2 * pi * a, -4 * pi * pi));
  if (found)
    found =
        follow_half([](double at, const VectorXd& u) { return sagging_half(0, at, u); }, *found, wide, span);
  if (found)
    found = follow_half([&](double weight, const VectorXd& u) { return sagging_half(weight, span, u); },
                        *found, 0, gamma);
  if (!found) return std::nullopt;
  return unless_crossing(shape_of(sagging_half(gamma, span, *found)), span / 2, -1);
}

std::optional<PressedStrip> pressed_strip(double eps) {
  const auto shot = [](const VectorXd& unknowns) -> Shot {
    return {{0, 0, 0, downward, unknowns[0]}, {unknowns[1], unknowns[2], 0}, 1};
  };
  const auto is_pressed = [&](double by, const VectorXd& unknowns, int part) -> VectorXd {
    const ElasticaPoint tip = shot(unknowns).end(part);
    return Vector3d(tip.x, tip.y + 1 - by, tip.curvature);
  };
  // The first mode of the clamped and hinged strip: curvature a (sin(z s) - z cos(z s)), tan z = z.
  constexpr double z = 4.493409457909064;
  const double little = std::min(eps, 0.01), a = 2 * std::sqrt(little / (1 + 1 / (z * z)));
  const auto first = solve_by_newton([&](const VectorXd& u) { return is_pressed(little, u, 1); },
                                     Vector3d(-a * z, a * z, z * z));
  if (!first) return std::nullopt;
  const auto found = little < eps ? follow(is_pressed, *first, little, eps) : first;
  if (!found) return std::nullopt;
  PressedStrip strip;
  strip.tangential = (*found)[1];
  strip.normal = (*found)[2];
  strip.friction = std::abs(strip.tangential / strip.normal);
  const Shot solved = shot(*found);
  strip.points = integrate_elastica(solved.start, solved.load, solved.length, Shot::steps);
  return strip;
}

}  // namespace cloth::exact
