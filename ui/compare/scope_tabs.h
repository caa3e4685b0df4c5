// The tabs above the form of a comparison: whose values the form shows and edits, those that all panes share
// or one pane's. Hidden in a scene. Below the form's parameters it notes which values panes have of their
// own.
#pragma once

#include <QWidget>

class QLabel;
class QTabBar;

namespace clothlab {

class LabDocument;
class ParameterPanel;

class ScopeTabs : public QWidget {
  Q_OBJECT

 public:
  /// Both must outlive the tabs.
  ScopeTabs(LabDocument& document, ParameterPanel& form, QWidget* parent = nullptr);

  /// Shows the document as it is now.
  void refresh();

 private:
  void noteOwnValues();

  LabDocument& document_;
  ParameterPanel& form_;
  QTabBar* tabs_;
  QLabel* hint_;
};

}  // namespace clothlab
