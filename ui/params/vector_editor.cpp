#include "params/vector_editor.h"

#include <QHBoxLayout>
#include <QToolButton>

#include "params/exact_field.h"
#include "params/number_text.h"
#include "params/wording.h"
#include "theme/theme.h"

namespace clothlab {
namespace {

constexpr std::array<const char*, 3> axes{"x", "y", "z"};

}  // namespace

VectorEditor::VectorEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent)
    : ParameterEditor(document, parameter, parent), scale_(parameter.info) {
  controlRow().setSpacing(spacing / 2);
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    fields_[i] = new ExactField(this);
    name(*fields_[i], QString("field_%1").arg(axes[i]), axes[i]);
    fields_[i]->setPrefix(axes[i]);
    controlRow().addWidget(fields_[i], 1);
    connectField(axis);
  }
  refresh();
}

void VectorEditor::connectField(int axis) {
  const auto i = static_cast<std::size_t>(axis);
  connect(fields_[i], &ExactField::committed, this, [this, axis] { commitTexts(axis); });
  connect(fields_[i], &ExactField::abandoned, this, &VectorEditor::refresh);
  connect(fields_[i], &ExactField::textEdited, this, [this, i] {
    edited_[i] = true;
    showRule({});
  });
  connect(fields_[i], &ExactField::stepped, this, [this, axis](int steps) {
    if (!stepping_) document().beginDrag();
    stepping_ = true;
    step(axis, steps);
  });
  connect(fields_[i], &ExactField::stepsEnded, this, [this] {
    if (stepping_) document().endDrag();
    stepping_ = false;
  });
}

QList<QWidget*> VectorEditor::tabStops() const {
  return {fields_[0], fields_[1], fields_[2], &resetButton()};
}

void VectorEditor::abandonEdits() {
  for (ExactField* field : fields_) {
    const QSignalBlocker quiet(field);
    field->abandonEdit();
  }
  edited_ = {};
}

void VectorEditor::showValue(const cloth::ParameterValue& value) {
  const auto* vector = std::get_if<cloth::Vec3>(&value);
  if (!vector) return;
  edited_ = {};
  for (int axis = 0; axis < 3; ++axis) fields_[static_cast<std::size_t>(axis)]->showValue((*vector)[axis]);
}

void VectorEditor::markInvalid(bool invalid) {
  for (std::size_t i = 0; i < fields_.size(); ++i) fields_[i]->setInvalid(invalid && edited_[i]);
}

void VectorEditor::commitTexts(int edited_axis) {
  edited_[static_cast<std::size_t>(edited_axis)] = true;
  const auto present = value();
  if (!present) return;
  cloth::Vec3 vector = std::get<cloth::Vec3>(*present);
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (!edited_[i]) continue;
    const QString text = fields_[i]->text();
    const auto number = number_from(text, unit_text(info().unit));
    if (!number)
      return showRule(text.contains(',') ? tr("must be a number with a decimal point, like 1.5")
                                         : tr("must be a number"));
    vector[axis] = *number;
  }
  commit(vector);
}

void VectorEditor::step(int axis, int steps) {
  const auto present = value();
  if (!present) return;
  cloth::Vec3 vector = std::get<cloth::Vec3>(*present);
  vector[axis] = scale_.stepped(vector[axis], steps);
  commit(vector);
}

}  // namespace clothlab
