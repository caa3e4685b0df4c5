#include "picture/picture.h"

#include <algorithm>
#include <cmath>

#include "cloth/mesh_cloth.h"
#include "geometry/mesh_look.h"
#include "picture/floor.h"
#include "picture/shapes.h"
#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

constexpr int max_pixels = 8192;          // either way
constexpr double bands_along_cloth = 12;  // of the pattern, over the longer side
constexpr double edge_cut = 0.6;          // of a cell, off a box's size
constexpr Rgb warp{0xea, 0xd6, 0xc8}, weft{0xd0, 0x9f, 0x8e};
const Colour back_tint(0.56F, 0.70F, 0.86F);  // the back of the cloth is duller and cooler

void move(PictureMesh& mesh, const Pose& pose) {
  if (pose == Pose{}) return;
  const Eigen::Matrix3f turn = pose.rotation.cast<float>();
  for (PictureVertex& vertex : mesh.vertices) {
    vertex.position = pose.at(vertex.position);
    vertex.normal = turn * vertex.normal;
  }
}

/// One picture in the making.
class Painter {
 public:
  Painter(const Scene& scene, const ClothSystem& system, const Vec3Field& position,
          const PictureCamera& camera, const PictureOptions& options)
      : scene_(scene),
        system_(system),
        position_(position),
        options_(options),
        theme_(*options.theme),
        width_(std::clamp(options.width, 1, max_pixels)),
        height_(std::clamp(options.height, 1, max_pixels)),
        frame_(camera, width_, height_),
        light_(frame_, theme_.exposure),
        canvas_(frame_, light_, width_, height_),
        has_cloth_(system.size() > 0 && position.size() == static_cast<std::size_t>(system.size()) &&
                   system.pinned.size() == position.size()) {}

  Image paint();

 private:
  void add_obstacles();
  void add_cloth();
  void add_springs();
  void add_spring(const SpringRun& run, int particle, double width, int surface);
  void add_pins();
  void add_arrows();
  void cast_on_bodies();
  void add_floors();
  double cell_pixels() const;

  const Scene& scene_;
  const ClothSystem& system_;
  const Vec3Field& position_;
  const PictureOptions& options_;
  const PictureTheme& theme_;
  int width_, height_;
  EyeFrame frame_;
  Light light_;
  Rasteriser canvas_;
  bool has_cloth_;
  Eigen::AlignedBox3d extent_;
  std::vector<PictureMesh> meshes_;  // what throws shadows
  std::vector<Floor> floors_;
  FloorShadow shadow_;
  KeyShadow key_shadow_;
};

/// px, of the rest length of a structural spring at the middle of the cloth.
double Painter::cell_pixels() const {
  if (extent_.isEmpty() || system_.springs.empty()) return 8;
  const double depth = frame_.to_eye(extent_.center()).z();
  return (*system_.springs.begin()).rest_length * frame_.focal_length / std::max(depth, frame_.near);
}

void Painter::add_obstacles() {
  // Cloth rests on the obstacles' surface with its particles, and its flat cells cut below. So that they stay
  // seen, bodies are drawn a little farther away and smaller: a ball by the height of the arc over a cell's
  // diagonal, a box by what a cell across its edge cuts off, its edges rounded.
  PictureSurface surface;
  surface.look = Look::matte;
  surface.front = surface.back = linear_light(theme_.body);
  surface.nearer = -0.004F;
  const int matte = canvas_.add_surface(surface);
  const double cell = system_.springs.empty() ? 0 : (*system_.springs.begin()).rest_length;
  for (const Obstacle& o : scene_.obstacles) {
    const Eigen::AlignedBox3d bounds = shape_of(o).bounds_at(o, pose_of(o, options_.time));
    if (bounds.isEmpty() || !bounds.min().allFinite() || !bounds.max().allFinite()) continue;
    PictureMesh mesh;
    const BodyKind kind = shape_of(o).body;
    if (kind == BodyKind::surface) {
      mesh = body_mesh(placed_mesh(o));
    } else if (kind == BodyKind::ball) {
      const double arc = o.radius > 0 ? std::min(cell * cell / (4 * o.radius), 0.05 * o.radius) : 0;
      mesh = sphere_mesh(o.center, o.radius - arc);
    } else {
      const Vec3 cut = (0.2 * o.size).cwiseMin(edge_cut * cell);
      mesh = box_mesh(o.center, o.size - cut, cut.minCoeff());
    }
    move(mesh, pose_of(o, options_.time));
    canvas_.add_mesh(mesh.vertices, mesh.triangles, matte);
    meshes_.push_back(std::move(mesh));
    extent_.extend(bounds);
  }
}

void Painter::add_cloth() {
  PictureSurface surface;
  surface.look = options_.colouring == ClothColouring::strain ? Look::strain : Look::woven;
  const bool plain = options_.wireframe || options_.pattern == ClothPattern::none;
  surface.weave = plain                                       ? Weave::plain
                  : options_.pattern == ClothPattern::stripes ? Weave::stripes
                                                              : Weave::checks;
  const Eigen::Vector2d size = system_.is_mesh() ? flat_pattern(rest_surface(system_)).size
                                                 : Eigen::Vector2d(scene_.cloth.width, scene_.cloth.height);
  const Eigen::Vector2d bands = bands_along_cloth * size / std::max(size.maxCoeff(), 1e-9);
  surface.bands = {static_cast<float>(bands.x()), static_cast<float>(bands.y())};
  surface.front = linear_light(options_.wireframe ? theme_.sheet : warp);
  surface.back =
      options_.wireframe ? linear_light(theme_.sheet_back) : Colour(back_tint.cwiseProduct(surface.front));
  if (plain && !options_.wireframe) surface.front = 0.5F * (linear_light(warp) + linear_light(weft));
  surface.front_thread = linear_light(weft);
  surface.back_thread = back_tint.cwiseProduct(surface.front_thread);
  meshes_.push_back(sheet_mesh(system_, position_, options_.strain_scale));
  canvas_.add_mesh(meshes_.back().vertices, meshes_.back().triangles, canvas_.add_surface(surface));
}

void Painter::add_springs() {
  const double cell = cell_pixels();
  for (const SpringRun& run : system_.springs) {
    if (!options_.springs_shown[static_cast<std::size_t>(run.family)]) continue;
    PictureSurface thread;
    thread.look = Look::flat;
    thread.front = linear_light(spring_colour(run.family));
    thread.nearer = run.family == SpringFamily::structural ? 0.005F : 0.004F;
    const int surface = canvas_.add_surface(thread);
    const bool structural = run.family == SpringFamily::structural;
    const double width = structural ? std::clamp(0.1 * cell, 0.9, 2.5) : std::clamp(0.06 * cell, 0.4, 1.8);
    for (int i = run.first; i < run.first + run.count; ++i) add_spring(run, i, width, surface);
  }
}

void Painter::add_spring(const SpringRun& run, int particle, double width, int surface) {
  const Vec3 from = position_[static_cast<std::size_t>(particle)];
  const Vec3 to = position_[static_cast<std::size_t>(particle + run.offset)];
  if (run.family != SpringFamily::flexion || system_.is_mesh()) {
    canvas_.add_line(from, to, width, surface);
    return;
  }
  // A flexion spring of a grid lies over two structural ones: it is drawn as a bow beside them.
  const PictureVertex& middle = meshes_.back().vertices[static_cast<std::size_t>(particle + run.offset / 2)];
  const Vec3 side = 0.14 * (to - from).cross(middle.normal.cast<double>());
  constexpr int pieces = 6;
  Vec3 last = from;
  for (int k = 1; k <= pieces; ++k) {
    const double t = static_cast<double>(k) / pieces, bow = 4 * t * (1 - t);
    // Along the sheet, which bends between the ends.
    const Vec3 sag = middle.position - 0.5 * (from + to);
    const Vec3 next = from + t * (to - from) + bow * (sag + side);
    canvas_.add_line(last, next, width, surface);
    last = next;
  }
}

void Painter::add_pins() {
  PictureSurface marker;
  marker.look = Look::flat;
  marker.front = linear_light(theme_.pin);
  marker.back = linear_light(theme_.pin_rim);
  marker.nearer = 0.01F;
  const int surface = canvas_.add_surface(marker);
  const double scale = std::max(1.0, height_ / 480.0);
  // Smaller where a whole edge is pinned, so that the markers stay a row of dots.
  const auto held = [this](int i) { return system_.pinned[static_cast<std::size_t>(i)] != 0; };
  bool in_a_row = false;
  for (int i = 0; i + 1 < system_.size(); ++i)
    in_a_row =
        in_a_row || system_.is_mesh() ||
        (held(i) && (held(i + 1) || (i + system_.columns < system_.size() && held(i + system_.columns))));
  const double largest = 10 * scale;
  const double diameter = in_a_row ? std::clamp(0.85 * cell_pixels(), 3 * scale, largest) : largest;
  for (std::size_t i = 0; i < position_.size(); ++i)
    if (system_.pinned[i] != 0) canvas_.add_disc(position_[i], diameter, surface);
}

void Painter::add_arrows() {
  const double scale = std::max(1.0, height_ / 480.0);
  for (const PictureArrow& arrow : options_.arrows) {
    PictureSurface surface;
    surface.look = Look::flat;
    surface.nearer = 0.999F;  // over everything
    surface.front = linear_light(arrow.colour);
    canvas_.add_arrow(arrow.from, arrow.to, 2.5 * scale, 12 * scale, canvas_.add_surface(surface));
  }
}

void Painter::cast_on_bodies() {
  key_shadow_ = KeyShadow(light_.key_direction(), extent_);
  for (const PictureMesh& mesh : meshes_) {
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      std::array<Vec3, 3> corner;
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t + k])].position;
      if (extent_.contains(corner[0]) && extent_.contains(corner[1]) && extent_.contains(corner[2]))
        key_shadow_.add_triangle(corner);
    }
  }
  light_.set_key_shadow(&key_shadow_);
}

void Painter::add_floors() {
  std::optional<double> level;
  for (const Obstacle& o : scene_.obstacles) {
    const double length = o.normal.norm();
    if (shape_of(o).body != BodyKind::half_space || !o.point.allFinite() || !std::isfinite(length) ||
        !(length > 0))
      continue;
    const Pose pose = pose_of(o, options_.time);
    const Vec3 point = pose.at(o.point), normal = pose.rotation * (o.normal / length);
    floors_.emplace_back(point, normal, extent_, theme_);
    if (floors_.back().is_level()) level = std::max(level.value_or(point.y()), point.y());
  }
  // What is not level comes first and hides what lies behind it. On a slope, unlike a wall, what falls comes
  // to lie.
  std::stable_partition(floors_.begin(), floors_.end(), [](const Floor& f) { return !f.is_level(); });
  const bool catches = std::any_of(floors_.begin(), floors_.end(),
                                   [](const Floor& f) { return std::abs(f.normal.y()) > 0.2; });
  if (!catches && options_.ground && !extent_.isEmpty()) {
    level = extent_.min().y() - 0.06 * extent_.diagonal().norm();
    floors_.emplace_back(Vec3(0, *level, 0), Vec3::UnitY(), extent_, theme_);
  }
  if (!options_.shadow) return;
  cast_on_bodies();
  if (!level) return;
  shadow_ = FloorShadow(*level, light_.shadow_direction(), extent_);
  for (const PictureMesh& mesh : meshes_) shadow_.add(mesh.vertices, mesh.triangles);
  shadow_.blur();
  for (Floor& floor : floors_)
    if (floor.is_level() && floor.point.y() == *level) floor.shadow = &shadow_;
}

Image Painter::paint() {
  constexpr double scene_reach = 1e4;  // m: a run that has diverged must not take the floor with it
  if (has_cloth_)
    for (std::size_t i = 0; i < position_.size(); ++i)
      if (position_[i].allFinite() && position_[i].norm() < scene_reach) extent_.extend(position_[i]);
  add_obstacles();
  if (has_cloth_) {
    add_cloth();
    if (options_.wireframe) add_springs();
    add_pins();
  }
  add_arrows();
  add_floors();
  const Colour top = linear_light(theme_.background_top), bottom = linear_light(theme_.background_bottom);
  return canvas_.draw(
      [&](int row) -> Colour {
        const float share = (static_cast<float>(row) + 0.5F) / static_cast<float>(height_);
        return (1 - share) * top + share * bottom;
      },
      [this](SampleBand& band) {
        for (const Floor& floor : floors_) lay_floor(floor, frame_, band);
      });
}

}  // namespace

std::vector<PictureArrow> wind_arrows(const Scene& scene, const Vec3Field& position) {
  constexpr double max_distance = 1e4;  // m
  if (!scene.air || !scene.air->wind.allFinite() || !(scene.air->wind.norm() > 0)) return {};
  Eigen::AlignedBox3d cloth;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (position[i].allFinite() && position[i].norm() < max_distance) cloth.extend(position[i]);
  if (cloth.isEmpty()) return {};
  const Vec3 along = scene.air->wind.normalized();
  const Vec3 level = along.cross(Vec3::UnitY());
  const Vec3 side = level.norm() > 1e-3 ? Vec3(level.normalized()) : Vec3::UnitX();
  const double size = cloth.diagonal().norm();
  // Side by side on the windward side, with a little air between their tips and the cloth.
  const double reach = 0.5 * cloth.sizes().dot(along.cwiseAbs()) + 0.08 * size;
  std::vector<PictureArrow> arrows;
  for (const double place : {-0.2, 0.0, 0.2}) {
    const Vec3 tip = cloth.center() + place * size * side - reach * along;
    arrows.push_back({tip - 0.25 * size * along, tip});
  }
  return arrows;
}

Rgb spring_colour(SpringFamily family) {
  constexpr Rgb colours[] = {{0x2f, 0x42, 0x57}, {0xd9, 0x73, 0x0d}, {0x0a, 0x8f, 0x8f}};
  return colours[static_cast<std::size_t>(family)];
}

Image cloth_image(const Scene& scene, const ClothSystem& system, const Vec3Field& position,
                  const PictureCamera& camera, const PictureOptions& options) {
  return Painter(scene, system, position, camera, options).paint();
}

std::vector<std::uint8_t> cloth_picture(const Scene& scene, const ClothSystem& system,
                                        const Vec3Field& position, const PictureCamera& camera,
                                        const PictureOptions& options) {
  return png_file(cloth_image(scene, system, position, camera, options));
}

}  // namespace cloth
