#include "params/exact_field.h"

#include <QKeyEvent>
#include <QPainter>
#include <QStyle>
#include <QStyleOptionFrame>

#include "params/panel_parts.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

constexpr int gap = spacing / 2;

int steps_of(const QKeyEvent& key) {
  if (key.modifiers() & ~(Qt::ShiftModifier | Qt::KeypadModifier)) return 0;
  const int arrow = key.modifiers() & Qt::ShiftModifier ? 10 : 1;
  switch (key.key()) {
    case Qt::Key_Up:
      return arrow;
    case Qt::Key_Down:
      return -arrow;
    case Qt::Key_PageUp:
      return 10;
    case Qt::Key_PageDown:
      return -10;
    default:
      return 0;
  }
}

}  // namespace

ExactField::ExactField(QWidget* parent) : QLineEdit(parent) {
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  setMaxLength(64);
  setLayoutDirection(Qt::LeftToRight);  // numbers and units are read so in every script
  connect(this, &QLineEdit::textEdited, this, [this] { setInvalid(false); });
  connect(this, &QLineEdit::textChanged, this, &ExactField::updateMargins);
}

void ExactField::setUnit(const std::string& unit) {
  unit_ = unit;
  updateMargins();
}

void ExactField::setPrefix(const QString& text) {
  prefix_ = text;
  updateMargins();
}

/// None beside a text with letters other than an exponent's: it has a unit of its own.
QString ExactField::shownUnit() const {
  if (text().isEmpty() && !placeholderText().isEmpty()) return {};
  if (text() == short_ && !hasFocus()) return short_unit_;
  QString typed = text();
  typed.remove("pi");
  for (qsizetype at = 0; at < typed.size(); ++at) {
    const bool is_exponent =
        typed[at].toLower() == 'e' && at > 0 && (typed[at - 1].isDigit() || typed[at - 1] == '.');
    if ((typed[at].isLetter() && !is_exponent) || QStringLiteral("%°").contains(typed[at])) return {};
  }
  return unit_text(unit_);
}

void ExactField::updateMargins() {
  const auto room = [this](const QString& text) {
    return text.isEmpty() ? 0 : fontMetrics().horizontalAdvance(text) + gap;
  };
  setTextMargins(room(prefix_), 0, room(shownUnit()), 0);
}

void ExactField::showValue(double value) {
  constexpr int short_digits = 6;
  const cloth::ShownQuantity shown = cloth::shown_quantity(value, unit_, short_digits);
  short_ = localised(QString::fromStdString(shown.number));
  short_unit_ = QString::fromStdString(shown.unit);
  exact_ = number_text(value, cloth::all_digits);
  setPlaceholderText({});
  abandonEdit();
}

void ExactField::showNothing(const QString& hint) {
  short_.clear();
  exact_.clear();
  setPlaceholderText(hint);
  abandonEdit();
}

void ExactField::abandonEdit() {
  setInvalid(false);
  setModified(false);
  showText();
}

void ExactField::showText() {
  const QString& wanted = hasFocus() ? exact_ : short_;
  if (text() == wanted) return updateMargins();
  const bool all_selected = hasSelectedText() && selectedText() == text();
  setText(wanted);
  if (all_selected)
    selectAll();
  else if (!hasFocus())
    setCursorPosition(0);  // a long number shows its first digits
}

void ExactField::setInvalid(bool invalid) {
  if (invalid_ == invalid) return;
  invalid_ = invalid;
  set_style_property(*this, "invalid", invalid);
}

void ExactField::commit() {
  if (!isModified()) return;
  setModified(false);
  Q_EMIT committed(text());
}

bool ExactField::event(QEvent* event) {
  // With nothing typed, undo and redo are the document's, not the line's, and Space plays.
  if (event->type() == QEvent::ShortcutOverride && !isModified()) {
    auto* key = static_cast<QKeyEvent*>(event);
    if (key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo) || key->key() == Qt::Key_Space) {
      event->ignore();
      return false;
    }
  }
  return QLineEdit::event(event);
}

void ExactField::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) {
    commit();
    selectAll();
    return;
  }
  if (event->key() == Qt::Key_Escape && hasPendingText()) {
    abandonEdit();
    selectAll();
    Q_EMIT abandoned();
    return;
  }
  if (const int steps = steps_of(*event); steps != 0) {
    stepping_ = true;
    commit();
    if (!invalid_) Q_EMIT stepped(steps);
    return;
  }
  QLineEdit::keyPressEvent(event);
}

void ExactField::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat() && steps_of(*event) != 0) endSteps();
  QLineEdit::keyReleaseEvent(event);
}

void ExactField::endSteps() {
  if (!stepping_) return;
  stepping_ = false;
  Q_EMIT stepsEnded();
}

void ExactField::focusInEvent(QFocusEvent* event) {
  if (!hasPendingText()) showText();
  QLineEdit::focusInEvent(event);
  select_on_release_ = event->reason() == Qt::MouseFocusReason;
}

void ExactField::focusOutEvent(QFocusEvent* event) {
  QLineEdit::focusOutEvent(event);
  endSteps();
  if (event->reason() == Qt::PopupFocusReason) return;
  commit();
  if (!hasPendingText()) showText();
}

void ExactField::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && !hasFocus()) select_on_release_ = true;
  QLineEdit::mousePressEvent(event);
}

void ExactField::mouseReleaseEvent(QMouseEvent* event) {
  QLineEdit::mouseReleaseEvent(event);
  if (select_on_release_ && event->button() == Qt::LeftButton && !hasSelectedText()) selectAll();
  select_on_release_ = false;
}

void ExactField::changeEvent(QEvent* event) {
  QLineEdit::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) updateMargins();
}

void ExactField::paintEvent(QPaintEvent* event) {
  QLineEdit::paintEvent(event);
  QStyleOptionFrame option;
  initStyleOption(&option);
  const QRect inside =
      style()->subElementRect(QStyle::SE_LineEditContents, &option, this).adjusted(2, 0, -2, 0);
  QPainter painter(this);
  painter.setPen(isEnabled() ? theme().muted_text : theme().disabled_text);
  painter.drawText(inside, Qt::AlignVCenter | Qt::AlignRight | Qt::AlignAbsolute, shownUnit());
  painter.drawText(inside, Qt::AlignVCenter | Qt::AlignLeft | Qt::AlignAbsolute, prefix_);
}

}  // namespace clothlab
