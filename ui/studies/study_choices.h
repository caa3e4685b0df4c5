// What to study and how, prefilled from the scene being edited.
#pragma once

#include <QWidget>
#include <variant>

#include "bridge/study_runner.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QListWidget;
class QSpinBox;
class QStackedWidget;

namespace clothlab {

class AxisChoice;

class StudyChoices : public QWidget {
  Q_OBJECT

 public:
  enum class Kind { work_precision, stability, extremes };

  explicit StudyChoices(QWidget* parent = nullptr);

  /// Prefills what the user has not changed.
  void setScene(const cloth::Scene& scene);
  Kind kind() const;
  void setKind(Kind kind);

  /// The order, or a sentence that says which choice breaks a rule.
  std::variant<StudyOrder, QString> order() const;

 private:
  void makeForms();
  void follow();  ///< the kind
  void checkMethods(const std::vector<std::string>& names);
  std::vector<std::string> methods() const;
  std::variant<StudyOrder, QString> stabilityOrder() const;

  cloth::Scene scene_;
  QComboBox* kind_;
  QLabel* purpose_;
  QListWidget* methods_;
  QStackedWidget* forms_;
  QLineEdit* horizon_;
  QSpinBox* repeats_;
  AxisChoice *x_, *y_;
  QSpinBox* periods_;
  QComboBox* cases_;
  QLineEdit* folder_;
};

}  // namespace clothlab
