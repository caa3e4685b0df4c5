// A parameter that is free text.
#pragma once

#include "params/parameter_editor.h"

class QLineEdit;

namespace clothlab {

class TextEditor : public ParameterEditor {
  Q_OBJECT

 public:
  TextEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  QList<QWidget*> tabStops() const override;
  void abandonEdits() override;

 protected:
  void showValue(const cloth::ParameterValue& value) override;

 private:
  QLineEdit* field_;
};

}  // namespace clothlab
