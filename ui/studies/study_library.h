// Where studies' folders are, and those that were made or opened lately.
#pragma once

#include "document/result_files.h"

namespace clothlab {

/// The user's documents, Clothlab/studies.
QString studies_folder();

/// A new folder's path in it: date, kind and scene.
QString new_study_folder(const QString& kind, const QString& title);

/// A path as people write it and back: "~" is the home folder.
QString shown_path(const QString& path);
QString path_from(const QString& shown);

extern const RecentPaths recent_studies;  ///< their folders

}  // namespace clothlab
