// What to study and how, prefilled from the scene being edited.
#pragma once

#include <QWidget>
#include <map>
#include <variant>
#include <vector>

#include "bridge/fit_runner.h"
#include "bridge/study_runner.h"
#include "bridge/sweep_runner.h"

class QComboBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QListWidget;
class QSpinBox;

namespace clothlab {

class AxisChoice;
class FitChoices;
class LabDocument;
class OutputsChoice;
class SweepChoices;

class StudyChoices : public QWidget {
  Q_OBJECT

 public:
  enum class Kind { sweep, fit, work_precision, iterations, stability, extremes, convergence, validation };

  explicit StudyChoices(LabDocument& document, QWidget* parent = nullptr);

  /// Suggests what the user has not set.
  void setScene(const cloth::Scene& scene);
  Kind kind() const;
  void choose(Kind kind);

  /// The order, or a sentence that says which choice breaks a rule.
  std::variant<StudyOrder, QString> order() const;
  /// Likewise of a sweep and of a fit, which are run by others.
  std::variant<SweepOrder, QString> sweepOrder() const;
  std::variant<FitOrder, QString> fitOrder() const;
  const SweepChoices& sweep() const { return *sweep_; }
  FitChoices& fit() const { return *fit_; }
  /// The axes of what is started stay, whatever scene comes.
  void keepAxes();

  /// Whether a study has the inputs that an order would have now.
  bool describes(const cloth::StudyTable& table) const;

 Q_SIGNALS:
  void changed();  ///< an input of the study, the scene too

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void keepPurposeWhole();
  void makeFields();
  void makeRows();
  void connectRows();
  void follow();  ///< the kind
  void offerMethods(const std::vector<std::string>& names);
  void checkMethods(const std::vector<std::string>& names);
  std::vector<std::string> methods() const;
  std::filesystem::path folder() const;
  /// An order without its folder.
  std::variant<StudyOrder, QString> inputs() const;
  std::variant<StudyOrder, QString> stabilityInputs() const;
  std::variant<StudyOrder, QString> precisionInputs() const;
  std::variant<StudyOrder, QString> convergenceInputs() const;
  std::variant<StudyOrder, QString> validationInputs() const;
  std::variant<StudyOrder, QString> iterationsInputs() const;

  cloth::Scene scene_;
  QComboBox* kind_;
  QLabel* purpose_;
  QListWidget *methods_, *protocols_;
  std::map<Kind, std::vector<std::string>> own_methods_;  ///< as the user checked them
  bool checking_ = false;                                 ///< the boxes change, but not by the user
  QFormLayout* form_;
  QLineEdit* horizon_;
  QSpinBox* repeats_;
  AxisChoice *x_, *y_;
  QSpinBox* periods_;
  QComboBox* cases_;
  QLineEdit *cells_, *time_;
  QLineEdit *step_, *before_;  ///< of the convergence of iterations
  QSpinBox* most_;
  OutputsChoice* outputs_;
  SweepChoices* sweep_;
  FitChoices* fit_;
  QLineEdit* folder_;
};

}  // namespace clothlab
