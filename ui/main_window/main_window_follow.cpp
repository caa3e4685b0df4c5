// MainWindow: updates the window from the worker's status.
#include <QAction>
#include <QStringList>
#include <algorithm>
#include <utility>

#include "main_window/main_window.h"

namespace clothlab {
namespace {

/// Notices come a line each, worded to follow a program's name on the command line.
QString as_sentences(const std::string& notices) {
  QStringList lines = QString::fromStdString(notices).split('\n', Qt::SkipEmptyParts);
  const QString mark = lines.size() > 1 ? QStringLiteral("\u2022 ") : QString();
  for (QString& line : lines)
    line = mark + line.at(0).toUpper() + line.mid(1) + (line.endsWith('.') ? "" : ".");
  return lines.join('\n');
}

}  // namespace

void MainWindow::followStatus(const WorkerStatus& status) {
  transport_->showStatus(status);
  timeline_->showStatus(status, link_.isUpToDate());
  play_again_->setEnabled(status.refusal.empty() && !status.playing &&
                          status.step < status.history.last_step);
  followRun(status);
  if (status.notice != shown_status_.notice)
    notice_->showState("quality", NoticeBar::Level::warning, as_sentences(status.notice));
  followDivergence(status);
  followRecording(shown_status_, status);
  followSession(status);
  followScene(status);
  shown_status_ = status;
}

/// The run is at a time when another scene was in force: the document becomes that scene, unless it has edits
/// of its own on the way.
void MainWindow::followScene(const WorkerStatus& status) {
  if (!status.scene || !link_.isUpToDate() || !status.refusal.empty()) return;
  timeline_->track().setStep(std::max(status.scene->record.interval, status.time_step));
  if (std::exchange(followed_, status.scene) != status.scene || status.jumps != shown_status_.jumps)
    document_.follow(*status.scene);
}

void MainWindow::followSession(const WorkerStatus& status) {
  if (!status.session_error.empty()) {
    if (status.session_error != shown_status_.session_error || !saving_session_.isEmpty())
      notice_->show("session", NoticeBar::Level::error,
                    tr("Session: %1").arg(QString::fromStdString(status.session_error)));
    if (link_.isUpToDate()) saving_session_.clear();
  } else if (!saving_session_.isEmpty() && link_.isUpToDate()) {
    notice_->show("session", NoticeBar::Level::info,
                  tr("Saved the session of %1 s in %2")
                      .arg(status.history.last_time, 0, 'f', 3)
                      .arg(std::exchange(saving_session_, QString())));
  }
  if (!status.session_agrees || status.session_agrees == shown_status_.session_agrees) return;
  if (*status.session_agrees)
    notice_->show("session", NoticeBar::Level::info, tr("The session came out the same, to the bit."));
  else
    notice_->show("session", NoticeBar::Level::warning,
                  tr("The session came out different from its file. Another version, compiler or processor "
                     "may round differently."));
}

/// A run that goes on after a change has yet to show that it gets past that place. One that is restarted or
/// goes back in time is done with it.
void MainWindow::followDivergence(const WorkerStatus& status) {
  if (!link_.isUpToDate()) return;  // it may be over
  if (std::exchange(divergences_, status.divergences) != status.divergences) {
    divergence_ = status.divergence;
    if (divergence_) sayDivergence(true);
  } else if (divergence_ && !status.divergence && status.time >= divergence_->time) {
    forgetDivergence();
  }
}

/// Says a new divergence, or what helps against the present one after an edit.
void MainWindow::sayDivergence(bool is_new) {
  notice_->withdraw("stability");                        // what it warned of has happened
  if (!is_new && !notice_->shows("divergence")) return;  // it was closed
  const QString what = QString::fromStdString(cloth::describe(*divergence_));
  notice_->show("divergence", NoticeBar::Level::error,
                divergence_->pinched
                    ? tr("The run %1. Move the obstacle elsewhere or free the cloth, and play on.").arg(what)
                    : tr("The run %1. The view shows the last good state.").arg(what),
                helpAgainst(*divergence_));
}

std::vector<NoticeAction> MainWindow::helpAgainst(const cloth::Divergence& stop) {
  std::vector<NoticeAction> actions;
  QUndoStack& edits = document_.undoStack();
  if (stop.pinched && edits.canUndo())
    actions.push_back({tr("Undo: %1").arg(edits.undoText()), [this] { document_.undoStack().undo(); }});
  for (const Remedy& remedy : remedies_for(document_.scene(), stop))
    actions.push_back({remedy.text, [this, remedy] {
                         restartWith(remedy,
                                     [this](const std::string& path, const cloth::ParameterValue& to) {
                                       document_.setParameter(path, to);
                                     });
                       }});
  return actions;
}

void MainWindow::forgetDivergence() {
  if (!std::exchange(divergence_, std::nullopt)) return;
  notice_->withdraw("divergence");
  readStability();
}

/// A pinched run goes on from where it stands, whatever is undone or moved. Its message offers to undo the
/// edit that led there; after another edit that would be the wrong one.
void MainWindow::forgetPinch() {
  if (divergence_ && divergence_->pinched) forgetDivergence();
}

}  // namespace clothlab
