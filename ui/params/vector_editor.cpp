#include <QHBoxLayout>
#include <QToolButton>
#include <QVBoxLayout>

#include "params/editors.h"
#include "params/exact_field.h"
#include "params/value_slider.h"
#include "params/wording.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

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
    sliders_[i] = new ValueSlider(this);
    name(*sliders_[i], QString("slider_%1").arg(axes[i]), axes[i]);
    auto* column = spaced(new QVBoxLayout, spacing / 2);
    column->addWidget(fields_[i]);
    column->addWidget(sliders_[i]);
    controlRow().addLayout(column, 1);
    connectParts(
        sliders_[i], fields_[i],
        [this, axis](double position) { commitComponent(axis, scale_.value_at(position)); },
        [this, axis](int steps) { step(axis, steps); });
    connect(fields_[i], &ExactField::committed, this, [this, axis] { commitTexts(axis); });
    connect(fields_[i], &ExactField::textEdited, this, [this, i] { edited_[i] = true; });
  }
  refresh();
}

void VectorEditor::commitComponent(int axis, double number) {
  const auto present = value();
  if (!present) return;
  cloth::Vec3 vector = std::get<cloth::Vec3>(*present);
  vector[axis] = number;
  commit(vector);
}

QList<QWidget*> VectorEditor::tabStops() const {
  return {fields_[0], fields_[1], fields_[2], &resetButton(), sliders_[0], sliders_[1], sliders_[2]};
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
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    fields_[i]->showValue((*vector)[axis]);
    if (!sliders_[i]->isSliderDown()) sliders_[i]->setPosition(scale_.position_of((*vector)[axis]));
  }
}

void VectorEditor::showDefault(const std::optional<cloth::ParameterValue>& fallback) {
  const auto* vector = fallback ? std::get_if<cloth::Vec3>(&*fallback) : nullptr;
  for (int axis = 0; axis < 3; ++axis)
    sliders_[static_cast<std::size_t>(axis)]->setMark(vector ? scale_.position_of((*vector)[axis]) : -1);
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
    const cloth::Quantity typed = typed_quantity(fields_[i]->text(), info().unit);
    if (!typed.ok()) return showRule(QString::fromStdString(typed.rule));
    vector[axis] = typed.value;
  }
  commit(vector);
}

void VectorEditor::step(int axis, int steps) {
  if (const auto present = value())
    commitComponent(axis, scale_.stepped(std::get<cloth::Vec3>(*present)[axis], steps));
}

}  // namespace clothlab
