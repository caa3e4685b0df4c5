#include "params/panel_parts.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QPainter>
#include <QStyle>
#include <QStylePainter>
#include <QTextDocument>
#include <QToolTip>
#include <QWheelEvent>

#include "theme/theme.h"

namespace clothlab {

void set_style_property(QWidget& widget, const char* name, const QVariant& value) {
  if (widget.property(name) == value) return;
  widget.setProperty(name, value);
  widget.style()->unpolish(&widget);
  widget.style()->polish(&widget);
  widget.update();
}

QFont smaller(QFont font) {
  font.setPointSizeF(font.pointSizeF() - 1);
  return font;
}

QSize ElidedLabel::minimumSizeHint() const {
  return {fontMetrics().averageCharWidth() * 4, sizeHint().height()};
}

void ElidedLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QString shown = fontMetrics().elidedText(text(), Qt::ElideRight, width());
  style()->drawItemText(&painter, contentsRect(), static_cast<int>(alignment()), palette(), isEnabled(),
                        shown, foregroundRole());
}

QuietCombo::QuietCombo(QWidget* parent) : QComboBox(parent) {
  constexpr int most_without_scrolling = 16;  // every method
  setMaxVisibleItems(most_without_scrolling);
  setFocusPolicy(Qt::StrongFocus);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  setMinimumContentsLength(6);
}

/// What the style keeps free on both sides of the entry comes off the room that it names.
int QuietCombo::textRoom() const {
  constexpr int style_margin = 1;
  QStyleOptionComboBox option;
  initStyleOption(&option);
  return style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField, this).width() -
         2 * style_margin;
}

int QuietCombo::widthFor(const QString& text) const {
  return width() - textRoom() + fontMetrics().horizontalAdvance(text);
}

bool QuietCombo::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || shownText() == currentText()) return QComboBox::event(event);
  const QString whole = QStringLiteral("<p><b>%1</b></p>").arg(currentText().toHtmlEscaped());
  const QString tip = Qt::mightBeRichText(toolTip()) ? toolTip() : toolTip().toHtmlEscaped();
  QToolTip::showText(static_cast<QHelpEvent*>(event)->globalPos(), whole + tip, this);
  return true;
}

void QuietCombo::paintEvent(QPaintEvent* event) {
  if (currentIndex() < 0) return QComboBox::paintEvent(event);
  QStylePainter painter(this);
  QStyleOptionComboBox option;
  initStyleOption(&option);
  option.currentText = shownText();
  painter.drawComplexControl(QStyle::CC_ComboBox, option);
  painter.drawControl(QStyle::CE_ComboBoxLabel, option);
}

void QuietCombo::wheelEvent(QWheelEvent* event) {
  event->ignore();
}

SectionHeader::SectionHeader(const QString& title, QWidget* parent) : QAbstractButton(parent) {
  setText(title);
  setCheckable(true);
  setChecked(true);
  setFocusPolicy(Qt::TabFocus);
  setAttribute(Qt::WA_Hover);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  setFont(bold);
}

void SectionHeader::setUnit(const QString& unit) {
  unit_ = unit;
  update();
}

void SectionHeader::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Return:
    case Qt::Key_Enter:
      return click();
    case Qt::Key_Left:
      return setChecked(false);
    case Qt::Key_Right:
      return setChecked(true);
    default:
      QAbstractButton::keyPressEvent(event);
  }
}

void SectionHeader::paintEvent(QPaintEvent*) {
  const Theme& t = theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  if (hasFocus()) {
    painter.setPen(QPen(t.accent, 2));
    painter.drawRoundedRect(QRectF(rect()).adjusted(5, 3, -1, -3), 5, 5);
  }
  const QColor ink = isEnabled() ? t.text : t.disabled_text;
  painter.setPen(QPen(isEnabled() && !underMouse() ? t.muted_text : ink, 1.5, Qt::SolidLine, Qt::RoundCap,
                      Qt::RoundJoin));
  const bool mirrored = isRightToLeft();
  painter.translate(mirrored ? width() - 18 : 18, height() / 2.0);
  if (isChecked())
    painter.rotate(90);
  else if (mirrored)
    painter.rotate(180);
  painter.drawPolyline(QPolygonF({{-1.75, -3.5}, {1.75, 0}, {-1.75, 3.5}}));
  painter.resetTransform();

  painter.setPen(ink);
  const QRect room = QStyle::visualRect(layoutDirection(), rect(), rect().adjusted(32, 0, -8, 0));
  painter.drawText(room, Qt::AlignVCenter | Qt::AlignLeft,
                   fontMetrics().elidedText(text(), Qt::ElideRight, room.width()));
  if (unit_.isEmpty() || !isChecked()) return;
  QFont regular = font();
  regular.setWeight(QFont::Normal);
  painter.setFont(regular);
  painter.setPen(isEnabled() ? t.muted_text : t.disabled_text);
  painter.drawText(rect(), Qt::AlignVCenter | Qt::AlignRight, unit_);
}

}  // namespace clothlab
