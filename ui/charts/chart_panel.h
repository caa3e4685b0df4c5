// The window's live charts: energy (J), maximum strain (%), the scene's probes, a chart for each unit, and
// time per frame (ms) over simulated time (s), stacked and aligned.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "charts/chart_area.h"

namespace clothlab {

class ChartBar;

class ChartPanel : public ChartArea {
  Q_OBJECT
 public:
  using TimeSpan = TimeView::Span;

  explicit ChartPanel(QWidget* parent = nullptr);
  ~ChartPanel() override;

  /// New samples in time order. A time before the last one is a reset: what was recorded is cleared first.
  void append(std::span<const ChartSample> samples);
  /// One drawing of the view took so long, at this simulated time (s). May be finer or coarser than the
  /// samples.
  void appendDrawTime(double time_s, double milliseconds);
  void clear();
  /// The strain (a fraction) that the scene's limiter allows, drawn as a dashed line; none without a limiter.
  void setDeformationRate(std::optional<double> fraction);

  /// Draws measured values over the curve of their quantity; none: no longer.
  void setMeasured(const std::optional<MeasuredDots>& dots);

  void setTimeSpan(TimeSpan span);  ///< and follows the run again
  TimeSpan timeSpan() const { return stack_.time().span(); }
  Range shownTimes() const { return stack_.shown_times(); }  ///< s

  QSize sizeHint() const override { return {460, 560}; }
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  /// A table was dropped on a chart: `column` of the record is what that chart shows first; empty: none.
  void tableDropped(const QString& file, const std::string& column);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void changeEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void make_bar();
  std::string column_of(const LiveChart& chart) const;
  void follow_probes();
  std::vector<CsvColumn> csv_columns() const override;
  void show_message() override;
  int lay_out_head() override;

  ChartBar* bar_ = nullptr;
  bool box_mode_ = false;
  std::vector<std::string> charted_probes_;
  std::vector<std::unique_ptr<ChartSpec>> probe_specs_;
  std::vector<LiveChart*> probe_charts_;
};

}  // namespace clothlab
