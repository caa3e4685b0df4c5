// The form of a sweep: the varied parameters with their ranges, the outputs to keep, and how long it would
// take.
#pragma once

#include <QTimer>
#include <QWidget>
#include <set>
#include <variant>
#include <vector>

#include "bridge/sweep_estimate.h"
#include "document/lab_document.h"

class QLabel;
class QListWidget;

namespace clothlab {

class VariedList;

class SweepChoices : public QWidget {
  Q_OBJECT

 public:
  explicit SweepChoices(LabDocument& document, QWidget* parent = nullptr);

  /// The document's scene is another one: offers its outputs.
  void refresh();
  /// Says how many runs it would be, and how long they would take; to be placed where it is in sight.
  QLabel* time() const { return time_; }
  /// The plan, or a sentence that says what is missing.
  std::variant<cloth::SweepPlan, QString> plan() const;
  /// Whether a sweep is the one that the form would make now, whatever values the scene itself has of what
  /// is varied.
  bool describes(const cloth::SweepPlan& plan) const;

 Q_SIGNALS:
  void changed();

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void makeOutputs();
  void showRule(const QString& rule);
  void offerOutputs();
  std::vector<cloth::RunOutput> outputs() const;
  void askForTime();
  void takeTime();
  void showTime(const std::optional<SweepEstimate>& estimate);

  LabDocument& document_;
  std::vector<cloth::RunOutput> offered_;
  std::set<std::string> own_;  ///< names that the user ticked
  bool has_own_ = false, offering_ = false;
  VariedList* varied_ = nullptr;
  QLabel* time_ = nullptr;
  QListWidget* list_ = nullptr;
  QTimer ask_, take_;
  SweepEstimator estimator_;
};

/// The parameters of a scene that a plan varies; "springs.*" is all stiffnesses.
std::vector<std::string> varied_paths(const cloth::SweepPlan& plan, const cloth::Scene& scene);

/// The values of what a plan varies, as `from` has them, put into `scene`.
void copy_varied(const cloth::SweepPlan& plan, const cloth::Scene& from, cloth::Scene& scene);

}  // namespace clothlab
