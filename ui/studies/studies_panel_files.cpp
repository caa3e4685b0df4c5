// StudiesPanel: folders that are opened, and what is saved.
#include <QDesktopServices>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMenu>
#include <QStackedWidget>
#include <QUrl>

#include "analysis/fit_report.h"
#include "document/result_files.h"
#include "document/save_dialog.h"
#include "studies/studies_panel.h"
#include "studies/study_library.h"
#include "sweep/sweep_report.h"

namespace clothlab {

void StudiesPanel::openFolder(const QString& folder) {
  if (isRunning()) return;
  if (SweepStudy::isSweep(folder)) {
    folder_ = QDir::cleanPath(folder);
    table_.reset();
    leaveFit();
    plot_->setClickOpens(true);
    plot_->clearBrushes();
    stack_->setCurrentIndex(0);
    empty_->setText(tr("<p><b>No run is there yet.</b></p><p>Runs are drawn as they come.</p>"));
    sweep_.open(folder_);
    recent_studies.remember(folder_);
    timer_.start(run_interval);
    return poll();
  }
  if (QFileInfo::exists(QDir(folder).filePath(cloth::fit_index_name))) return openFit(folder);
  cloth::StudyReading reading = cloth::read_study(folder.toStdString());
  if (!reading.study) {
    say(tr("The study was not opened. %1").arg(QString::fromStdString(reading.problem)), true);
    return;
  }
  sweep_.leave();
  leaveFit();
  plot_->setClickOpens(false);
  folder_ = folder;
  recent_studies.remember(folder);
  show(std::make_shared<const cloth::StudyTable>(std::move(reading.study->table)));
  showStatus({});
}

/// Of what is shown, outside of the window.
void StudiesPanel::offerShown() {
  const auto add = [this](const QString& text, const char* name, const QString& path) {
    QAction* action =
        recent_->addAction(text, this, [path] { QDesktopServices::openUrl(QUrl::fromLocalFile(path)); });
    action->setObjectName(name);
    action->setEnabled(!folder_.isEmpty() && QFileInfo::exists(path));
  };
  add(tr("Open the report"), "openReport", QDir(folder_).filePath("report.html"));
  add(tr("Show the folder"), "showFolder", QDir(folder_).absolutePath());
}

void StudiesPanel::fillRecentMenu() {
  recent_->clear();
  recent_->addAction(tr("Open a folder…"), this, [this] {
    const QString folder =
        QFileDialog::getExistingDirectory(this, tr("The folder of a study"), studies_folder());
    if (!folder.isEmpty()) openFolder(folder);
  });
  offerShown();
  recent_->addSeparator();
  const QStringList recent = recent_studies.list();
  for (const QString& folder : recent)
    recent_->addAction(QDir(folder).dirName(), this, [this, folder] { openFolder(folder); })
        ->setToolTip(folder);
  if (recent.isEmpty()) recent_->addAction(tr("No study was made yet"))->setEnabled(false);
}

QString StudiesPanel::save(const QString& name) {
  const auto& view = sweep_.view();
  if (!table_ && !view && !fitted_) return tr("There is no study to save.");
  if (!name.endsWith(".csv", Qt::CaseInsensitive)) return save_diagram(plot_->diagram(), name, font());
  const std::string csv = fitted_ ? targets_csv(*fitted_)
                          : view  ? csv_text(sweep_table(view->folder.plan, view->results), "\n")
                                  : cloth::study_csv(*table_);
  const QString problem = write_file(name, QByteArray::fromStdString(csv));
  return problem.isEmpty() ? problem : tr("%1: %2").arg(name, problem);
}

void StudiesPanel::saveAs() {
  const QString name = ask_where_to_save(
      this, tr("Save the study"),
      {{tr("Drawing"), {".svg"}}, {tr("Picture"), {".png"}}, {tr("Page"), {".pdf"}}, {tr("Runs"), {".csv"}}},
      QDir(folder_).filePath("study.svg"));
  if (name.isEmpty()) return;
  const QString problem = save(name);
  say(problem.isEmpty() ? saved_in(tr("study"), name) : problem, !problem.isEmpty());
}

}  // namespace clothlab
