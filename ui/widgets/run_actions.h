// How the actions that play and record show what the worker does, and what a recording leaves to say.
#pragma once

#include "bridge/worker_status.h"

class QAction;

namespace clothlab {

class NoticeBar;

/// What a click will do. An action that is told what it knows would have its bar laid out anew all the same.
void follow_playing(QAction& play, bool playing);

/// The action, and a notice when a recording has ended or could not go on.
void follow_recording(QAction& record, NoticeBar& notice, const RunStatus& before,
                      const RunStatus& now);

}  // namespace clothlab
