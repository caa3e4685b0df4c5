// Small parts that the forms are made of.
#pragma once

#include <QAbstractButton>
#include <QComboBox>
#include <QLabel>

namespace clothlab {

/// Sets a property that the style sheet asks for, and has the widget restyled.
void set_style_property(QWidget& widget, const char* name, const QVariant& value);

/// The same font, a point smaller: for what is said below a control.
QFont smaller(QFont font);

/// One line that ends in an ellipsis where it has no room.
class ElidedLabel : public QLabel {
  Q_OBJECT

 public:
  using QLabel::QLabel;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
};

/// A combo box that leaves the wheel to the panel and can be narrower than its longest entry: what has no
/// room ends in an ellipsis, and the tooltip then begins with the whole of it.
class QuietCombo : public QComboBox {
  Q_OBJECT

 public:
  explicit QuietCombo(QWidget* parent = nullptr);

  /// The present entry as it is painted, whole or elided.
  QString shownText() const { return fontMetrics().elidedText(currentText(), Qt::ElideRight, textRoom()); }
  /// The width at which this entry is whole.
  int widthFor(const QString& text) const;

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  int textRoom() const;  ///< px
};

/// The head of a section: chevron and title, the whole width a button. Checked means open.
class SectionHeader : public QAbstractButton {
  Q_OBJECT

 public:
  explicit SectionHeader(const QString& title, QWidget* parent = nullptr);
  void setUnit(const QString& unit);  ///< muted, at the right end
  QSize sizeHint() const override { return {fontMetrics().horizontalAdvance(text()) + 32, 32}; }
  QSize minimumSizeHint() const override { return {64, 32}; }

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  QString unit_;
};

}  // namespace clothlab
