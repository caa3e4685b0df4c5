// The widget that shows a chart's scene: turns wheel, drags and double-clicks into signals in axis
// coordinates.
//
// It paints the scene like any widget paints itself. A QGraphicsView would flush the whole window at once for
// every scene that changes, and beside an OpenGL view each flush composes the window anew.
#pragma once

#include <QWidget>
#include <optional>

#include "charts/plot_scene.h"

namespace clothlab {

class PlotView : public QWidget {
  Q_OBJECT
 public:
  explicit PlotView(PlotScene* scene, QWidget* parent = nullptr);
  /// Left-drag pulls a zoom box instead of panning.
  void set_box_mode(bool on) { box_mode_ = on; }
  static QString help();
  QSize sizeHint() const override { return scene_->sceneRect().size().toSize(); }

 Q_SIGNALS:
  void hovered(std::optional<double> time_s);
  /// A factor below 1 zooms in; the anchor stays where it is.
  void time_zoomed(double anchor_s, double factor);
  void time_panned(double by_s);
  void y_zoomed(double anchor, double factor);
  void y_panned(double by);
  void box_chosen(clothlab::Range time, clothlab::Range y);
  void reset_wanted();
  void y_reset_wanted();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  enum class Drag { none, pressed, pan, box };
  bool over_y_axis(QPointF at) const { return at.x() < scene_->map().plot.left(); }
  void drag_to(QPointF at);
  void finish_box(QPointF at);
  void end_drag();

  PlotScene* scene_;
  bool box_mode_ = false;
  Drag drag_ = Drag::none;
  bool wants_box_ = false;  ///< what the press becomes once the pointer moves
  bool on_y_axis_ = false;
  QPointF pressed_at_, last_;
};

}  // namespace clothlab
