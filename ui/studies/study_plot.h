// A study's diagram: the engine's plot, fitted into the widget. Resting the pointer on a run names it, a
// double-click asks for it.
#pragma once

#include <QPixmap>
#include <QWidget>
#include <variant>
#include <vector>

#include "report/category_map.h"
#include "report/heat_map.h"
#include "report/line_plot.h"
#include "studies/painter_canvas.h"

namespace clothlab {

using Diagram = std::variant<cloth::LinePlot, cloth::HeatMap, cloth::CategoryMap>;

class StudyPlot : public QWidget {
  Q_OBJECT

 public:
  explicit StudyPlot(QWidget* parent = nullptr);

  void setDiagram(Diagram diagram);
  const Diagram& diagram() const { return diagram_; }

  /// Where a run is drawn, in the widget's px; empty if it is not.
  QRectF placeOf(int run) const;
  /// The run under a place and what is said of it.
  const PlotTouch* touchAt(QPointF at) const;

  /// It is to be seen in a scroll area of this size: the diagram fills it, or is as large as it must be for
  /// its labels to stay legible.
  void setRoom(QSize room);

  /// The size of the smallest text in the diagram as it is shown, in px.
  double smallestLabel() const;

  QSize sizeHint() const override { return {760, 360}; }

 Q_SIGNALS:
  void runHovered(const QString& text);  ///< empty: none
  void runActivated(int run);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent*) override { hover({-1e6, -1e6}); }

 private:
  void refresh();
  void keepLegible();
  void hover(QPointF at);

  Diagram diagram_;
  QPixmap picture_;
  std::vector<PlotTouch> touches_;
  QSize room_;
  double smallest_label_ = 0;  // px
  bool stale_ = true;
  QRectF marked_;  // of the hovered run
};

/// The diagram as a file, on white paper, with its title and caption; `name` ends in .svg, .png or .pdf.
/// Empty when done, else a sentence that says what went wrong.
QString save_diagram(const Diagram& diagram, const QString& name, const QFont& font);

}  // namespace clothlab
