// Where studies' folders are, and those that were made or opened lately.
#pragma once

#include <QString>
#include <QStringList>

namespace clothlab {

/// The user's documents, Clothlab/studies.
QString studies_folder();

/// A new folder's path in it: date, kind and scene.
QString new_study_folder(const QString& kind, const QString& title);

/// Newest first, those that still hold a study.
QStringList recent_studies();
void remember_study(const QString& folder);

}  // namespace clothlab
