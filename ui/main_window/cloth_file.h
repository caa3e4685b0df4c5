// The cloth of the view as a file.
#pragma once

#include <QString>

#include "bridge/frame.h"

namespace clothlab {

/// Writes a frame's cloth as an OBJ file: vertices in m, single precision as the view has them, normals,
/// triangles, and texture coordinates of a grid. Empty when done, else what went wrong.
QString save_cloth_file(const ClothFrame& frame, const QString& title, const QString& path);

}  // namespace clothlab
