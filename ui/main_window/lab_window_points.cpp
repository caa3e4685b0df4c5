// LabWindow: parameters that are varied, and runs of a sweep in the panes.
#include <QTimer>
#include <algorithm>

#include "main_window/lab_window.h"
#include "scene/scene_parameters.h"
#include "studies/fit_choices.h"
#include "studies/studies_panel.h"
#include "studies/sweep_choices.h"

namespace clothlab {
namespace {

/// Whether the scenes are the same but for what the plan varies, and for where their files lie.
bool is_of_plan(cloth::Scene scene, const cloth::SweepPlan& plan) {
  copy_varied(plan, plan.scene, scene);
  scene.folder = plan.scene.folder;
  return scene == plan.scene;
}

/// What the plan varies, as the scene has it.
std::vector<cloth::OwnValue> varied_values(const cloth::SweepPlan& plan, const cloth::Scene& scene) {
  std::vector<cloth::OwnValue> values;
  for (const std::string& path : varied_paths(plan, scene))
    values.push_back({path, find_parameter(scene, path)->get(scene)});
  return values;
}

}  // namespace

/// The study that takes the ranges comes into sight beside the form, and the range gets the focus.
void LabWindow::showVaried(const std::string& path) {
  showStudies();
  const bool is_fit = studies_->choices().kind() == StudyChoices::Kind::fit;  // its bounds are ranges, too
  if (!studies_->isRunning() && !is_fit) studies_->choices().choose(StudyChoices::Kind::sweep);
  QTimer::singleShot(0, this, [this, path] {
    if (!parameters_->reveal(path)) return;
    const auto* editor = parameters_->findChild<QWidget*>("param:" + QString::fromStdString(path));
    auto* from = editor ? editor->findChild<QWidget*>("rangeFrom") : nullptr;
    if (from) from->setFocus(Qt::OtherFocusReason);
  });
}

void LabWindow::fitTo(const QString& file, const std::string& column) {
  showStudies();
  studies_->fitTo(file, column);
}

void LabWindow::chooseMeasured() {
  showStudies();
  if (!studies_->isRunning()) studies_->choices().choose(StudyChoices::Kind::fit);
  if (auto* choose = studies_->findChild<QWidget*>("fitChoose")) choose->setFocus(Qt::OtherFocusReason);
}

/// Over the charts, as long as the form of a fit is shown.
void LabWindow::showMeasured() {
  std::optional<MeasuredDots> dots;
  const StudyChoices& choices = studies_->choices();
  if (choices.kind() == StudyChoices::Kind::fit && choices.fit().hasTable()) {
    const auto chosen = choices.fit().curve();
    if (const auto* curve = std::get_if<cloth::FittedCurve>(&chosen))
      dots = {.column = curve->column, .times = curve->times, .values = curve->values};
  }
  charts_->setMeasured(dots);
}

/// A run of another scene than the document's takes its place; one of the same scene is an edit.
void LabWindow::openPoint(const SweptRun& run) {
  if (is_of_plan(document_.comparison().scene, run.plan)) return openPointInPane(run);
  if (!mayLoseChanges()) return;
  cloth::Scene scene = run.scene;
  document_.load(std::move(scene));
  say("run", NoticeBar::Level::info, tr("The run with %1.").arg(run.words));
}

/// In the only pane, or in the last one of several; beside them in a new one.
void LabWindow::openPointInPane(const SweptRun& run) {
  const std::vector<cloth::OwnValue> values = varied_values(run.plan, run.scene);
  const auto shared = std::find_if(values.begin(), values.end(), [](const cloth::OwnValue& value) {
    return cloth::must_be_shared(value.path).has_value();
  });
  if (run.beside && document_.paneCount() >= cloth::max_panes)
    return say("run", NoticeBar::Level::warning,
               tr("There are four panes already: remove one to open another run beside them."));
  if ((run.beside || document_.isComparison()) && shared != values.end())
    return say("run", NoticeBar::Level::warning,
               tr("Runs with different values of %1 cannot stand side by side: it %2.")
                   .arg(QString::fromStdString(shared->path),
                        QString::fromStdString(*cloth::must_be_shared(shared->path))));
  document_.undoStack().beginMacro(tr("Open the run with %1").arg(run.words));
  if (run.beside) document_.duplicatePane(document_.paneCount() - 1);
  const std::size_t pane = document_.paneCount() - 1;
  for (const cloth::OwnValue& value : values) document_.setOwn(pane, value.path, value.value);
  if (document_.isComparison()) document_.setPaneTitle(pane, run.words);
  document_.undoStack().endMacro();
  if (document_.isComparison()) grid_->showComparison(document_.comparison());
  const QString name = QString::fromStdString(document_.comparison().panes[pane].name);
  say("run", NoticeBar::Level::info,
      document_.isComparison() ? tr("Pane %1: %2.").arg(name, run.words)
                               : tr("The run with %1.").arg(run.words));
}

}  // namespace clothlab
