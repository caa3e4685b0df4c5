// The base of the chart panels: draws recorded samples as they arrive, zooms and pans by mouse, shows values
// under the pointer, and saves pictures and data. Keeps every sample appended; the drawn curves are decimated
// to the width of the plots.
//
// While the panel is hidden, samples are only stored; they are drawn when it is shown. No timer runs while no
// samples arrive.
#pragma once

#include <QTimer>
#include <QWidget>
#include <functional>
#include <map>

#include "charts/chart_export.h"
#include "charts/chart_stack.h"
#include "document/save_dialog.h"

namespace clothlab {

class ChartArea : public QWidget {
  Q_OBJECT
 public:
  /// Whether the charts follow the run; zooming and panning stop that, goLive() and a double-click bring it
  /// back.
  bool isLive() const { return stack_.is_live(); }
  void goLive() { stack_.follow(); }

  /// The charts as they look, `size` in logical px; none: the usual one. Empty, or what went wrong in a
  /// sentence for the user.
  QString exportPng(const QString& path, QSize size = {});
  QString exportSvg(const QString& path, QSize size = {});
  /// The recorded points of the times shown, 17 significant digits, one header row with units (see
  /// chart_export.h).
  QString exportCsv(const QString& path) const { return csvWriter(path)({}); }
  /// Does that with a copy of the points, in any thread; see save_csv().
  std::function<QString(const std::stop_token& stop)> csvWriter(const QString& path) const;
  /// Saves as PNG, SVG or CSV, by the path's suffix; empty, or what went wrong.
  QString save(const QString& path);
  static std::vector<FileKind> kinds();  ///< those three

  /// By the charts' keys; a chart that is not there takes its axis when it comes.
  std::map<QString, bool> logarithmicAxes();
  void setLogarithmicAxes(const std::map<QString, bool>& axes);

  const ChartRecord& record() const { return record_; }

 Q_SIGNALS:
  void liveChanged(bool live);
  void saveWanted();  ///< the panel's Save button was clicked

 protected:
  ChartArea(ChartRecord record, TimeView::Span span, QSize export_size, QWidget* parent);

  /// Of a file with points.
  virtual std::vector<CsvColumn> csv_columns() const = 0;
  /// Shows or hides the message that nothing is recorded yet.
  virtual void show_message() = 0;
  /// Lays out the widgets above the charts. Returns the y coordinate at which the charts begin (px).
  virtual int lay_out_head() = 0;

  void data_changed();
  void view_changed();
  void lay_out();
  void apply_look();

  void changeEvent(QEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

  ChartRecord record_;
  ChartStack stack_;
  std::map<QString, bool> axes_;  ///< by the charts' keys: whether they are logarithmic

 private:
  void refresh();
  void update_read_out();

  QSize export_size_;
  QTimer data_timer_{this};  ///< runs only while new samples have arrived and the panel is visible
  QTimer view_timer_{this};  ///< joins the mouse moves between two paints into one update
  bool stale_ = true;
  bool was_live_ = true;
  std::optional<double> cursor_x_;  ///< px in the plots' views
};

}  // namespace clothlab
