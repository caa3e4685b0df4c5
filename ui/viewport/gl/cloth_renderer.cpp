#include "viewport/gl/cloth_renderer.h"

#include <QVector2D>
#include <QVector3D>
#include <QVector4D>
#include <algorithm>
#include <cmath>

#include "geometry/mesh_look.h"
#include "geometry/round_numbers.h"
#include "scene/obstacle_shape.h"
#include "theme/theme.h"
#include "viewport/gl/shader_program.h"
#include "viewport/picking.h"
#include "viewport/strain_scale.h"

namespace clothlab {
namespace {

constexpr double tiles_along_cloth = 9;  // of the weave, over the longer side

float number(double value) {
  return static_cast<float>(value);
}

/// m, along the chain of particles first, first + stride, ...
double chain_length(const ClothFrame& frame, int first, int stride, int count) {
  double length = 0;
  for (int k = 1; k < count; ++k)
    length +=
        (particle_position(frame, first + k * stride) - particle_position(frame, first + (k - 1) * stride))
            .norm();
  return length;
}

QColor thread_colour(const Theme& theme) {
  return theme.dark ? QColor(0xB9, 0xC7, 0xD6) : QColor(0x3F, 0x56, 0x6E);
}

QColor mixed(const QColor& a, const QColor& b, float share_of_b) {
  const float s = 1 - share_of_b;
  return QColor::fromRgbF(s * a.redF() + share_of_b * b.redF(), s * a.greenF() + share_of_b * b.greenF(),
                          s * a.blueF() + share_of_b * b.blueF());
}

/// So that a processor takes long to draw it once more for its shadow.
bool is_large(const cloth::Obstacle& o) {
  const auto mesh = shape_of(o).surface(o).mesh;
  return mesh && mesh->triangles.size() > 20000;
}

}  // namespace

bool ClothRenderer::initialise(bool frugal, QString* problem) {
  if (!initializeOpenGLFunctions()) {
    *problem = QStringLiteral("the functions of OpenGL 3.3 are missing");
    return false;
  }
  kit_ = RendererKit::of_the_context(frugal, problem);
  if (!kit_) return false;
  QOpenGLFunctions_3_3_Core& gl = *this;
  surface_ = std::make_unique<ClothSurface>(gl);
  solids_ = std::make_unique<Solids>(gl);
  bodies_ = std::make_unique<MeshBodies>(gl);
  contact_ = std::make_unique<ContactLayer>(gl);
  return true;
}

void ClothRenderer::set_frame(const ClothFrame& frame) {
  obstacles_ = frame.obstacles;
  poses_ = frame.poses;
  targets_ = frame.targets;
  bodies_->keep(obstacles_);
  contact_->upload(frame);
  has_cloth_ = frame.has_cloth();
  is_mesh_ = frame.mesh != nullptr;
  if (!has_cloth_) return;
  if (frame.topology != topology_ || frame.rows != rows_ || frame.columns != columns_) {
    topology_ = frame.topology;
    rows_ = frame.rows;
    columns_ = frame.columns;
    measure_cloth(frame);
  }
  surface_->upload(frame);
}

void ClothRenderer::measure_cloth(const ClothFrame& frame) {
  if (is_mesh_) {
    const double longest = cloth::flat_pattern(frame.mesh->surface).size.maxCoeff();
    const float tiles = number(tiles_along_cloth / std::max(longest, 1e-9));
    tiles_per_cell_ = {tiles, tiles};
    double length = 0;
    for (const auto& [a, b] : frame.mesh->edges)
      length += (particle_position(frame, a) - particle_position(frame, b)).norm();
    cell_length_ = length / std::max(static_cast<double>(frame.mesh->edges.size()), 1.0);
    return;
  }
  const double width = chain_length(frame, 0, 1, columns_), height = chain_length(frame, 0, columns_, rows_);
  const double longer = std::max({width, height, 1e-9});
  cell_length_ = std::min(width / (columns_ - 1), height / (rows_ - 1));
  tiles_per_cell_ = {number(tiles_along_cloth * width / longer / (columns_ - 1)),
                     number(tiles_along_cloth * height / longer / (rows_ - 1))};
}

void ClothRenderer::draw(const Shot& shot, const Theme& theme) {
  glEnable(GL_MULTISAMPLE);  // QPainter leaves it off
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glClearDepth(1);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  if (has_cloth_) draw_cloth(shot, theme);
  draw_obstacles(shot, theme);
  glDepthFunc(GL_LEQUAL);  // the background lies as far away as can be: what is covered is not painted
  draw_background(theme);
  glDepthFunc(GL_LESS);

  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);  // the view itself stays opaque
  glDepthMask(GL_FALSE);
  find_floors(shot);
  draw_floors(shot, theme);
  draw_shadows(shot, theme);
  if (has_cloth_ && surface_->has_pinned_points()) draw_pins(shot, theme);
  draw_targets(shot, theme);
  if (shot.contact)
    contact_->draw(*kit_, {shot.world_to_clip, shot.metres_per_pixel, shot.pixel_ratio, cell_on_screen(shot)},
                   theme);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
}

void ClothRenderer::draw_background(const Theme& theme) {
  kit_->background.bind();
  kit_->background.setUniformValue("top", as_srgb(theme.view_top));
  kit_->background.setUniformValue("bottom", as_srgb(theme.view_bottom));
  solids_->draw_screen();
  kit_->background.release();
}

void ClothRenderer::light(QOpenGLShaderProgram& program, const Shot& shot, const Theme& theme) {
  program.setUniformValue("world_to_clip", uniform_matrix(shot.world_to_clip));
  program.setUniformValue("eye", uniform_vector(shot.eye));
  // The key light goes half way with the eye: folds read the same from every side, yet turning shows relief.
  const Eigen::Vector3d key = Eigen::Vector3d(-0.20, 0.70, 0.20) - 0.35 * shot.forward - 0.65 * shot.right;
  const Eigen::Vector3d fill = 0.9 * shot.right - 0.45 * shot.forward - 0.1 * shot.up;
  program.setUniformValue("key_direction", uniform_vector(key.normalized()));
  program.setUniformValue("fill_direction", uniform_vector(fill.normalized()));
  program.setUniformValue("exposure", theme.dark ? 0.92F : 1.05F);
}

void ClothRenderer::begin_obstacles(const Shot& shot, const Theme& theme, float opacity) {
  kit_->solid.bind();
  light(kit_->solid, shot, theme);
  const QColor body = theme.dark ? mixed(theme.view_top, QColor(0xA6, 0xAB, 0xB3), 0.62F)
                                 : mixed(theme.view_top, QColor(0xB4, 0xB8, 0xBE), 0.75F);
  kit_->solid.setUniformValue("body_colour", linear_light(opacity < 1 ? theme.accent : body));
  kit_->solid.setUniformValue("opacity", opacity);
  // Cloth rests on the obstacles' surface with its particles, and its flat triangles cut below: the drawn
  // body is pushed back in depth, and a ball made smaller by the height of the arc over a cell's diagonal.
  glEnable(GL_CULL_FACE);  // pushed back, a near face could fall behind a far one
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 4.0F);
}

void ClothRenderer::end_obstacles() {
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
  kit_->solid.release();
}

void ClothRenderer::draw_obstacles(const Shot& shot, const Theme& theme) {
  begin_obstacles(shot, theme, 1);
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
    draw_obstacle(kit_->solid, obstacles_[k], k < poses_.size() ? poses_[k] : cloth::Pose{});
  end_obstacles();
}

/// Where an edit has put obstacles that are still on their way.
void ClothRenderer::draw_targets(const Shot& shot, const Theme& theme) {
  if (targets_ == poses_) return;
  begin_obstacles(shot, theme, 0.28F);
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
    if (targets_[k] != poses_[k]) draw_obstacle(kit_->solid, obstacles_[k], targets_[k]);
  end_obstacles();
}

void ClothRenderer::draw_obstacle(QOpenGLShaderProgram& program, const cloth::Obstacle& o,
                                  const cloth::Pose& pose) {
  using cloth::BodyKind;
  const BodyKind kind = shape_of(o).body;
  const cloth::PlacedSurface surface = shape_of(o).surface(o);
  if (kind == BodyKind::half_space || (kind == BodyKind::surface && !surface.mesh)) return;
  program.setUniformValue("center", uniform_vector(pose.at(cloth::pivot_of(o))));
  program.setUniformValue("turn", uniform_matrix(Eigen::Matrix3d(pose.rotation * surface.rotation)));
  if (kind == BodyKind::surface) {
    program.setUniformValue("scale", uniform_vector(surface.scale.cwiseProduct(pose.stretch)));
    bodies_->draw(*surface.mesh);
  } else if (kind == BodyKind::ball) {
    const double arc = o.radius > 0 ? cell_length_ * cell_length_ / (4 * o.radius) : 0;
    program.setUniformValue("scale",
                            uniform_vector((o.radius - std::min(arc, 0.05 * o.radius)) * pose.stretch));
    solids_->draw_sphere();
  } else {
    program.setUniformValue("scale", uniform_vector(0.995 * o.size.cwiseProduct(pose.stretch)));
    solids_->draw_box();
  }
}

void ClothRenderer::draw_cloth(const Shot& shot, const Theme& theme) {
  constexpr double small_cell = 16;  // px
  const bool quick = shot.quick && kit_->frugal() && cell_on_screen(shot) < small_cell;
  QOpenGLShaderProgram& cloth =
      (quick ? kit_->quick_cloth : kit_->cloth)[static_cast<std::size_t>(shot.mode)];
  cloth.bind();
  light(cloth, shot, theme);
  if (shot.mode == ViewMode::textured) {
    glBindTexture(GL_TEXTURE_2D, kit_->textures[quick ? RendererKit::stored_weave : RendererKit::weave]);
    cloth.setUniformValue("weave", 0);
    cloth.setUniformValue("tiles_per_cell", tiles_per_cell_);
  } else if (shot.mode == ViewMode::wireframe) {
    const QColor sheet = theme.dark ? QColor(0x3C, 0x46, 0x52) : QColor(0xF4, 0xF6, 0xF8);
    // A quick picture mixes squares of sRGB, which are nearly linear light and cheap to take the root of.
    const auto mixable = [quick](const QColor& c) {
      return quick ? as_srgb(c) * as_srgb(c) : linear_light(c);
    };
    cloth.setUniformValue("last_cell",
                          is_mesh_ ? QVector2D(1, 1) : QVector2D(number(columns_ - 1), number(rows_ - 1)));
    cloth.setUniformValue("line_width", number(1.25 * shot.pixel_ratio));
    cloth.setUniformValue("sheet_colour", mixable(sheet));
    cloth.setUniformValue("thread_colour", mixable(thread_colour(theme)));
  } else {
    glBindTexture(GL_TEXTURE_2D, kit_->textures[quick ? RendererKit::stored_palette : RendererKit::palette]);
    cloth.setUniformValue("strain_palette", 0);
    cloth.setUniformValue("strain_maximum", number(shot.strain_maximum));
  }
  const bool threads = is_mesh_ && shot.mode == ViewMode::wireframe;
  if (threads) {  // pushed back, so that its edges lie on it
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.0F, 1.0F);
    surface_->draw_plain_triangles();
    glDisable(GL_POLYGON_OFFSET_FILL);
  } else {
    surface_->draw_triangles();
  }
  glBindTexture(GL_TEXTURE_2D, 0);
  cloth.release();
  if (threads) draw_threads(shot, theme);
}

void ClothRenderer::draw_threads(const Shot& shot, const Theme& theme) {
  kit_->thread.bind();
  kit_->thread.setUniformValue("world_to_clip", uniform_matrix(shot.world_to_clip));
  kit_->thread.setUniformValue("thread_colour", as_srgb(thread_colour(theme)));
  surface_->draw_edges();
  kit_->thread.release();
}

double ClothRenderer::cell_on_screen(const Shot& shot) const {
  return cell_length_ / std::max(shot.metres_per_pixel, 1e-12);
}

/// Back to front as far as it matters: level ground lies below what is tilted.
void ClothRenderer::find_floors(const Shot& shot) {
  floors_.clear();
  if (!shot.ground.is_obstacle)
    floors_.push_back({{0, shot.ground.height, 0}, Eigen::Vector3d::UnitY(), true});
  for (const bool level_ones : {true, false}) {
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      const cloth::Obstacle& o = obstacles_[k];
      if (shape_of(o).body != cloth::BodyKind::half_space) continue;
      const cloth::Pose pose = k < poses_.size() ? poses_[k] : cloth::Pose{};
      const Eigen::Vector3d normal = pose.rotation * o.normal.normalized();
      const bool is_level = std::abs(normal.y()) > 0.999;
      if (normal.allFinite() && is_level == level_ones)
        floors_.push_back({pose.at(o.point), normal, is_level});
    }
  }
}

void ClothRenderer::draw_floors(const Shot& shot, const Theme& theme) {
  kit_->plane.bind();
  kit_->plane.setUniformValue("world_to_clip", uniform_matrix(shot.world_to_clip));
  kit_->plane.setUniformValue("line_width", number(shot.pixel_ratio));
  kit_->plane.setUniformValue("line_colour",
                              as_srgb(theme.dark ? QColor(0xC8, 0xD2, 0xDE) : QColor(0x30, 0x3C, 0x4A)));
  kit_->plane.setUniformValue("line_opacity", theme.dark ? 0.20F : 0.22F);
  for (const Floor& floor : floors_) draw_floor(shot, theme, floor);
  kit_->plane.release();
}

/// A tilted one is a sheet of the colour of bodies, or its slope would look like ground seen askew.
void ClothRenderer::draw_floor(const Shot& shot, const Theme& theme, const Floor& floor) {
  const auto& [point, normal, is_level] = floor;
  const Eigen::Vector3d about = shot.extent.isEmpty() ? point : shot.extent.center();
  const double size = shot.extent.isEmpty() ? 1 : shot.extent.diagonal().norm();
  // Along x and z on level ground; the other planes take the nearest such pair.
  const Eigen::Vector3d hint =
      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d u = (hint - hint.dot(normal) * normal).normalized(), v = normal.cross(u);
  const Eigen::Vector3d middle = about - (about - point).dot(normal) * normal;
  const QColor ground = theme.dark ? QColor(0x0A, 0x0D, 0x11) : QColor(Qt::white);
  const QColor sheet = theme.dark ? QColor(0x5A, 0x63, 0x6E) : QColor(0xA9, 0xB2, 0xBE);
  kit_->plane.setUniformValue("floor_colour", as_srgb(is_level ? ground : sheet));
  kit_->plane.setUniformValue("floor_opacity", !is_level ? 0.92F : theme.dark ? 0.22F : 0.35F);
  kit_->plane.setUniformValue("fade_from", is_level ? 0.25F : 0.55F);
  kit_->plane.setUniformValue("middle", uniform_vector(middle));
  kit_->plane.setUniformValue("axis_u", uniform_vector(u));
  kit_->plane.setUniformValue("axis_v", uniform_vector(v));
  kit_->plane.setUniformValue("reach", number((is_level ? 2.2 : 1.3) * size));
  kit_->plane.setUniformValue("grid_step", number(cloth::grid_step_for(size)));
  kit_->plane.setUniformValue("grid_offset", QVector2D(number(middle.dot(u)), number(middle.dot(v))));
  solids_->draw_strip();
}

/// Of cloth and bodies on what lies below them, so that their height is seen. The stencil lets every pixel
/// darken once.
void ClothRenderer::draw_shadows(const Shot& shot, const Theme& theme) {
  const Eigen::Vector3d light(-0.12, -1, -0.22);  // the same wherever the eye is
  const bool quick = shot.quick && kit_->frugal();
  QOpenGLShaderProgram& shadow = kit_->shadow;
  shadow.bind();
  shadow.setUniformValue("world_to_clip", uniform_matrix(shot.world_to_clip));
  shadow.setUniformValue("shade",
                         theme.dark ? QVector4D(0, 0, 0, 0.30F) : QVector4D(0.12F, 0.16F, 0.22F, 0.12F));
  glEnable(GL_STENCIL_TEST);
  glStencilMask(0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  GLint number_of_floor = 0;
  const bool sloped = std::any_of(floors_.begin(), floors_.end(), [](const Floor& f) { return !f.is_level; });
  for (const Floor& floor : floors_) {
    const bool made_up = floor.is_level && !shot.ground.is_obstacle;
    if (sloped && made_up) continue;  // what falls comes to lie on the slope
    const double steepness = -light.dot(floor.normal);
    if (steepness < 0.2 || floor.normal.dot(shot.eye - floor.point) <= 0) continue;
    glStencilFunc(GL_NOTEQUAL, ++number_of_floor, 0xFF);
    shadow.setUniformValue("on_plane", uniform_vector(floor.point));
    shadow.setUniformValue("normal", uniform_vector(floor.normal));
    shadow.setUniformValue("fall", uniform_vector(Eigen::Vector3d(light / steepness)));
    for (std::size_t k = 0; k < obstacles_.size(); ++k)
      if (!quick || !is_large(obstacles_[k]))
        draw_obstacle(shadow, obstacles_[k], k < poses_.size() ? poses_[k] : cloth::Pose{});
    if (!has_cloth_) continue;
    shadow.setUniformValue("center", QVector3D());
    shadow.setUniformValue("turn", uniform_matrix(Eigen::Matrix3d(Eigen::Matrix3d::Identity())));
    shadow.setUniformValue("scale", QVector3D(1, 1, 1));
    surface_->draw_triangles();
  }
  glDisable(GL_STENCIL_TEST);
  shadow.release();
}

void ClothRenderer::draw_pins(const Shot& shot, const Theme& theme) {
  // Smaller where a whole edge is pinned, so that the markers stay a row of dots.
  const double diameter =
      std::clamp(0.85 * cell_on_screen(shot), 4 * shot.pixel_ratio, 11 * shot.pixel_ratio);
  kit_->marker.bind();
  kit_->marker.setUniformValue("world_to_clip", uniform_matrix(shot.world_to_clip));
  kit_->marker.setUniformValue("diameter", number(diameter));
  kit_->marker.setUniformValue("disc_colour", as_srgb(theme.accent));
  kit_->marker.setUniformValue("rim_colour",
                               as_srgb(theme.dark ? QColor(0x12, 0x16, 0x1B) : QColor(Qt::white)));
  glEnable(GL_PROGRAM_POINT_SIZE);
  surface_->draw_pinned_points();
  glDisable(GL_PROGRAM_POINT_SIZE);
  kit_->marker.release();
}

}  // namespace clothlab
