// LabWindow: updates the window from the worker's status.
#include <QAction>
#include <QDesktopServices>
#include <QStringList>
#include <QUrl>
#include <algorithm>
#include <utility>

#include "main_window/lab_files.h"
#include "main_window/lab_window.h"
#include "theme/theme.h"
#include "viewport/drawing_turns.h"
#include "widgets/numbers.h"

namespace clothlab {
namespace {

/// Notices come a line each, worded to follow a program's name on the command line.
QString as_sentences(const std::string& notices) {
  QStringList lines = sentence_text(notices).split('\n', Qt::SkipEmptyParts);
  const QString mark = lines.size() > 1 ? QStringLiteral("\u2022 ") : QString();
  for (QString& line : lines)
    line = mark + line.at(0).toUpper() + line.mid(1) + (line.endsWith('.') ? "" : ".");
  return lines.join('\n');
}

QString rate_breaches(const std::vector<cloth::PaneResult>& panes) {
  QStringList breaches;
  for (const cloth::PaneResult& pane : panes)
    if (auto breach = pane.rate_breach) {
      breach->steps = 1;  // a notice that does not change with every step
      breaches << LabWindow::tr("Pane %1: %2")
                      .arg(QString::fromStdString(pane.name), sentence_text(cloth::describe(*breach)));
    }
  return breaches.join('\n');
}

/// A click has switched the action already, but not its icon: the text tells which one it has. An action that
/// is told what it knows would have its bar laid out anew all the same.
void show_state(QAction& action, bool on, const QString& text, const char* icon_name) {
  action.setChecked(on);
  if (action.text() == text) return;
  action.setText(text);
  action.setIcon(icon(icon_name));
}

}  // namespace

void LabWindow::followStatus(const WorkerStatus& status) {
  DrawingTurns::ofTheApplication().setRunIsBehind(status.is_behind());
  transport_->showStatus(status);
  timeline_->showStatus(status, link_.isUpToDate());
  show_state(*play_, status.playing, status.playing ? tr("Pause") : tr("Play"),
             status.playing ? "pause" : "play");
  play_->setEnabled(status.refusal.empty());
  step_->setEnabled(status.refusal.empty());
  play_again_->setEnabled(status.refusal.empty() && !status.playing &&
                          status.step < status.history.last_step);
  notice_->showState("refusal", NoticeBar::Level::error, sentence_text(status.refusal));
  if (status.is_comparison())
    followComparison(status);
  else
    followScene(status);
  followRecording(status);
  adoptRun(status);
  shown_status_ = status;
}

void LabWindow::followScene(const WorkerStatus& status) {
  if (status.notice != shown_status_.notice)
    notice_->showState("quality", NoticeBar::Level::warning, as_sentences(status.notice));
  followDivergence(status);
  followSession(status);
}

void LabWindow::followComparison(const WorkerStatus& status) {
  grid_->showResults(status);
  ranking_->showResults(status);
  notice_->showState("reference", NoticeBar::Level::warning,
                     status.reference_failure.empty()
                         ? QString()
                         : tr("The reference stopped: it %1").arg(sentence_text(status.reference_failure)));
  notice_->showState("rate", NoticeBar::Level::warning, rate_breaches(status.panes));
  if (shown_status_.is_comparison() && status.new_starts != shown_status_.new_starts)
    notice_->show("new-start", NoticeBar::Level::info,
                  tr("Started anew from 0 s: this change cannot be put in force in the middle of a run."));
}

/// The run is at a time when something else was in force: the document becomes that, unless it has edits of
/// its own on the way.
void LabWindow::adoptRun(const WorkerStatus& status) {
  if (!status.comparison || !link_.isUpToDate() || !status.refusal.empty() || isWaiting()) return;
  const double interval = status.comparison->scene.record.interval;
  timeline_->track().setStep(std::max(interval, status.time_step));
  if (std::exchange(followed_, status.comparison) != status.comparison || status.jumps != shown_status_.jumps)
    document_.follow(*status.comparison);
}

void LabWindow::followRecording(const WorkerStatus& now) {
  const WorkerStatus& before = shown_status_;
  show_state(*record_, now.recording, now.recording ? tr("Stop recording") : tr("Record"),
             now.recording ? "stop-record" : "record");
  if (now.recording_error != before.recording_error && !now.recording_error.empty()) {
    notice_->show("recording", NoticeBar::Level::error,
                  tr("Recording stopped: %1. What was written before is valid.")
                      .arg(QString::fromStdString(now.recording_error)));
  } else if (before.recording && !now.recording) {
    const QString folder = QString::fromStdString(now.recording_folder.string());
    notice_->show("recording", NoticeBar::Level::info,
                  tr("Recorded %1 rows in %2").arg(now.recorded_rows).arg(folder), tr("Open folder"),
                  [folder] { QDesktopServices::openUrl(QUrl::fromLocalFile(folder)); });
  }
}

void LabWindow::followSession(const WorkerStatus& status) {
  if (!status.session_error.empty()) {
    if (status.session_error != shown_status_.session_error || !saving_session_.isEmpty())
      notice_->show("session", NoticeBar::Level::error,
                    tr("Session: %1").arg(QString::fromStdString(status.session_error)));
    if (link_.isUpToDate()) saving_session_.clear();
  } else if (!saving_session_.isEmpty() && link_.isUpToDate()) {
    notice_->show("session", NoticeBar::Level::info,
                  tr("Saved the session of %1 in %2")
                      .arg(quantity_text(status.history.last_time, "s", 4), saving_session_));
    recent_sessions.remember(std::exchange(saving_session_, QString()));
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
void LabWindow::followDivergence(const WorkerStatus& status) {
  if (!link_.isUpToDate()) return;  // it may be over
  if (std::exchange(divergences_, status.divergences) != status.divergences) {
    divergence_ = status.divergence;
    if (divergence_) sayDivergence(true);
  } else if (divergence_ && !status.divergence && status.time >= divergence_->time) {
    forgetDivergence();
  }
}

/// Says a new divergence, or what helps against the present one after an edit.
void LabWindow::sayDivergence(bool is_new) {
  notice_->withdraw("stability");                        // what it warned of has happened
  if (!is_new && !notice_->shows("divergence")) return;  // it was closed
  const QString what = sentence_text(cloth::describe(*divergence_));
  notice_->show("divergence", NoticeBar::Level::error,
                divergence_->pinched
                    ? tr("The run %1. Move the obstacle elsewhere or free the cloth, and play on.").arg(what)
                    : tr("The run %1. The view shows the last good state.").arg(what),
                helpAgainst(*divergence_));
}

std::vector<NoticeAction> LabWindow::helpAgainst(const cloth::Divergence& stop) {
  std::vector<NoticeAction> actions;
  QUndoStack& edits = document_.undoStack();
  if (stop.pinched && edits.canUndo())
    actions.push_back({tr("Undo: %1").arg(edits.undoText()), [this] { document_.undoStack().undo(); }});
  for (const Remedy& remedy : remedies_for(document_.scene(), stop))
    actions.push_back({remedy.text, [this, remedy] { restartWith(0, remedy); }});
  return actions;
}

/// The edits of the pane as one undo step, and a restart.
void LabWindow::restartWith(std::size_t pane, const Remedy& remedy) {
  if (!remedy.edits.empty()) {
    document_.undoStack().beginMacro(remedy.text);
    for (const auto& [path, value] : remedy.edits) document_.setOwn(pane, path, value);
    document_.undoStack().endMacro();
  }
  restart();
}

void LabWindow::forgetDivergence() {
  if (!std::exchange(divergence_, std::nullopt)) return;
  notice_->withdraw("divergence");
  readStability();
}

/// A pinched run goes on from where it stands, whatever is undone or moved. Its message offers to undo the
/// edit that led there; after another edit that would be the wrong one.
void LabWindow::forgetPinch() {
  if (divergence_ && divergence_->pinched) forgetDivergence();
}

}  // namespace clothlab
