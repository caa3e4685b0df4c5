// Strips at rest beside the curves of the exact elastica and of the catenary.
#include <cmath>

#include "exact/catenary.h"
#include "exact/heavy_strip.h"
#include "exact/strip_tests.h"
#include "study/validation/protocols.h"

namespace cloth {
namespace {

const char* const rest_method = "at rest, by Newton's method";
constexpr double promised_load = 20;  // Gamma
constexpr double wrinkle_span = 0.8;

Promise promise_of(double gamma) {
  return gamma <= promised_load ? Promise::second_order : Promise::none;
}

double droop_over_width(const PlanePoints& points) {
  const Eigen::Vector2d tip = points.back() - points.front();
  return -tip.y() / tip.x();
}

double drop_of_lowest(const PlanePoints& points) {
  double lowest = 0;
  for (const Eigen::Vector2d& point : points) lowest = std::min(lowest, point.y() - points.front().y());
  return -lowest;
}

/// The rest of the protocol's strip, which starts on the row's curve, and how far it is from it.
void measure_at_rest(ValidationProtocol& protocol) {
  protocol.measure = [strip = protocol.strip, value = protocol.value](const ValidationRow& row, int cells,
                                                                      const StopTest& stop) {
    StripRest found = rest_of_strip(strip(row.parameter, cells), row.curve, stop);
    ValidationReading reading{.failure = found.rest.failure};
    if (!reading.failure.empty()) return reading;
    reading.value = value(found.points);
    for (std::size_t k = 0; k < found.points.size(); ++k) {
      const double arc = static_cast<double>(k) / cells;
      reading.distance += (found.points[k] - point_at(row.curve, arc)).squaredNorm();
    }
    reading.distance = std::sqrt(reading.distance / static_cast<double>(found.points.size()));
    reading.points = std::move(found.points);
    return reading;
  };
}

StripCase heavy_strip(double gamma, int cells) {
  return {.load = gamma, .cells = cells};
}

ValidationProtocol cantilever() {
  ValidationProtocol protocol{"cantilever", "Gamma", {0.1, 1, 2, 5, 8, 10, 20, 50, 100, 1000}, {}, {}};
  protocol.expect = [](double gamma) {
    const exact::HeavyCantilever exact = exact::heavy_cantilever(gamma);
    return ValidationRow{.quantity = "droop H over width W of the tip",
                         .source = "Bickley 1934",
                         .method = rest_method,
                         .exact = exact.droop_over_width,
                         .curve = {exact.points, StripEnd::clamped, StripEnd::free},
                         .promise = promise_of(gamma)};
  };
  protocol.strip = heavy_strip, protocol.value = droop_over_width;
  measure_at_rest(protocol);
  return protocol;
}

/// A strip of which a half is known, held at both ends: how far its lowest point is below them.
ValidationProtocol loop(const char* name, std::vector<double> loads, const char* source,
                        std::function<std::optional<exact::StripShape>(double)> shape) {
  ValidationProtocol protocol{name, "Gamma", std::move(loads), {}, {}};
  protocol.expect = [source, shape](double gamma) {
    ValidationRow row{.quantity = "drop of the lowest point below the clamp, over the length",
                      .source = source,
                      .method = rest_method,
                      .promise = promise_of(gamma)};
    if (const auto exact = shape(gamma))
      row.exact = exact->drop, row.curve = whole_curve(exact->points, StripEnd::clamped);
    else
      row.failure = "there is no exact curve for this load";
    return row;
  };
  protocol.strip = heavy_strip, protocol.value = drop_of_lowest;
  measure_at_rest(protocol);
  return protocol;
}

ValidationProtocol catenary() {
  ValidationProtocol protocol{"catenary", "span", {0.5, 0.8, 0.95}, {}, {}};
  protocol.expect = [](double span) {
    const exact::Catenary exact = exact::catenary(1, span, 0, 1, 1, 2000);
    return ValidationRow{.quantity = "sag of the lowest point, over the length; no bending",
                         .source = "Irvine 1981",
                         .method = rest_method,
                         .exact = exact.sag,
                         .curve = {exact.points, StripEnd::pinned, StripEnd::pinned}};
  };
  protocol.strip = [](double, int cells) { return StripCase{.load = 1, .bends = false, .cells = cells}; };
  protocol.value = drop_of_lowest;
  measure_at_rest(protocol);
  return protocol;
}

}  // namespace

std::vector<ValidationProtocol> shape_protocols() {
  const auto wrinkle = [](double gamma) { return exact::hanging_wrinkle(gamma, wrinkle_span); };
  return {cantilever(),
          loop("heart-loop", {1, 5, 20, 100}, "Peirce 1930; Plaut 2015", exact::heart_loop),
          loop("pear-loop", {1, 5, 20, 100}, "Peirce 1930; Plaut 2015", exact::pear_loop),
          loop("hanging-ring", {1, 5, 20, 100}, "Peirce 1930; Plaut 2015", exact::hanging_ring),
          loop("hanging-wrinkle", {1, 5, 20, 100}, "Plaut 2015", wrinkle),
          catenary()};
}

}  // namespace cloth
