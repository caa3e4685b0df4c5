#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLineEdit>
#include <QToolButton>

#include "params/editors.h"
#include "params/panel_parts.h"

namespace clothlab {

TextEditor::TextEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent)
    : ParameterEditor(document, parameter, parent), field_(new QLineEdit(this)) {
  name(*field_, "field");
  controlRow().addWidget(field_, 1);
  field_->installEventFilter(this);
  connect(field_, &QLineEdit::textEdited, this, [this] { markInvalid(false); });
  connect(field_, &QLineEdit::editingFinished, this, [this] {
    if (!field_->isModified()) return;
    field_->setModified(false);
    commit(field_->text().toStdString());
  });
  refresh();
}

QList<QWidget*> TextEditor::tabStops() const {
  return {field_, &resetButton()};
}

void TextEditor::abandonEdits() {
  const QSignalBlocker quiet(field_);
  field_->setModified(false);
}

void TextEditor::showValue(const cloth::ParameterValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (text && field_->text() != QString::fromStdString(*text)) field_->setText(QString::fromStdString(*text));
}

/// What a person typed. A value that was refused on its way from elsewhere leaves the field as it is.
void TextEditor::markInvalid(bool invalid) {
  set_style_property(*field_, "invalid", invalid && hasPendingText());
}

/// Whether the text is not the document's: being typed, or refused.
bool TextEditor::hasPendingText() const {
  const auto present = value();
  const auto* text = present ? std::get_if<std::string>(&*present) : nullptr;
  return text && field_->text() != QString::fromStdString(*text);
}

bool TextEditor::eventFilter(QObject* watched, QEvent* event) {
  const bool escape =
      event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape;
  if (watched != field_ || !escape || !hasPendingText()) return ParameterEditor::eventFilter(watched, event);
  refresh();
  field_->selectAll();
  return true;
}

}  // namespace clothlab
