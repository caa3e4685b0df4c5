// The charts of a comparison: total energy, maximum strain, each value of the scene's probes, step time and
// difference from the reference over simulated time, a curve for each pane in its colour and marker. Above
// them is a legend with the panes' methods.
#pragma once

#include "charts/chart_area.h"
#include "charts/chart_buttons.h"

namespace clothlab {

class CompareCharts : public ChartArea {
  Q_OBJECT

 public:
  explicit CompareCharts(QWidget* parent = nullptr);
  ~CompareCharts() override;

  /// The curves of these panes; of those that were there before with what was recorded of them.
  void setPanes(const cloth::Comparison& comparison);
  void append(const std::vector<CompareSample>& samples);

  LiveChart* chart(const QString& key) const;

  QSize sizeHint() const override { return {400, 600}; }
  static QSize least_size() { return {230, 280}; }  ///< without probes
  static constexpr int scrolled_height = 96;        ///< px, of each chart where probes make them many
  /// Every chart stays legible; where there are too many for the window they scroll.
  QSize minimumSizeHint() const override;

 private:
  struct Curves {
    std::vector<int> styles;
    std::vector<QString> names;
    std::vector<std::string> probes;  ///< columns of record.csv
    bool operator==(const Curves&) const = default;
  };

  void makeCharts();
  void deleteCharts();
  void keepSamples(const Curves& before);
  CurveSpec curveOf(std::size_t pane, std::size_t column, double scale) const;
  void addProbeCharts();
  void addChart(std::unique_ptr<ChartSpec> spec, bool has_time_labels, bool logarithmic);
  void appendRow(const CompareSample& sample);
  std::vector<CsvColumn> csv_columns() const override;
  void show_message() override;
  int lay_out_head() override;
  void name_curves(std::vector<QString> titles);
  int lay_out_names();

  Curves curves_;
  std::vector<QString> titles_;      ///< "A  Verlet", for each curve
  std::vector<LegendEntry*> names_;  ///< a legend for all charts, where theirs have no room for the names
  std::vector<std::unique_ptr<ChartSpec>> specs_;  ///< charts refer to them
};

}  // namespace clothlab
