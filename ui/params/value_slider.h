// A slider that moves to where it is pressed, reports keys as steps of the value, and leaves wheel events to
// the panel.
#pragma once

#include <QSlider>

namespace clothlab {

class ValueSlider : public QSlider {
  Q_OBJECT

 public:
  explicit ValueSlider(QWidget* parent = nullptr);

  void setPosition(double position);  ///< 0 (left) to 1; emits no signal
  double position() const;
  /// A small tick where the default is, seen while the handle is elsewhere; negative: none.
  void setMark(double position);

 Q_SIGNALS:
  void dragBegan();             ///< before the first change by mouse or key
  void dragEnded();             ///< after the last one
  void moved(double position);  ///< by mouse, or by the Home and End keys
  void stepped(int steps);      ///< by arrow or page keys

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  QRect handle() const;
  double positionAt(double x) const;
  void begin();
  void end();
  void goTo(double position);

  bool dragging_ = false;
  double grip_ = 0;  ///< px from the handle's centre to where the mouse pressed it
  double mark_ = -1;
};

}  // namespace clothlab
