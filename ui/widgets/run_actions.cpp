#include "widgets/run_actions.h"

#include <QAction>
#include <QDesktopServices>
#include <QUrl>

#include "theme/theme.h"
#include "widgets/notice_bar.h"

namespace clothlab {
namespace {

/// A click has switched the action already, but not its icon: the text tells which one it has.
void dress(QAction& action, bool on, const QString& text, const char* icon_name) {
  action.setChecked(on);
  if (action.text() == text) return;
  action.setText(text);
  action.setIcon(icon(icon_name));
}

}  // namespace

void follow_playing(QAction& play, bool playing) {
  dress(play, playing, playing ? QObject::tr("Pause") : QObject::tr("Play"), playing ? "pause" : "play");
}

void follow_recording(QAction& record, NoticeBar& notice, const RunStatus& before,
                      const RunStatus& now) {
  dress(record, now.recording, now.recording ? QObject::tr("Stop recording") : QObject::tr("Record"),
        now.recording ? "stop-record" : "record");
  if (now.recording_error != before.recording_error && !now.recording_error.empty()) {
    notice.show("recording", NoticeBar::Level::error,
                QObject::tr("Recording stopped: %1. What was written before is valid.")
                    .arg(QString::fromStdString(now.recording_error)));
  } else if (before.recording && !now.recording) {
    const QString folder = QString::fromStdString(now.recording_folder.string());
    notice.show("recording", NoticeBar::Level::info,
                QObject::tr("Recorded %1 rows in %2").arg(now.recorded_rows).arg(folder),
                QObject::tr("Open folder"),
                [folder] { QDesktopServices::openUrl(QUrl::fromLocalFile(folder)); });
  }
}

}  // namespace clothlab
