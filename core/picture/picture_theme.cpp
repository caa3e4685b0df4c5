#include "picture/picture_theme.h"

namespace cloth {

const PictureTheme& light_picture() {
  static const PictureTheme theme{.background_top = {0xd9, 0xe0, 0xea},
                                  .background_bottom = {0xf6, 0xf8, 0xfa},
                                  .body = {0xb9, 0xbe, 0xc5},
                                  .sheet = {0xf4, 0xf6, 0xf8},
                                  .sheet_back = {0xd2, 0xda, 0xe4},
                                  .floor = {0xff, 0xff, 0xff},
                                  .floor_line = {0x30, 0x3c, 0x4a},
                                  .slope = {0xa9, 0xb2, 0xbe},
                                  .floor_shadow = {0x3c, 0x44, 0x52},
                                  .pin = {0x34, 0x57, 0xd5},
                                  .pin_rim = {0xff, 0xff, 0xff},
                                  .floor_opacity = 0.35F,
                                  .line_opacity = 0.24F,
                                  .shadow_opacity = 0.42F,
                                  .exposure = 1.05F};
  return theme;
}

const PictureTheme& dark_picture() {
  static const PictureTheme theme{.background_top = {0x2c, 0x32, 0x3b},
                                  .background_bottom = {0x14, 0x16, 0x19},
                                  .body = {0x78, 0x7d, 0x85},
                                  .sheet = {0x3c, 0x46, 0x52},
                                  .sheet_back = {0x2c, 0x34, 0x3e},
                                  .floor = {0x0a, 0x0d, 0x11},
                                  .floor_line = {0xc8, 0xd2, 0xde},
                                  .slope = {0x5a, 0x63, 0x6e},
                                  .floor_shadow = {0x00, 0x00, 0x00},
                                  .pin = {0x8e, 0xa8, 0xff},
                                  .pin_rim = {0x12, 0x16, 0x1b},
                                  .floor_opacity = 0.22F,
                                  .line_opacity = 0.16F,
                                  .shadow_opacity = 0.55F,
                                  .exposure = 0.92F};
  return theme;
}

}  // namespace cloth
