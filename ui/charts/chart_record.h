// The recorded samples of the charts, and the definition of each chart's curves.
#pragma once

#include <QString>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridge/chart_sample.h"
#include "charts/curve_style.h"
#include "charts/nice_range.h"
#include "charts/sample_series.h"

namespace clothlab {

/// The first columns of ChartRecord::samples, in the order of ChartSample; those of probes follow.
enum SampleColumn : std::size_t { kinetic, elastic, gravity, total, strain, step_time, sample_columns };

/// Values measured in a laboratory, drawn over the curve of the same quantity.
struct MeasuredDots {
  std::string column{};                   ///< of record.csv
  std::vector<double> times{}, values{};  ///< s, and the column's unit
  bool operator==(const MeasuredDots&) const = default;
};

struct ChartRecord {
  SampleSeries samples{sample_columns};
  SampleSeries draws{1};  ///< time per drawing (ms), at its own simulated times, because drawing and
                          ///< simulation are not synchronised
  std::optional<double> deformation_rate;  ///< a fraction
  std::vector<std::string> probes;         ///< their columns in record.csv, in the order of the samples
  std::optional<MeasuredDots> measured;

  /// A time before the last one starts a new record: the simulation was reset. A cut deletes only the later
  /// samples.
  void append(std::span<const ChartSample> batch);
  /// Makes room for these probes; those that are known keep their samples.
  void set_probes(const std::vector<std::string>& columns);
  void append_draw_time(double time_s, double milliseconds);
  void clear();
  /// The column of the samples that the measured values are of; nothing where none is.
  std::optional<std::size_t> measured_column() const;
  bool empty() const { return samples.empty() && draws.empty(); }
  /// From the first to the last sample (s); draw times count only while there are no samples.
  Range times() const;
};

enum class Source { samples, draws };

struct CurveSpec {
  QString name;
  Source source = Source::samples;
  std::size_t column = 0;
  double scale = 1;  ///< recorded value to the chart's unit
  CurveStyle style;
  QString short_name{};  ///< in the legend, where there is no room for the name; empty: there is none

  const SampleSeries& series(const ChartRecord& record) const {
    return source == Source::samples ? record.samples : record.draws;
  }
};

struct ChartSpec {
  QString key;    ///< for object names
  QString title;  ///< the y axis' title, with its unit
  QString unit;
  bool from_zero = false;  ///< the automatic linear range begins at zero
  std::vector<CurveSpec> curves;
  bool has_limit = false;  ///< shows the deformation rate as a level line
};

/// Energy, strain and frame time, from top to bottom.
const std::vector<ChartSpec>& chart_specs();
/// Unit of a chart for a probe's values and the factor to it, with the words for its title and its key.
struct ProbeAxis {
  QString unit, title, key;
  double scale = 1;
};
/// `unit` is that of the column; strain is shown in percent, angles in degrees.
ProbeAxis probe_axis(const std::string& column, const std::string& unit);

/// A chart for each unit of these probes' columns; strain and angles in percent and degrees.
std::vector<ChartSpec> probe_chart_specs(const std::vector<std::string>& probes);
/// The deformation rate's line, and its factor to the chart's percent.
const CurveSpec& limit_spec();

}  // namespace clothlab
