// A parameter that is free text. What was refused stays in the field, marked, until it is typed anew or
// Escape brings the value back.
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
  void markInvalid(bool invalid) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  bool hasPendingText() const;

  QLineEdit* field_;
};

}  // namespace clothlab
