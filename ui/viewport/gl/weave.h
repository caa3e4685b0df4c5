// Our own cloth texture: a plain weave, computed.
#pragma once

#include <QColor>
#include <QImage>

namespace clothlab {

inline constexpr int weave_threads = 16;  ///< across one tile, either way

QColor warp_colour();  ///< threads along the columns
QColor weft_colour();  ///< threads along the rows

/// One tile that repeats without a seam, `size` px square, RGBA, sRGB. Every call gives the same picture.
QImage weave_tile(int size = 512);

/// The tile that all views share. It takes some tenths of a second, once: begun early, in a thread of its
/// own.
void begin_shared_weave_tile();
const QImage& shared_weave_tile();

}  // namespace clothlab
