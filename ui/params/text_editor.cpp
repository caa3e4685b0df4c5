#include "params/text_editor.h"

#include <QHBoxLayout>
#include <QLineEdit>
#include <QToolButton>

namespace clothlab {

TextEditor::TextEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent)
    : ParameterEditor(document, parameter, parent), field_(new QLineEdit(this)) {
  name(*field_, "field");
  controlRow().addWidget(field_, 1);
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

}  // namespace clothlab
