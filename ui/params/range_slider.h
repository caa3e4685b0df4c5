// A range on the scale of a parameter's slider: two handles, and the stretch between them. Each handle is a
// slider of its own for the keyboard and for screen readers.
#pragma once

#include <QSlider>

namespace clothlab {

class RangeHandle;

class RangeSlider : public QWidget {
  Q_OBJECT

 public:
  enum class End { from, to };

  /// `label`: of the parameter, for the names of the handles.
  explicit RangeSlider(const QString& label, QWidget* parent = nullptr);

  void setPositions(double from, double to);  ///< 0 (left) to 1; emits no signal
  /// A small tick at the parameter's present value.
  void setMark(double position);
  QSlider* handle(End end) const;

  QSize sizeHint() const override { return {120, 20}; }
  QSize minimumSizeHint() const override { return {60, 20}; }

 Q_SIGNALS:
  void dragBegan();                                             ///< before the first change by mouse or key
  void dragEnded();                                             ///< after the last one
  void moved(clothlab::RangeSlider::End end, double position);  ///< by mouse, or by the Home and End keys
  void stepped(clothlab::RangeSlider::End end, int steps);      ///< by arrow and page keys

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;

 private:
  friend class RangeHandle;
  double xOf(double position) const;
  double positionAt(double x) const;
  void place();
  void begin();
  void end();
  void drag(End end, double x);

  RangeHandle* handles_[2];
  double positions_[2] = {0, 1};
  double mark_ = -1;
  bool dragging_ = false;
  RangeHandle* pressed_ = nullptr;  ///< by a press beside the handles
};

}  // namespace clothlab
