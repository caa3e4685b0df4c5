// The window's live charts: energy (J), maximum strain (%) and time per frame (ms) over simulated time (s),
// stacked and aligned. Every sample appended is kept; what is drawn is decimated to the width of the plots.
//
// Costs nothing while hidden or while nothing new arrives: samples are only stored, and drawn once the panel
// is seen.
#pragma once

#include <QSize>
#include <QString>
#include <QWidget>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "bridge/chart_sample.h"

namespace clothlab {

class ChartPanel : public QWidget {
  Q_OBJECT
 public:
  enum class TimeSpan { last_minute, whole_run };
  enum class Chart { energy, strain, frame_time };

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

  void setTimeSpan(TimeSpan span);  ///< and follows the run again
  TimeSpan timeSpan() const;
  void setLogarithmic(Chart chart, bool on);
  bool isLogarithmic(Chart chart) const;
  /// Whether the charts follow the run; zooming and panning stop that, goLive() and a double-click bring it
  /// back.
  bool isLive() const;
  void goLive();
  std::pair<double, double> shownTimes() const;  ///< s

  /// The charts as they look, `size` in logical px. Empty, or what went wrong in a sentence for the user.
  QString exportPng(const QString& path, QSize size = {1600, 1200});
  QString exportSvg(const QString& path, QSize size = {1600, 1200});
  /// The recorded points of the times shown, 17 significant digits, one header row with units (see
  /// chart_export.h).
  QString exportCsv(const QString& path) const;
  /// Asks for a file name; the ending chooses PNG, SVG or CSV.
  void saveAs();

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void liveChanged(bool live);

 protected:
  void changeEvent(QEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  struct Parts;
  void make_bar();
  void lay_out();
  void apply_look();
  void data_changed();
  void view_changed();
  void refresh();
  void update_read_out();
  void update_live_button();

  std::unique_ptr<Parts> parts_;
};

}  // namespace clothlab
