// What to study and how, prefilled from the scene being edited.
#pragma once

#include <QWidget>
#include <variant>
#include <vector>

#include "bridge/study_runner.h"
#include "study/study_axis.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QListWidget;
class QSpinBox;
class QStackedWidget;
class QCheckBox;

namespace clothlab {

/// One axis of a stability map: which parameter, from where to where, how many values.
class AxisChoice : public QWidget {
  Q_OBJECT

 public:
  explicit AxisChoice(QWidget* parent = nullptr);

  /// Offers the scene's numeric parameters and shows `axis`.
  void setScene(const cloth::Scene& scene, const cloth::StudyAxis& axis);

  /// As typed; low and high are NaN where a field is no number.
  cloth::StudyAxis axis() const;

 private:
  void show(const cloth::StudyAxis& axis);
  void chooseParameter(int index) { show(offers_[static_cast<std::size_t>(index)]); }

  QComboBox* parameter_;
  QLineEdit *low_, *high_;
  QSpinBox* count_;
  QCheckBox* logarithmic_;
  std::vector<cloth::StudyAxis> offers_;  ///< what each parameter begins with
};

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
