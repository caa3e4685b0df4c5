// The Studies dock: choose a study, run it in the background, show its diagram as results arrive, open a run
// in the view, save.
#pragma once

#include <QTimer>
#include <QWidget>
#include <memory>

#include "bridge/fit_runner.h"
#include "bridge/study_runner.h"
#include "document/lab_document.h"
#include "studies/study_choices.h"
#include "studies/study_plot.h"
#include "studies/sweep_study.h"

class QComboBox;
class QLabel;
class QMenu;
class QProgressBar;
class QPushButton;
class QScrollArea;
class QStackedWidget;
class QToolButton;

namespace clothlab {

/// A run of a sweep that is to be looked at.
struct SweptRun {
  cloth::SweepPlan plan;
  cloth::Scene scene;   ///< of the point
  QString words;        ///< "Structural stiffness = 120 N/m"
  bool beside = false;  ///< in a pane of its own, beside those that are open
};

class StudiesPanel : public QWidget {
  Q_OBJECT

 public:
  /// The document must outlive the panel.
  explicit StudiesPanel(LabDocument& document, QWidget* parent = nullptr);
  ~StudiesPanel() override;

  bool isRunning() const { return runner_.is_running() || sweep_.isRunning() || fit_.is_running(); }
  /// Cancels, and waits for one step and the writing of what is finished.
  void stop();
  /// Shows a folder that the command line or the window wrote. Errors are shown in the panel.
  void openFolder(const QString& folder);
  /// The diagram (.svg, .png, .pdf) or its table (.csv); empty, or what went wrong.
  QString save(const QString& name);

  StudyPlot& plot() { return *plot_; }
  StudyChoices& choices() { return *choices_; }
  const cloth::StudyTable* table() const { return table_.get(); }
  QString folder() const { return folder_; }  ///< of what is shown
  SweepStudy& sweep() { return sweep_; }
  /// Prepares a fit to a table of measured values, of this column of the record; empty: as the table says.
  void fitTo(const QString& file, const std::string& column);
  const cloth::FitAccount* fitted() const { return fitted_.get(); }

 Q_SIGNALS:
  /// The user opened a run: its scene, and a note with what the scene does not contain.
  void runOpened(const cloth::Scene& scene, const QString& note);
  /// The user clicked on a point of a sweep.
  void pointOpened(const clothlab::SweptRun& run);
  void finished();

 private:
  void makeLayout();
  QWidget* makeLeft();
  void makeDiagram(QWidget* right);
  QLayout* makeHead(QWidget* right);
  QWidget* makeRight();
  void start();
  void startSweep();
  void poll();
  void pollSweep();
  void showSweepStatus();
  void openPoint(int point, bool beside);
  void showProblemOrSummary(const StudyStatus& status);
  // studies_panel_fit.cpp
  void startFit();
  void pollFit();
  void showFitStatus();
  QString fitSummary() const;
  QString fitProgress(const FitRunStatus& status) const;
  QStringList fitDiagrams() const;
  void showFitDiagram();
  void useFit();
  void leaveFit();
  void openFit(const QString& folder);

  void show(std::shared_ptr<const cloth::StudyTable> table);
  void offerDiagrams();
  void refreshDiagram();
  void compareWithForm();
  void showStatus(const StudyStatus& status);
  void openRun(int run);
  void saveAs();
  void fillRecentMenu();
  void offerShown();
  void say(const QString& text, bool error = false);
  QString summary() const;

  static constexpr int run_interval = 100, follow_interval = 500;  // ms, between two looks

  LabDocument& document_;
  StudyRunner runner_;
  SweepStudy sweep_;  ///< shown where it has a folder
  std::shared_ptr<const cloth::StudyTable> table_;
  QString folder_;
  FitRunner fit_;
  std::shared_ptr<const cloth::FitAccount> fitted_;
  bool shows_fit_ = false;
  std::vector<cloth::VariedParameter> fitted_parameters_;  ///< of the fit that runs
  bool fit_is_opened_ = false;                             ///< from a folder: not what the runner made
  bool was_running_ = false;
  bool choices_stale_ = true;
  QTimer timer_;

  StudyChoices* choices_ = nullptr;
  StudyPlot* plot_ = nullptr;
  QStackedWidget* stack_ = nullptr;  // nothing yet, the diagram
  QScrollArea* plot_area_ = nullptr;
  QLabel *title_ = nullptr, *earlier_ = nullptr, *line_ = nullptr, *empty_ = nullptr,
         *values_ = nullptr;  // of a fit
  QComboBox* against_ = nullptr;
  QProgressBar* bar_ = nullptr;
  QPushButton *start_ = nullptr, *cancel_ = nullptr, *go_on_ = nullptr, *use_ = nullptr;
  QToolButton *save_ = nullptr, *open_ = nullptr;
  QMenu* recent_ = nullptr;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void showEvent(QShowEvent* event) override;
};

}  // namespace clothlab
