// The colours of a picture, as the window's two themes have them.
#pragma once

#include "picture/image.h"

namespace cloth {

struct PictureTheme {
  Rgb background_top, background_bottom;
  Rgb body;               ///< obstacles
  Rgb sheet, sheet_back;  ///< of the cloth below a wireframe
  Rgb floor, floor_line;  ///< level planes and the ground
  Rgb slope;              ///< planes that are not level
  Rgb floor_shadow;
  Rgb pin, pin_rim;
  float floor_opacity, line_opacity, shadow_opacity;
  float exposure;  ///< of all that is lit
};

const PictureTheme& light_picture();
const PictureTheme& dark_picture();

}  // namespace cloth
