// What the results of a sweep look like in the Studies dock. One parameter: a curve of each output. A grid
// over two: a map of each. Others: parallel coordinates, coloured by one output. Points have their numbers
// as tags.
#pragma once

#include <QStringList>

#include "bridge/sweep_watch.h"
#include "studies/study_plot.h"

namespace clothlab {

/// "sag at the end", "max strain, largest"
QString output_words(const cloth::RunOutput& output);
/// The unit of its values; empty for a pure number.
std::string output_unit(const cloth::RunOutput& output);

/// One for each output.
QStringList sweep_diagram_names(const SweepView& view);

/// nullopt: there is no row to draw yet. Precondition: `output` is one of the plan's.
std::optional<Diagram> sweep_diagram(const SweepView& view, std::size_t output);

/// "springs.structural = 120 N/m, springs.shear = 60 N/m", with the parameters' labels.
QString point_words(const cloth::SweepPlan& plan, std::int64_t point);

}  // namespace clothlab
