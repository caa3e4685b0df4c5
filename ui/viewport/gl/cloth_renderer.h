// Draws a frame into the bound framebuffer with OpenGL, in the theme's colours. Independent of widgets, input
// and time.
#pragma once

#include <Eigen/Core>
#include <QOpenGLFunctions_3_3_Core>
#include <memory>

#include "bridge/frame.h"
#include "viewport/gl/cloth_surface.h"
#include "viewport/gl/contact_layer.h"
#include "viewport/gl/mesh_body.h"
#include "viewport/gl/renderer_kit.h"
#include "viewport/gl/solids.h"
#include "viewport/scene_extent.h"
#include "viewport/view_mode.h"

namespace clothlab {

struct Theme;

/// Camera and options of one picture.
struct Shot {
  Eigen::Matrix4d world_to_clip = Eigen::Matrix4d::Identity();
  Eigen::Vector3d eye{0, 0, 1}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< m; unit vectors
  double metres_per_pixel = 0.001;  ///< where the eye looks, in the picture's own pixels
  double pixel_ratio = 1;           ///< the picture's pixels per device-independent px
  ViewMode mode = ViewMode::textured;
  double strain_maximum = 0.1;  ///< of the colours' range
  /// Lower quality for a moving cloth: if the cells are only a few pixels large, light is computed per
  /// particle instead of per pixel. Has an effect only with a frugal renderer.
  bool quick = false;
  bool contact = false;  ///< draws the frame's contact data
  Ground ground;
  Eigen::AlignedBox3d extent;  ///< m: how large the grid of the ground is drawn, and about where
};

/// A context (OpenGL 3.3 core or later) must be current whenever a member is called, the destructor included.
class ClothRenderer : protected QOpenGLFunctions_3_3_Core {
 public:
  ClothRenderer() = default;
  ClothRenderer(const ClothRenderer&) = delete;
  ClothRenderer& operator=(const ClothRenderer&) = delete;

  /// Shaders, meshes, textures. On failure false, and why in `problem`; nothing else may be called then.
  /// `frugal`: for software rendering; leaves out expensive details.
  bool initialise(bool frugal, QString* problem);

  /// Uploads the frame's geometry to graphics memory. Rows, columns and array sizes must agree.
  void set_frame(const ClothFrame& frame);

  /// The whole picture, without overlays. Sets all the state it needs and leaves depth test and blending off.
  void draw(const Shot& shot, const Theme& theme);

 private:
  void light(QOpenGLShaderProgram& program, const Shot& shot, const Theme& theme);
  void draw_background(const Theme& theme);
  void begin_obstacles(const Shot& shot, const Theme& theme, float opacity);
  void end_obstacles();
  void draw_obstacles(const Shot& shot, const Theme& theme);
  void draw_targets(const Shot& shot, const Theme& theme);
  void draw_obstacle(QOpenGLShaderProgram& program, const cloth::Obstacle& obstacle, const cloth::Pose& pose);
  void measure_cloth(const ClothFrame& frame);
  void draw_cloth(const Shot& shot, const Theme& theme);
  void draw_threads(const Shot& shot, const Theme& theme);
  double cell_on_screen(const Shot& shot) const;  // px
  struct Floor {
    Eigen::Vector3d point, normal;  // m; unit vector
    bool is_level;
  };
  void find_floors(const Shot& shot);
  void draw_floors(const Shot& shot, const Theme& theme);
  void draw_floor(const Shot& shot, const Theme& theme, const Floor& floor);
  void draw_shadows(const Shot& shot, const Theme& theme);
  void draw_pins(const Shot& shot, const Theme& theme);

  std::shared_ptr<RendererKit> kit_;
  std::unique_ptr<ClothSurface> surface_;
  std::unique_ptr<Solids> solids_;
  std::unique_ptr<MeshBodies> bodies_;
  std::unique_ptr<ContactLayer> contact_;

  bool has_cloth_ = false, is_mesh_ = false;
  std::uint64_t topology_ = 0;
  int rows_ = 0, columns_ = 0;
  double cell_length_ = 0;    // m, between neighbours when the run began
  QVector2D tiles_per_cell_;  // of the weave; of a mesh a metre takes the cell's place
  std::vector<cloth::Obstacle> obstacles_;
  std::vector<cloth::Pose> poses_, targets_;
  std::vector<Floor> floors_;  // of the picture that is being drawn
};

}  // namespace clothlab
