// A number or integer: slider, exact field with its unit, and an "auto" toggle where that word is a value.
#pragma once

#include <optional>

#include "params/parameter_editor.h"
#include "params/slider_scale.h"

class QCheckBox;

namespace clothlab {

class ExactField;
class ValueSlider;

class NumberEditor : public ParameterEditor {
  Q_OBJECT

 public:
  NumberEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  /// What "auto" comes to at present: shown in the field and taken over when auto is switched off.
  void setAutoValue(std::optional<double> value);

  QList<QWidget*> tabStops() const override;
  void abandonEdits() override;

 protected:
  void showValue(const cloth::ParameterValue& value) override;
  void showDefault(const std::optional<cloth::ParameterValue>& fallback) override;
  void markInvalid(bool invalid) override;

 private:
  void makeAutoToggle();
  void commitText(const QString& text);
  void commitNumber(double number);
  void commitAuto(bool on);
  void step(int steps);
  void showAuto();
  double startingNumber() const;

  SliderScale scale_;
  ValueSlider* slider_;
  ExactField* field_;
  QCheckBox* auto_ = nullptr;
  std::optional<double> auto_value_, last_number_;
};

}  // namespace clothlab
