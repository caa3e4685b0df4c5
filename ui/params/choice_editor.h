// One of several words, or one of several sets of words: a combo box with the words of a person.
#pragma once

#include <vector>

#include "params/parameter_editor.h"

namespace clothlab {

class QuietCombo;

class ChoiceEditor : public ParameterEditor {
  Q_OBJECT

 public:
  ChoiceEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  QList<QWidget*> tabStops() const override;

 protected:
  void showValue(const cloth::ParameterValue& value) override;

 private:
  std::vector<cloth::ParameterValue> values_;
  QuietCombo* combo_;
};

}  // namespace clothlab
