// The charts' small flat buttons, with paint events of their own so that they follow the theme without style
// sheets.
#pragma once

#include <QAbstractButton>

#include "charts/curve_style.h"

namespace clothlab {

/// A text button, optionally checkable.
class FlatButton : public QAbstractButton {
  Q_OBJECT
 public:
  explicit FlatButton(const QString& text, QWidget* parent = nullptr);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }
  /// Shown in the accent colour although not checkable.
  void setEmphasised(bool emphasised);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void paint_ground(QPainter& painter, bool raised, bool outlined) const;

 private:
  bool emphasised_ = false;
};

/// A curve's line, marker and name; pressing it hides or shows the curve.
class LegendEntry : public FlatButton {
  Q_OBJECT
 public:
  LegendEntry(const QString& name, const CurveStyle& style, QWidget* parent = nullptr);
  QSize sizeHint() const override;
  /// Shows `text`, which is short for `name`.
  void setName(const QString& text, const QString& name);

  /// The same picture and its width for an exported chart.
  static int width_of(const QString& name, const QFont& font);
  static void paint(QPainter& painter, const QRect& rect, const QString& name, const CurveStyle& style,
                    bool shown, const Theme& theme);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  CurveStyle style_;
};

/// The font of everything in a chart: a little smaller than the window's.
QFont chart_font(const QFont& window_font);

}  // namespace clothlab
