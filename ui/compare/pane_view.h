// One pane: the cloth, and above it the pane's letter, method, step, stability, cost and difference from the
// reference.
#pragma once

#include <QFrame>

#include "compare/comparison.h"
#include "compare/ranking.h"
#include "document/remedies.h"
#include "viewport/cloth_view.h"

class QAction;
class QHBoxLayout;
class QLabel;
class QToolButton;

namespace clothlab {

class ExactField;
class NoticeBar;
class PaneBadge;
class QuietCombo;
class Reading;
class StabilityGauge;

class PaneView : public QFrame {
  Q_OBJECT

 public:
  explicit PaneView(QWidget* parent = nullptr);

  ClothView& view() { return *view_; }

  /// What the pane is. `can_grow`: whether there may be another pane.
  void showPane(const cloth::Comparison& comparison, std::size_t pane, bool can_grow);
  /// Whether it is the only one: without a head and a frame.
  void setAlone(bool alone);
  /// Whether there is little height for the panes of a comparison: their views may be very low.
  void setLow(bool low);
  /// Shows the pane's measurements and its state.
  void showResult(const cloth::PaneResult& result, bool has_reference);
  /// Says over the view why the pane stopped and what may help; if it was closed, again.
  void sayStop();
  /// A new run: a stop before is over.
  void forgetStop();
  /// Why the last step typed is not in force; empty: it is.
  void showStepRule(const QString& rule);

  QSize minimumSizeHint() const override;

 Q_SIGNALS:
  void methodChosen(const std::string& method);
  void stepChosen(const cloth::ParameterValue& step);
  void duplicateWanted();
  void removeWanted();
  void referenceWanted();
  void remedyChosen(const clothlab::Remedy& remedy);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void changeEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void makeHeader();
  void makeMenu(QToolButton& button);
  void takeStep(const QString& text);
  void dress();
  int roomyWidth() const;  ///< px
  int headerHeight(int rows) const;
  void suitSize();

  int style_ = 0;
  bool is_alone_ = false, is_low_ = false;
  bool is_roomy_ = true;  ///< the step stands beside the method
  cloth::Scene scene_;
  std::optional<cloth::Divergence> stop_;
  ClothView* view_;
  QWidget* header_;
  PaneBadge* badge_;
  QuietCombo* method_;
  ExactField* step_;
  QToolButton* more_;
  StabilityGauge* gauge_;
  Reading* cost_;
  QLabel* difference_;
  NoticeBar* notice_;
  QHBoxLayout* first_row_ = nullptr;
  QHBoxLayout* second_row_ = nullptr;
  QAction* duplicate_;
  QAction* make_reference_;
};

}  // namespace clothlab
