// Three numbers of one vector, each with an exact field and a slider. A direction may be typed one part at a
// time: parts that are refused because the others are not there yet wait in their fields.
#pragma once

#include <array>

#include "params/parameter_editor.h"
#include "params/slider_scale.h"

namespace clothlab {

class ExactField;
class ValueSlider;

class VectorEditor : public ParameterEditor {
  Q_OBJECT

 public:
  VectorEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  QList<QWidget*> tabStops() const override;
  void abandonEdits() override;

 protected:
  void showValue(const cloth::ParameterValue& value) override;
  void showDefault(const std::optional<cloth::ParameterValue>& fallback) override;
  void markInvalid(bool invalid) override;

 private:
  void commitComponent(int axis, double number);
  void commitTexts(int edited_axis);
  void step(int axis, int steps);

  SliderScale scale_;
  std::array<ExactField*, 3> fields_;
  std::array<ValueSlider*, 3> sliders_;
  std::array<bool, 3> edited_{};  ///< typed and not accepted yet
};

}  // namespace clothlab
