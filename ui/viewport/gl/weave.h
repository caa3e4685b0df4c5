// Our own cloth texture: a plain weave, computed.
#pragma once

#include <QColor>
#include <QImage>
#include <vector>

namespace clothlab {

inline constexpr int weave_threads = 16;  ///< across one tile, either way

QColor warp_colour();  ///< threads along the columns
QColor weft_colour();  ///< threads along the rows

/// One tile that repeats without a seam, `size` px square, RGBA, sRGB. Every call gives the same picture.
QImage weave_tile(int size = 512);

/// A picture and its halves, quarters, ... down to a single pixel: means of the light, not of the sRGB
/// values. `picture`: square, a power of two wide, RGBA, opaque.
std::vector<QImage> mipmaps_of(QImage picture);

/// The tile that all views share, with its mipmaps. Some hundredths of a second, once: begun early, in a
/// thread of its own.
void begin_shared_weave();
const std::vector<QImage>& shared_weave();

}  // namespace clothlab
