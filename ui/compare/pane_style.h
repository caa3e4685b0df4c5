// The colour and marker of a pane in its badge, frame, curves and table row.
#pragma once

#include <QIcon>
#include <QWidget>

#include "charts/curve_style.h"

namespace clothlab {

/// By cloth::style_of(pane): 0 for A, 1 for B, ... The same colours and markers as in reports.
CurveStyle pane_curve(int style);
QColor pane_colour(int style);

/// The pane's marker and its letter.
class PaneBadge : public QWidget {
  Q_OBJECT

 public:
  explicit PaneBadge(QWidget* parent = nullptr);
  void setPane(int style, const QString& name);

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  int style_ = 0;
  QString name_;
};

/// The marker alone, for table cells.
QIcon pane_icon(int style);

}  // namespace clothlab
