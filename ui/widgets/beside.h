// Work that may take long, as reading a large mesh or writing a million rows, in a thread of its own: the
// window goes on drawing and playing, behind a message with a Stop button.
#pragma once

#include <QString>
#include <functional>
#include <stop_token>

class QWidget;

namespace clothlab {

struct BesideResult {
  bool stopped = false;  ///< by the user; the work may go on for a while, and nobody waits for it
  QString failure;       ///< what an exception said; empty: there was none
};

/// Returns when `work` has ended or was stopped. Until then the window takes no input but Stop; work that
/// takes a moment only shows nothing. `work` owns all that it uses: stopped, it may outlive the caller.
BesideResult beside_the_window(QWidget* window, const QString& text,
                               std::function<void(const std::stop_token& stop)> work);

}  // namespace clothlab
