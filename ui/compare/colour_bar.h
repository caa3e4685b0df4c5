// What the colours of all panes stand for: one bar beside them.
#pragma once

#include <QWidget>

namespace clothlab {

class ColourBar : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;

  /// `maximum` at the top, times `factor` in the unit of the title; a negative `limit` is none.
  void showRange(const QString& title, double maximum, double factor, double limit);

  double maximum() const { return maximum_; }
  const QString& title() const { return title_; }

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return {sizeHint().width(), 100}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString title_;
  double maximum_ = 1, factor_ = 1, limit_ = -1;
};

}  // namespace clothlab
