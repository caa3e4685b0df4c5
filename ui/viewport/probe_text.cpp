#include "viewport/probe_text.h"

#include <QCoreApplication>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "measure/probe_measures.h"
#include "viewport/picking.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

using cloth::ProbeMeasure;
using cloth::Vec3;

constexpr int probe_digits = 3;

QString tr_probe(const char* text) {
  return QCoreApplication::translate("ClothView", text);
}

std::string_view key_of(const cloth::ProbeValue& value) {
  return value.key;
}

/// What stands beside a probe in the view: not the coordinates, which charts and files have.
bool is_shown(const cloth::Probe& probe, const cloth::ProbeValue& value, double number) {
  if (probe.measure == ProbeMeasure::particle)
    return key_of(value) == "speed_m_s" || (key_of(value) == "sag_m" && std::isfinite(number));
  if (probe.measure == ProbeMeasure::line) return key_of(value) != "curvature_1_m" && std::isfinite(number);
  return true;
}

const cloth::ProbeValue& value_of(ProbeMeasure measure, std::string_view key) {
  const auto& values = cloth::facts_of(measure).values;
  return *std::find_if(values.begin(), values.end(), [&](const auto& value) { return key_of(value) == key; });
}

QString named_value(ProbeMeasure measure, std::string_view key, double number) {
  const cloth::ProbeValue& value = value_of(measure, key);
  return QStringLiteral("%1 %2").arg(QString::fromLatin1(value.label), probe_value_text(value, number));
}

}  // namespace

QString probe_value_text(const cloth::ProbeValue& value, double number) {
  if (!std::isfinite(number)) return tr_probe("none");
  const std::string_view key = value.key, unit = value.unit;
  if (key == "at_rest") return number > 0 ? tr_probe("yes") : tr_probe("no");
  if (key == "strain") return quantity_text(100 * number, "%", probe_digits);
  if (unit == "rad") return number_text(180 / std::numbers::pi * number, probe_digits + 1) + u'°';
  return quantity_text(number, value.unit, probe_digits);
}

ProbeLabel probe_label(const cloth::Probe& probe, const std::vector<double>& values) {
  ProbeLabel label{QString::fromStdString(probe.name), {}};
  const auto& all = cloth::facts_of(probe.measure).values;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (is_shown(probe, all[k], values[k])) label.values << named_value(probe.measure, all[k].key, values[k]);
  return label;
}

QStringList probe_preview(ProbeMeasure measure, const std::vector<int>& particles, const ClothFrame& frame) {
  std::vector<Vec3> at;
  for (const int particle : particles) at.push_back(particle_position(frame, particle));
  if (at.empty()) return {};
  if (measure == ProbeMeasure::distance && at.size() == 2)
    return {named_value(measure, "distance_m", cloth::length_of(at))};
  if (measure == ProbeMeasure::angle && at.size() == 3)
    return {named_value(measure, "angle_rad", cloth::angle_at(at[0], at[1], at[2])),
            named_value(measure, "curvature_1_m", cloth::curvature_through(at[0], at[1], at[2]))};
  if (measure == ProbeMeasure::line && at.size() > 1)
    return {named_value(measure, "length_m", cloth::length_of(at)),
            named_value(measure, "curvature_1_m", cloth::largest_curvature(at))};
  return {QStringLiteral("x %1, y %2, z %3 m")
              .arg(fixed_text(at.back().x(), 3), fixed_text(at.back().y(), 3), fixed_text(at.back().z(), 3))};
}

QString probe_hint(ProbeMeasure measure, std::size_t clicked, bool is_mesh) {
  if (measure == ProbeMeasure::particle)
    return tr_probe("Click a particle to measure where it is and how fast.");
  if (measure == ProbeMeasure::distance)
    return clicked == 0 ? tr_probe("Click the first of two particles.")
                        : tr_probe("Click the other particle. Escape: from the beginning.");
  if (measure == ProbeMeasure::angle)
    return clicked == 0   ? tr_probe("Click the first of three particles along the bend.")
           : clicked == 1 ? tr_probe("Click the particle where the angle is. Escape: from the beginning.")
                          : tr_probe("Click the last of the three particles. Escape: from the beginning.");
  if (clicked == 0) return tr_probe("Click the particle where the line begins.");
  return is_mesh
             ? tr_probe("Click the line's next vertex, and the last one twice. Escape: from the beginning.")
             : tr_probe("Click the end of the row, column or diagonal. Escape: from the beginning.");
}

}  // namespace clothlab
