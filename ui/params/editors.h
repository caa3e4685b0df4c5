// The editors of the kinds of parameters.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "params/parameter_editor.h"
#include "params/slider_scale.h"

class QCheckBox;
class QLineEdit;

namespace clothlab {

class MeshButton;
class QuietCombo;
class RangeRow;

/// A number or integer: slider, exact field with its unit, and an "auto" toggle where that word is a value.
/// Its menu varies it for a sweep: a slider with two handles and fields for its range come below.
class NumberEditor : public ParameterEditor {
  Q_OBJECT

 public:
  NumberEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  /// What "auto" comes to at present: shown in the field and taken over when auto is switched off.
  void setAutoValue(std::optional<double> value);

  QList<QWidget*> tabStops() const override;
  void abandonEdits() override;
  void hideTitle() override;

 protected:
  void showValue(const cloth::ParameterValue& value) override;
  void showDefault(const std::optional<cloth::ParameterValue>& fallback) override;
  void markInvalid(bool invalid) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  void makeMenu();
  void followRange();
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
  QToolButton* menu_ = nullptr;
  RangeRow* range_ = nullptr;  ///< while it is varied
  std::optional<double> auto_value_, last_number_;
};

/// Three numbers of one vector, each with an exact field and a slider. A direction may be typed one part at a
/// time: parts that are refused because the others are not there yet wait in their fields.
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

/// One of several words, or one of several sets of words: a combo box with the words of a person.
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

/// A parameter that is free text. What was refused stays in the field, marked, until it is typed anew or
/// Escape brings the value back.
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

/// The mesh of an obstacle or a cloth: its name, a button to choose another by, and what is to say about it.
class MeshEditor : public TextEditor {
  Q_OBJECT

 public:
  MeshEditor(LabDocument& document, const cloth::Parameter& parameter, QWidget* parent);

  /// Whether a cloth may become a grid again.
  void offerGrid(bool offered);
  QList<QWidget*> tabStops() const override;

 Q_SIGNALS:
  void meshChosen();  ///< and taken or refused

 protected:
  void showValue(const cloth::ParameterValue& value) override;

 private:
  MeshButton* button_;
  QLabel* report_;
};

/// Whether a parameter names a mesh.
bool names_mesh(const cloth::Parameter& parameter);

/// How large a mesh is, whether it is closed, and what is unusual about it.
QString mesh_report(const cloth::LoadedMesh& mesh, bool is_cloth);

}  // namespace clothlab
