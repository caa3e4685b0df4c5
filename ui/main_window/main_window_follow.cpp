// MainWindow: updates the window from the worker's status.
#include <QAction>
#include <QStringList>
#include <algorithm>
#include <cmath>
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
    say("quality", NoticeBar::Level::warning, as_sentences(status.notice));
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

void MainWindow::followDivergence(const WorkerStatus& status) {
  if (!status.divergence) {
    if (shown_status_.divergence) notice_->withdraw("divergence");
    return;
  }
  if (shown_status_.divergence) return;
  if (status.divergence->pinched) return sayPinched(*status.divergence);
  const QString text = tr("The run %1. The view shows the last good state.")
                           .arg(QString::fromStdString(cloth::describe(*status.divergence)));
  if (status.divergence->stable_step > 0 && std::isfinite(status.divergence->stable_step))
    notice_->show("divergence", NoticeBar::Level::error, text, tr("Use auto and restart"), [this] {
      takeStableStep();
      restart();
    });
  else
    notice_->show("divergence", NoticeBar::Level::error, text);
}

/// A pinch is not a divergence: after any undo or move the run continues from its present state.
void MainWindow::sayPinched(const cloth::Divergence& stop) {
  const QString text = tr("The run %1. Move the obstacle elsewhere or free the cloth, and play on.")
                           .arg(QString::fromStdString(cloth::describe(stop)));
  QUndoStack& edits = document_.undoStack();
  if (edits.canUndo())
    notice_->show("divergence", NoticeBar::Level::error, text, tr("Undo: %1").arg(edits.undoText()),
                  [this] { document_.undoStack().undo(); });
  else
    notice_->show("divergence", NoticeBar::Level::error, text);
}

/// Its message offers to undo the edit that led there; after another edit that would be the wrong one.
void MainWindow::forgetPinch() {
  if (shown_status_.divergence && shown_status_.divergence->pinched) notice_->withdraw("divergence");
}

}  // namespace clothlab
