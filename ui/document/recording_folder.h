// Where recordings go that were given no folder.
#pragma once

#include <QString>

namespace clothlab {

/// A new folder's path for a recording of what has this title, in the user's documents.
QString new_recording_folder(const QString& title);

}  // namespace clothlab
