// A study's diagram: the engine's plot, fitted into the widget. Resting the pointer on a run names it, a
// double-click asks for it; of a sweep a click does, and the arrow keys and Enter. On the axes of parallel
// coordinates the pointer draws ranges (brushes): runs outside of any are faint and are not there for a
// click.
#pragma once

#include <QPixmap>
#include <QWidget>
#include <optional>
#include <variant>
#include <vector>

#include "report/category_map.h"
#include "report/heat_map.h"
#include "report/line_plot.h"
#include "report/points/parallel_coordinates.h"
#include "studies/painter_canvas.h"

namespace clothlab {

using Diagram = std::variant<cloth::LinePlot, cloth::HeatMap, cloth::CategoryMap, cloth::ParallelCoordinates>;

class StudyPlot : public QWidget {
  Q_OBJECT

 public:
  explicit StudyPlot(QWidget* parent = nullptr);

  void setDiagram(Diagram diagram);
  const Diagram& diagram() const { return diagram_; }

  /// A click on a run opens it, with Ctrl beside those that are open; otherwise a double-click.
  void setClickOpens(bool opens);

  /// Where a run is drawn, in the widget's px; empty if it is not.
  QRectF placeOf(int run) const;
  /// The run under a place and what is said of it.
  const PlotTouch* touchAt(QPointF at) const;

  /// Where the axis of a column of parallel coordinates is drawn, in the widget's px; empty: there is none.
  QRectF placeOfAxis(std::size_t column) const;
  /// Of parallel coordinates; they stay where a diagram of the same columns comes.
  std::vector<cloth::AxisBrush> brushes() const;
  void clearBrushes();

  /// It is to be seen in a scroll area of this size: the diagram fills it, or is as large as it must be for
  /// its labels to stay legible.
  void setRoom(QSize room);

  /// The size of the smallest text in the diagram as it is shown, in px.
  double smallestLabel() const;

  QSize sizeHint() const override { return {760, 360}; }

 Q_SIGNALS:
  void runHovered(const QString& text);  ///< empty: none
  void runActivated(int run);
  void runClicked(int run, bool beside);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void leaveEvent(QEvent*) override { hover({-1e6, -1e6}); }

 private:
  void refresh();
  void keepLegible();
  void hover(QPointF at);
  void mark(const PlotTouch* touch);
  const PlotTouch* next(int dx, int dy) const;
  const PlotTouch* toward(int key) const;
  // study_plot_brush.cpp
  struct BrushDrag {
    std::size_t column = 0;
    double from = 0;  // px
    double value = 0;
    std::optional<cloth::AxisBrush> before;
  };
  cloth::ParallelCoordinates* lines();
  int axisAt(QPointF at) const;
  void keepBrushes(Diagram& next);
  const cloth::AxisBrush* brushOf(std::size_t column) const;
  void setBrush(std::size_t column, std::optional<cloth::AxisBrush> brush);
  void showBrushes();
  bool beginDrag(const QMouseEvent& event);
  void drag(double y);
  void endDrag(double y);
  void hoverAxis(std::size_t column, QPointF at);
  void leaveAxis();
  void chooseAxis(int step);
  bool takeBrushKey(const QKeyEvent& event);
  void moveEnd(bool upper, double part);
  QString axisWords(std::size_t column) const;
  void paintChosenAxis(QPainter& painter) const;

  Diagram diagram_;
  QPixmap picture_;
  std::vector<PlotTouch> touches_;
  QSize room_;
  double smallest_label_ = 0;  // px
  bool stale_ = true, click_opens_ = false;
  bool pressed_ = false;             // not on an axis: its release is a click
  bool over_axis_ = false;           // the pointer
  std::optional<PlotTouch> marked_;  // the run under the pointer, or chosen by key
  std::vector<cloth::ParallelAxis> axes_;
  std::optional<BrushDrag> drag_;
  int chosen_axis_ = -1;       // by key or by the last drag; -1: none
  bool shows_choice_ = false;  // it was by key
};

/// The diagram as a file, on white paper, with its title and caption; `name` ends in .svg, .png or .pdf.
/// Empty when done, else a sentence that says what went wrong.
QString save_diagram(const Diagram& diagram, const QString& name, const QFont& font);

}  // namespace clothlab
