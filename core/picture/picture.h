// Pictures of a cloth and its obstacles without a window: a small renderer of its own, so that a report has
// pictures on a machine without display, graphics card or Qt.
//
//     const PictureCamera camera = camera_showing(scene, state.position);
//     write_file("cloth.png", png_file(cloth_image(scene, system, state.position, camera)));
#pragma once

#include "picture/image.h"
#include "picture/picture_camera.h"
#include "picture/picture_theme.h"

namespace cloth {

enum class ClothColouring { plain, strain };
enum class ClothPattern { none, checks, stripes };

struct PictureOptions {
  int width = 640, height = 480;  ///< px, clamped to [1, 8192]
  ClothColouring colouring = ClothColouring::plain;
  ClothPattern pattern = ClothPattern::checks;          ///< of a plain cloth
  double strain_scale = 0.1;                            ///< the strain of the last colour
  bool wireframe = false;                               ///< springs as lines on a pale sheet
  std::array<bool, 3> springs_shown{true, true, true};  ///< by SpringFamily; fewer read better on a fine grid
  double time = 0;                                      ///< s: obstacles that move are where they are then
  bool ground = true;  ///< a floor below everything where the scene has no plane to fall on
  bool shadow = true;  ///< on the floor, and of cloth and bodies on each other
  const PictureTheme* theme = &light_picture();
  std::vector<PictureArrow> arrows{};  ///< over everything else
};

/// The colours of the three families of springs in a wireframe, for a legend.
Rgb spring_colour(SpringFamily family);

/// Three arrows along the scene's steady wind, on the windward side of the cloth; none without wind.
std::vector<PictureArrow> wind_arrows(const Scene& scene, const Vec3Field& position);

/// The cloth at `position` (m, one per particle of `system`) with the scene's obstacles. The same bytes for
/// the same input. Triangles with a corner that is not finite are left out. Balls and boxes are drawn smaller
/// by what flat cells cut off them (a box by 0.6 of a cell, at most a fifth of its size), or they would show
/// through the cloth that rests on them; so a picture does not show how deep a cell cuts.
Image cloth_image(const Scene& scene, const ClothSystem& system, const Vec3Field& position,
                  const PictureCamera& camera, const PictureOptions& options = {});

/// The same as the bytes of a PNG file.
std::vector<std::uint8_t> cloth_picture(const Scene& scene, const ClothSystem& system,
                                        const Vec3Field& position, const PictureCamera& camera,
                                        const PictureOptions& options = {});

}  // namespace cloth
