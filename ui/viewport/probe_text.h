// What the view says of probes: readings of a scene's probes, and of the particles under the cursor.
#pragma once

#include <QString>
#include <vector>

#include "bridge/frame.h"

namespace clothlab {

/// One value with its unit and a prefix: strains in percent, angles in degrees; "none" where it is not
/// defined.
QString probe_value_text(const cloth::ProbeValue& value, double number);

/// The label beside a probe: its name, then values with their names.
struct ProbeLabel {
  QString name;
  QStringList values;  ///< "sag 21.3 cm"
};
/// `values` has one number for each value of the measure.
ProbeLabel probe_label(const cloth::Probe& probe, const std::vector<double>& values);

/// What a probe of this measure at these particles would read off a frame's positions: without speed, and
/// without what it takes the start to know.
QStringList probe_preview(cloth::ProbeMeasure measure, const std::vector<int>& particles,
                          const ClothFrame& frame);

/// What to click next for a probe of this measure, `clicked` particles of which are chosen; a sentence.
QString probe_hint(cloth::ProbeMeasure measure, std::size_t clicked, bool is_mesh);

}  // namespace clothlab
