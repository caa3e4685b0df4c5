// StudiesPanel: runs studies and shows what they have come to.
#include <QComboBox>
#include <QDesktopServices>
#include <QDir>
#include <QEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QStackedWidget>
#include <QToolButton>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "analysis/fit_report.h"
#include "document/result_files.h"
#include "document/save_dialog.h"
#include "params/panel_parts.h"
#include "studies/fit_choices.h"
#include "studies/studies_panel.h"
#include "studies/study_library.h"
#include "studies/sweep_choices.h"
#include "studies/sweep_diagrams.h"
#include "study/extremes_report.h"
#include "study/grid_convergence_report.h"
#include "study/iterations_report.h"
#include "study/stability_report.h"
#include "study/study_runs.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"
#include "sweep/sweep_points.h"
#include "theme/theme.h"
#include "widgets/building.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

QString time_text(double seconds) {
  const int whole = static_cast<int>(std::ceil(seconds));
  return whole < 60 ? QObject::tr("%1 s").arg(whole)
                    : QObject::tr("%1 min %2 s").arg(whole / 60).arg(whole % 60, 2, 10, QChar('0'));
}

bool is_timed(const cloth::WorkPrecision& study) {
  return std::any_of(study.methods.begin(), study.methods.end(), [](const cloth::MethodStudy& method) {
    return std::any_of(method.runs.begin(), method.runs.end(),
                       [](const cloth::WorkPrecisionRun& run) { return !run.samples.empty(); });
  });
}

/// What the box above the diagram offers of a kind of study; nothing: it has one diagram.
QStringList diagrams_of(const cloth::StudyTable& table) {
  if (std::holds_alternative<cloth::WorkPrecision>(table))
    return {QObject::tr("against run time"), QObject::tr("against step"),
            QObject::tr("against force evaluations")};
  if (std::holds_alternative<cloth::GridConvergence>(table))
    return {QObject::tr("values"), QObject::tr("errors")};
  if (std::holds_alternative<cloth::IterationsStudy>(table))
    return {QObject::tr("against iterations"), QObject::tr("against time")};
  QStringList names;
  if (const auto* validation = std::get_if<cloth::ValidationStudy>(&table))
    for (const std::string& name : cloth::diagram_names(*validation)) names << QString::fromStdString(name);
  return names;
}

/// `which` of diagrams_of the table.
Diagram diagram_of(const cloth::StudyTable& table, int which) {
  if (const auto* study = std::get_if<cloth::WorkPrecision>(&table)) {
    // Before the first timing there is nothing to show against the time.
    const auto against = static_cast<cloth::PlotAgainst>(which);
    const bool timed = against != cloth::PlotAgainst::run_time || is_timed(*study);
    return cloth::study_plot(*study, timed ? against : cloth::PlotAgainst::force_evaluations);
  }
  if (const auto* map = std::get_if<cloth::StabilityMap>(&table)) return cloth::study_plot(*map);
  if (const auto* grids = std::get_if<cloth::GridConvergence>(&table))
    return cloth::study_plot(*grids, static_cast<cloth::GridPlot>(which));
  if (const auto* iterations = std::get_if<cloth::IterationsStudy>(&table))
    return cloth::study_plot(*iterations, static_cast<cloth::IterationsAgainst>(which));
  if (const auto* validation = std::get_if<cloth::ValidationStudy>(&table))
    return cloth::study_plot(*validation, static_cast<std::size_t>(which));
  return cloth::study_plot(std::get<cloth::ExtremesTable>(table));
}

QString kind_title(const cloth::StudyTable& table) {
  const QString titles[] = {QObject::tr("Work-precision"),
                            QObject::tr("Stability map"),
                            QObject::tr("Extreme cases"),
                            QObject::tr("Grid convergence"),
                            QObject::tr("Materials against exact solutions"),
                            QObject::tr("Convergence of iterations")};
  return titles[table.index()];
}

}  // namespace

void StudiesPanel::start() {
  if (const StudyStatus status = runner_.status(); status.running && !status.writing) return;
  if (sweep_.isRunning() || fit_.is_running()) return;
  if (choices_->kind() == StudyChoices::Kind::fit) return startFit();
  if (choices_->kind() == StudyChoices::Kind::sweep) return startSweep();
  if (was_running_ && table_) recent_studies.remember(folder_);  // which is still being written
  auto order = choices_->order();
  if (const QString* problem = std::get_if<QString>(&order)) {
    say(*problem, true);
    return;
  }
  StudyOrder& chosen = std::get<StudyOrder>(order);
  sweep_.leave();
  leaveFit();
  plot_->setClickOpens(false);
  choices_->keepAxes();
  folder_ = QString::fromStdString(chosen.folder.string());
  table_.reset();
  compareWithForm();
  stack_->setCurrentIndex(0);
  empty_->setText(tr("<p><b>The study runs.</b></p><p>Its first results will be drawn here.</p>"));
  runner_.start(std::move(chosen));
  was_running_ = true;
  timer_.start(run_interval);
  poll();
}

void StudiesPanel::startSweep() {
  if (runner_.is_running()) return say(tr("The results of the study before are still being written."), true);
  auto order = choices_->sweepOrder();
  if (const QString* problem = std::get_if<QString>(&order)) return say(*problem, true);
  SweepOrder& chosen = std::get<SweepOrder>(order);
  folder_ = QString::fromStdString(chosen.folder.string());
  table_.reset();
  leaveFit();
  plot_->setClickOpens(true);
  plot_->clearBrushes();
  stack_->setCurrentIndex(0);
  empty_->setText(tr("<p><b>The sweep runs.</b></p><p>Its first runs will be drawn here.</p>"));
  sweep_.start(std::move(chosen));
  was_running_ = true;
  timer_.start(run_interval);
  poll();
}

void StudiesPanel::stop() {
  runner_.cancel();
  fit_.cancel();
  sweep_.stop();
  fit_.wait();
  runner_.wait();
  poll();
}

void StudiesPanel::pollSweep() {
  const bool runs = sweep_.isRunning();  // asked first: what ends meanwhile is shown by the next look
  if (sweep_.poll()) {
    offerDiagrams();
    refreshDiagram();
    compareWithForm();
  }
  showSweepStatus();
  if (runs) return;
  timer_.setInterval(follow_interval);
  if (!sweep_.isFollowed()) timer_.stop();
  if (!std::exchange(was_running_, false)) return;
  if (SweepStudy::isSweep(folder_)) recent_studies.remember(folder_);
  Q_EMIT finished();
}

void StudiesPanel::showSweepStatus() {
  const SweepStatus status = sweep_.status();
  const auto& view = sweep_.view();
  const bool misses = view && view->results.missing() > 0;
  start_->setEnabled(!status.running);
  choices_->setEnabled(!status.running);
  cancel_->setVisible(status.running);
  cancel_->setEnabled(!status.stopping);
  go_on_->setVisible(misses && !status.running);
  open_->setEnabled(!status.running);
  save_->setEnabled(view != nullptr);
  bar_->setVisible(status.running || misses);
  const double done = view && view->results.points > 0 ? static_cast<double>(view->results.rows.size()) /
                                                             static_cast<double>(view->results.points)
                                                       : 0;
  bar_->setValue(static_cast<int>(1000 * done));
  against_->setVisible(against_->count() > 0 && view);
  title_->setText(sweep_.title());
  const QString problem = sweep_.problem();
  if (!problem.isEmpty())
    say(tr("The sweep: %1").arg(problem), true);
  else
    say(status.running ? sweep_.progress() : sweep_.summary());
}

void StudiesPanel::openPoint(int point, bool beside) {
  const auto& view = sweep_.view();
  if (!view) return;
  const cloth::SweepPlan& plan = view->folder.plan;
  cloth::SceneReading reading = cloth::SweepPoints(plan).scene(point);
  if (!reading.scene || !reading.problems.empty())
    return say(reading.problems.empty() ? tr("This point has no scene.")
                                        : QString::fromStdString(reading.problems.front().text()),
               true);
  Q_EMIT pointOpened({plan, std::move(*reading.scene), point_words(plan, point), beside});
}

void StudiesPanel::poll() {
  if (shows_fit_) return pollFit();
  if (sweep_.isShown()) return pollSweep();
  const StudyStatus status = runner_.status();
  if (auto table = runner_.take()) show(std::move(table));
  showStatus(status);
  if (status.running || !was_running_) return;
  was_running_ = false;
  timer_.stop();
  if (status.problem.empty() && table_) recent_studies.remember(folder_);
  Q_EMIT finished();
}

void StudiesPanel::showStatus(const StudyStatus& status) {
  const bool computing = status.running && !status.writing;
  start_->setEnabled(!computing);
  choices_->setEnabled(!computing);
  cancel_->setVisible(computing);
  cancel_->setEnabled(!status.stopping);
  open_->setEnabled(!status.running);
  go_on_->hide();
  save_->setEnabled(table_ != nullptr);
  bar_->setVisible(status.running);
  bar_->setValue(static_cast<int>(1000 * status.fraction));
  against_->setVisible(table_ && against_->count() > 0);
  title_->setText(
      table_ ? tr("%1: %2").arg(kind_title(*table_), QString::fromStdString(cloth::title_of(*table_)))
             : QString());
  if (!status.earlier_problem.empty()) {
    say(tr("The results of the study before could not be written. %1")
            .arg(QString::fromStdString(status.earlier_problem)),
        true);
  } else if (status.running) {
    QString text = status.stopping && computing ? tr("stopping") : sentence_text(status.text);
    if (computing) text += tr(" – %1 %").arg(static_cast<int>(100 * status.fraction));
    if (status.left && !status.stopping) text += tr(", about %1 left").arg(time_text(*status.left));
    say(text);
  } else {
    showProblemOrSummary(status);
  }
}

void StudiesPanel::showProblemOrSummary(const StudyStatus& status) {
  if (!status.problem.empty())
    say(tr("The results could not be written. %1").arg(QString::fromStdString(status.problem)), true);
  else if (was_running_ || table_)
    say(summary());
}

QString StudiesPanel::summary() const {
  if (shows_fit_) return fitSummary();
  if (sweep_.isShown()) return sweep_.summary();
  if (!table_) return {};
  QString text = tr("%1 runs%2, in %3")
                     .arg(cloth::finished_runs(*table_))
                     .arg(cloth::is_complete(*table_) ? QString() : tr(" (stopped before the end)"))
                     .arg(shown_path(folder_));
  if (const auto* grids = std::get_if<cloth::GridConvergence>(table_.get()))
    for (std::size_t k = 0; k < grids->outputs.size(); ++k)
      text += QString(". %1: %2")
                  .arg(QString::fromStdString(cloth::words_of_output(grids->outputs[k])),
                       QString::fromStdString(cloth::richardson_of(*grids, k).words).chopped(1));
  if (const auto* iterations = std::get_if<cloth::IterationsStudy>(table_.get()))
    if (!iterations->failure.empty())
      text += tr(". There is nothing to measure against: %1").arg(sentence_text(iterations->failure));
  if (const auto* validation = std::get_if<cloth::ValidationStudy>(table_.get())) {
    QStringList failed;
    for (const cloth::ValidationRow& row : validation->rows)
      if (!row.holds()) failed << QString::fromStdString(cloth::name_of(row));
    text += failed.isEmpty() ? tr(". All that is promised holds")
                             : tr(". Not what is promised: %1").arg(failed.join(", "));
  }
  return text;
}

void StudiesPanel::show(std::shared_ptr<const cloth::StudyTable> table) {
  table_ = std::move(table);
  offerDiagrams();
  refreshDiagram();
  compareWithForm();
  stack_->setCurrentIndex(1);
}

/// Says so where what is shown is not what the form would give now.
void StudiesPanel::compareWithForm() {
  if (shows_fit_) return earlier_->hide();
  if (sweep_.isShown()) {
    const bool same = choices_->kind() == StudyChoices::Kind::sweep && sweep_.view() &&
                      choices_->sweep().describes(sweep_.view()->folder.plan);
    return earlier_->setVisible(sweep_.view() && !same);
  }
  earlier_->setVisible(table_ && !choices_->describes(*table_));
}

/// The choice stays while the kind of study does.
void StudiesPanel::offerDiagrams() {
  const QStringList diagrams = shows_fit_         ? fitDiagrams()
                               : sweep_.isShown() ? sweep_diagram_names(*sweep_.view())
                                                  : diagrams_of(*table_);
  QStringList offered;
  for (int k = 0; k < against_->count(); ++k) offered << against_->itemText(k);
  if (offered == diagrams) return;
  const QSignalBlocker quiet(against_);
  against_->clear();
  against_->addItems(diagrams);
}

void StudiesPanel::refreshDiagram() {
  if (shows_fit_) return fitted_ ? showFitDiagram() : void();
  if (const auto& view = sweep_.view()) {
    auto diagram = sweep_diagram(*view, static_cast<std::size_t>(std::max(0, against_->currentIndex())));
    if (diagram) plot_->setDiagram(std::move(*diagram));
    stack_->setCurrentIndex(diagram ? 1 : 0);
    if (!diagram && !view->results.rows.empty())
      empty_->setText(tr("<p>No run so far has a value of this output.</p>"));
    return;
  }
  if (table_) plot_->setDiagram(diagram_of(*table_, std::max(0, against_->currentIndex())));
}

void StudiesPanel::openRun(int run) {
  if (!table_) return;
  if (const auto found = cloth::run_of(*table_, run))
    Q_EMIT runOpened(found->scene, sentence_text(found->note));
}

void StudiesPanel::say(const QString& text, bool error) {
  line_->setProperty("state", error ? "error" : "");
  line_->style()->polish(line_);
  line_->setText(text);
  line_->setToolTip(text);
}

}  // namespace clothlab
