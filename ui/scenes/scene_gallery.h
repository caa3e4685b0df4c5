// The built-in scenes and comparisons by purpose, with what each is for. resources/gallery has a picture of
// each.
#pragma once

#include <QString>
#include <vector>

namespace clothlab {

struct GalleryEntry {
  const char* name;             ///< of the built-in scene or comparison
  QString shows;                ///< one sentence
  double time;                  ///< s, of the picture
  const char* view = "corner";  ///< of the picture, as `clothlab-cli run --view` takes it
};

struct GalleryGroup {
  QString purpose;
  std::vector<GalleryEntry> entries;
};

std::vector<GalleryGroup> scene_gallery();

/// The title in the file of the built-in scene or comparison.
QString gallery_title(const QString& name);

/// The picture's file: a resource.
QString gallery_picture(const QString& name, bool dark);

}  // namespace clothlab
