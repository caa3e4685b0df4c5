// The charts of a comparison: total energy, maximum strain, step time and difference from the reference over
// simulated time, a curve for each pane in its colour and marker.
#pragma once

#include <QTimer>
#include <QWidget>
#include <memory>
#include <vector>

#include "bridge/worker_status.h"
#include "charts/chart_stack.h"
#include "charts/live_chart.h"

namespace clothlab {

class CompareCharts : public QWidget {
  Q_OBJECT

 public:
  explicit CompareCharts(QWidget* parent = nullptr);
  ~CompareCharts() override;

  /// The curves of these panes; of those that were there before with what was recorded of them.
  void setPanes(const cloth::Comparison& comparison);
  void append(const std::vector<CompareSample>& samples);

  /// The charts as they look, `size` in logical px. Empty, or what went wrong in a sentence for the user.
  QString exportPng(const QString& path, QSize size = {1600, 1400});
  QString exportSvg(const QString& path, QSize size = {1600, 1400});
  /// The recorded points of the times shown: time_s, then for each pane A_total_J, A_max_strain, A_step_ms,
  /// A_rms_difference_m (see chart_export.h).
  QString exportCsv(const QString& path) const;
  /// Asks for a file name; the ending chooses PNG, SVG or CSV.
  void saveAs();

  const ChartRecord& record() const { return record_; }
  LiveChart* chart(const QString& key) const;

  QSize sizeHint() const override { return {400, 600}; }
  QSize minimumSizeHint() const override { return {230, 320}; }

 protected:
  void changeEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  struct Curves {
    std::vector<int> styles;
    std::vector<QString> names;
    bool operator==(const Curves&) const = default;
  };

  void makeCharts();
  void deleteCharts();
  void forgetAllBut(const std::vector<int>& styles);
  void changeLater();
  void refresh();
  void layOut();
  void readAt(std::optional<double> time_s);

  Curves curves_;
  std::vector<std::unique_ptr<ChartSpec>> specs_;  ///< charts refer to them
  ChartRecord record_;
  ChartStack stack_;
  QTimer timer_;
  std::optional<double> cursor_;  ///< s
};

}  // namespace clothlab
