#include "picture/picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "cloth/grid.h"
#include "picture/shapes.h"
#include "picture/strain_colours.h"
#include "scene/obstacle_shape.h"
#include "support/random.h"
#include "support/scenes.h"

namespace cloth::test::picture_test {
namespace {

/// Where `point` (m) is seen in a picture of width x height pixels; none behind the eye.
std::optional<Eigen::Vector2d> pixel_of(const PictureCamera& camera, int width, int height,
                                        const Vec3& point) {
  const EyeFrame frame(camera, width, height);
  const Vec3 in_eye = frame.to_eye(point);
  if (!(in_eye.z() >= frame.near) || !in_eye.allFinite()) return std::nullopt;
  return frame.to_pixel(in_eye);
}

constexpr int width = 160, height = 120;

/// Nothing but the background around the cloth.
PictureOptions bare_options() {
  PictureOptions options;
  options.width = width;
  options.height = height;
  options.ground = options.shadow = false;
  options.pattern = ClothPattern::none;
  return options;
}

/// A sheet of 5 x 5 particles, 0.4 m wide, in the plane z = 0, and a camera in front of its middle.
struct Sheet {
  Scene scene = bare_sheet(5, 5);
  ClothSystem system = make_grid(scene.cloth, only(SpringFamily::structural, 100));
  Vec3Field position = system.start;
  Vec3 middle = (system.start[0] + system.start[24]) / 2;
  PictureCamera camera{middle + Vec3(0, 0, 2), middle, {0, 1, 0}, 30};

  Image image(const PictureOptions& options = bare_options()) const {
    return cloth_image(scene, system, position, camera, options);
  }
  Image empty_image() const {
    return cloth_image(Scene(), ClothSystem(), Vec3Field(), camera, bare_options());
  }
  Obstacle ball_at(double z) const {
    Obstacle ball;
    ball.center = middle + Vec3(0, 0, z);
    ball.radius = 0.1;
    return ball;
  }
};

bool is_grey(Rgb c) {
  return std::max({c.red, c.green, c.blue}) - std::min({c.red, c.green, c.blue}) < 24;
}

TEST(Picture, AsAFileIsAPngThatReadsBackToThePixels) {
  const Sheet sheet;
  const Image image = sheet.image();
  const std::vector<std::uint8_t> file =
      cloth_picture(sheet.scene, sheet.system, sheet.position, sheet.camera, bare_options());
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, file.data(), file.size()), 0) << header.message;
  EXPECT_EQ(header.width, static_cast<unsigned>(width));
  EXPECT_EQ(header.height, static_cast<unsigned>(height));
  header.format = PNG_FORMAT_RGB;
  std::vector<Rgb> pixels(static_cast<std::size_t>(width * height));
  ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0) << header.message;
  EXPECT_EQ(pixels, image.pixels);
}

TEST(Picture, ShowsAFlatSheetExactlyWithinItsOutline) {
  const Sheet sheet;
  const Image image = sheet.image(), empty = sheet.empty_image();
  const auto first = pixel_of(sheet.camera, width, height, sheet.position[0]);  // top left
  const auto last = pixel_of(sheet.camera, width, height, sheet.position[24]);  // bottom right
  ASSERT_TRUE(first && last);
  ASSERT_GT(last->x() - first->x(), 40);
  ASSERT_GT(last->y() - first->y(), 40);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool inside = x >= first->x() && x + 1 <= last->x() && y >= first->y() && y + 1 <= last->y();
      const bool outside = x + 1 < first->x() || x > last->x() || y + 1 < first->y() || y > last->y();
      if (inside) {
        EXPECT_GT(image.at(x, y).red, image.at(x, y).blue + 20) << x << ", " << y;  // warm, not sky
      }
      if (outside) {
        EXPECT_EQ(image.at(x, y), empty.at(x, y)) << x << ", " << y;
      }
    }
  }
}

TEST(Picture, OfTheBackHasACoolerTintThanOfTheFront) {
  Sheet sheet;
  const Rgb front = sheet.image().at(width / 2, height / 2);
  sheet.camera.eye = sheet.middle - Vec3(0, 0, 2);
  const Rgb back = sheet.image().at(width / 2, height / 2);
  EXPECT_GT(front.red - front.blue, back.red - back.blue + 10);
}

TEST(Picture, ShowsTheNearerOfTwoSurfaces) {
  Sheet sheet;
  const Rgb cloth = sheet.image().at(width / 2, height / 2);
  sheet.scene.obstacles = {sheet.ball_at(-0.3)};
  EXPECT_EQ(sheet.image().at(width / 2, height / 2), cloth);
  sheet.scene.obstacles = {sheet.ball_at(0.3)};
  const Rgb ball = sheet.image().at(width / 2, height / 2);
  EXPECT_TRUE(is_grey(ball));
  EXPECT_FALSE(is_grey(cloth));
}

TEST(Picture, OfABoxCoversItsFacesFromEverySide) {
  Sheet sheet;
  Obstacle box;
  box.shape = &box_shape();
  box.center = sheet.middle;
  box.size = {1, 1, 1};
  sheet.scene.obstacles = {box};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-3.0, 3.0}) {
      sheet.camera.eye = sheet.middle + side * Vec3::Unit(axis);
      const Image image = sheet.image(), empty = sheet.empty_image();
      for (const int x : {width / 2 - 20, width / 2, width / 2 + 20})
        for (const int y : {height / 2 - 20, height / 2, height / 2 + 20}) {
          EXPECT_TRUE(is_grey(image.at(x, y))) << axis << ", " << side;
          EXPECT_FALSE(image.at(x, y) == empty.at(x, y)) << axis << ", " << side;
        }
    }
  }
}

TEST(PictureMeshes, OfBodiesAreCounterClockwiseSeenFromOutside) {
  for (const PictureMesh& mesh : {sphere_mesh({1, 2, 3}, 0.5), box_mesh({1, 2, 3}, {0.5, 1, 2}, 0.1),
                                  box_mesh({1, 2, 3}, {0.5, 1, 2}, 0)}) {
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const auto corner = [&](std::size_t k) {
        return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t + k])];
      };
      const Vec3 a = corner(0).position, cross = (corner(1).position - a).cross(corner(2).position - a);
      area += cross.norm() / 2;
      if (cross.norm() < 1e-12) continue;
      EXPECT_GT(cross.dot(a - Vec3(1, 2, 3)), 0) << t;
      for (std::size_t k = 0; k < 3 && mesh.triangles.size() > 1000; ++k)
        EXPECT_GE(cross.dot(corner(k).normal.cast<double>()), 0) << t;
    }
    EXPECT_GT(area, 3);
  }
}

TEST(Picture, OfUnstretchedClothInStrainColoursHasTheFirstColourAndOfStretchedTheLast) {
  Sheet sheet;
  PictureOptions options = bare_options();
  options.colouring = ClothColouring::strain;
  const auto lightness = [](Rgb c) { return 2 * c.red + 5 * c.green + c.blue; };
  const int unstretched = lightness(sheet.image(options).at(width / 2, height / 2));
  for (std::size_t i = 0; i < sheet.position.size(); ++i) sheet.position.set(i, 1.2 * sheet.position[i]);
  const int stretched = lightness(sheet.image(options).at(width / 2, height / 2));
  EXPECT_GT(stretched, 3 * unstretched);
}

TEST(Picture, OfASpringHasTheColourOfItsFamily) {
  Sheet sheet;
  sheet.camera.eye = sheet.middle + Vec3(0, 0, 0.6);
  PictureOptions options = bare_options();
  options.wireframe = true;
  const auto half_way = pixel_of(sheet.camera, width, height, (sheet.position[12] + sheet.position[13]) / 2);
  ASSERT_TRUE(half_way);
  const auto at_spring = [&](const Image& image) {
    return image.at(static_cast<int>(half_way->x()), static_cast<int>(half_way->y()));
  };
  const Rgb shown = at_spring(sheet.image(options));
  options.springs_shown = {false, false, false};
  EXPECT_GT(at_spring(sheet.image(options)).green, shown.green + 60);
}

TEST(Picture, OfABodyBehindAClothIsDarkerInItsShadow) {
  Sheet sheet;
  Obstacle wall;
  wall.shape = &box_shape();
  wall.center = sheet.middle - Vec3(0, 0, 1.3);
  wall.size = {2, 2, 2};
  sheet.scene.obstacles = {wall};
  PictureOptions options = bare_options();
  const Image lit = sheet.image(options);
  options.shadow = true;
  const Image shaded = sheet.image(options);
  int darker = 0, lighter = 0;
  for (std::size_t i = 0; i < lit.pixels.size(); ++i) {
    darker += shaded.pixels[i].green + 10 < lit.pixels[i].green ? 1 : 0;
    lighter += shaded.pixels[i].green > lit.pixels[i].green ? 1 : 0;
  }
  EXPECT_GT(darker, 200);
  EXPECT_EQ(lighter, 0);
  // No part of the cloth lies in its own shadow.
  EXPECT_EQ(shaded.at(width / 2, height / 2), lit.at(width / 2, height / 2));
}

TEST(Picture, HasObstaclesThatMoveWhereTheyAreAtItsTime) {
  Sheet sheet;
  Obstacle ball = sheet.ball_at(0.5);
  ball.radius = 0.05;
  ball.velocity = {0.2, 0, 0};
  sheet.scene.obstacles = {ball};
  Obstacle there = sheet.ball_at(0.5);
  there.radius = ball.radius;
  there.center += 2 * ball.velocity;
  Sheet resting;
  resting.scene.obstacles = {there};
  PictureOptions later = bare_options();
  later.time = 2;
  EXPECT_EQ(sheet.image(later).pixels, resting.image().pixels);
  EXPECT_NE(sheet.image().pixels, resting.image().pixels);
  EXPECT_EQ(camera_showing(sheet.scene, sheet.position, usual_direction, 1, {}, 2),
            camera_showing(resting.scene, resting.position, usual_direction, 1));
}

TEST(Picture, HasTurnedObstaclesTurned) {
  Sheet sheet;
  Obstacle box;
  box.shape = &box_shape();
  box.center = sheet.middle + Vec3(0, 0, 0.5);
  box.size = {0.3, 0.06, 0.06};
  sheet.scene.obstacles = {box};
  const Image lying = sheet.image();
  const double quarter = std::numbers::pi / 2;
  sheet.scene.obstacles[0].keyframes = {{.time = 0, .position = box.center, .rotation = {0, 0, quarter}}};
  const Image turned = sheet.image();
  std::swap(box.size.x(), box.size.y());
  sheet.scene.obstacles = {box};
  const Image upright = sheet.image();
  EXPECT_NE(lying.pixels, upright.pixels);
  int different = 0;  // its edges are cut by other triangles
  for (std::size_t k = 0; k < upright.pixels.size(); ++k)
    different += std::abs(int(upright.pixels[k].red) - int(turned.pixels[k].red)) > 8 ? 1 : 0;
  EXPECT_LT(different, width * height / 200);
}

TEST(Picture, HasTheSameBytesForTheSameInput) {
  Sheet sheet;
  sheet.scene.obstacles = {sheet.ball_at(-0.2)};
  PictureOptions options;
  options.width = width;
  options.height = height;
  EXPECT_EQ(cloth_picture(sheet.scene, sheet.system, sheet.position, sheet.camera, options),
            cloth_picture(sheet.scene, sheet.system, sheet.position, sheet.camera, options));
}

TEST(Picture, LeavesOutTheTrianglesOfAParticleThatIsNotFinite) {
  Sheet sheet;
  const Image whole = sheet.image(), empty = sheet.empty_image();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    sheet.position = sheet.system.start;
    const Vec3 hole = sheet.position[12], kept = (sheet.position[0] + sheet.position[6]) / 2;
    sheet.position.set(12, {bad, 0, 0});
    const Image image = sheet.image();
    const auto at = [&](const Vec3& p, const Image& in) {
      const Eigen::Vector2d pixel = pixel_of(sheet.camera, width, height, p).value();
      return in.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    };
    EXPECT_EQ(at(hole, image), at(hole, empty)) << bad;
    EXPECT_FALSE(at(kept, image) == at(kept, empty)) << bad;
  }
}

TEST(Picture, OfNothingThatCanBeSeenIsTheBackground) {
  Sheet sheet;
  PictureOptions options = bare_options();
  options.wireframe = true;
  const Image empty = sheet.empty_image();
  sheet.position.fill(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(sheet.image(options).pixels, empty.pixels);
  sheet.position = sheet.system.start;
  for (std::size_t i = 0; i < sheet.position.size(); ++i)
    sheet.position.add(i, {0, 0, 5});  // behind the camera
  EXPECT_EQ(sheet.image(options).pixels, empty.pixels);
  sheet.position.fill(0.1);  // a point
  EXPECT_EQ(sheet.image(options).pixels, empty.pixels);
}

TEST(Picture, IsMadeOfWhateverItIsGiven) {
  Sheet sheet;
  PictureOptions options;
  options.width = 40;
  options.height = 30;
  options.wireframe = true;
  options.arrows = {{{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {std::nan(""), 0, 0}}};
  Obstacle odd = sheet.ball_at(0);
  for (const ObstacleShape* one : obstacle_shapes()) {
    odd.shape = one;
    odd.radius = 0;
    odd.size = odd.normal = {0, 0, 0};
    sheet.scene.obstacles.push_back(odd);
  }
  const Vec3 none(0, 0, 0), bad = Vec3::Constant(std::nan(""));
  for (const PictureCamera& camera :
       {PictureCamera{none, none, none, 0}, PictureCamera{bad, bad, bad, std::nan("")},
        PictureCamera{sheet.position[12], sheet.position[0], {0, 1, 0}, 179},  // on the cloth
        PictureCamera{{0, 5, 0}, none, {0, 1, 0}, 30},                         // straight down
        camera_showing(sheet.scene, Vec3Field(25), none, 0)}) {
    sheet.camera = camera;
    EXPECT_EQ(sheet.image(options).pixels.size(), 40U * 30U);
  }
  options.width = options.height = 0;
  EXPECT_EQ(sheet.image(options).pixels.size(), 1U);
}

TEST(Picture, OfARunThatHasDivergedKeepsTheFloorWhereTheClothIs) {
  Sheet sheet;
  PictureOptions options = bare_options();
  options.ground = true;
  const Rgb corner = sheet.image(options).at(2, height - 2);
  sheet.position.set(12, Vec3::Constant(1e200));
  EXPECT_EQ(sheet.image(options).at(2, height - 2), corner);
}

TEST(PictureCamera, SeesRightToTheRightAndUpAbove) {
  const PictureCamera camera{{0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 90};
  const auto middle = pixel_of(camera, 200, 100, {0, 0, 0}), right = pixel_of(camera, 200, 100, {1, 0, 0}),
             top = pixel_of(camera, 200, 100, {0, 2, 0});
  EXPECT_LE((*middle - Eigen::Vector2d(100, 50)).norm(), 1e-12);
  EXPECT_LE((*right - Eigen::Vector2d(125, 50)).norm(), 1e-12);  // 1 m at 2 m: half of half the height
  EXPECT_LE((*top - Eigen::Vector2d(100, 0)).norm(), 1e-12);     // 45 degrees up
  EXPECT_FALSE(pixel_of(camera, 200, 100, {0, 0, 3}));
}

TEST(PictureCamera, ShowsAllOfClothBodiesAndArrowsFromEverySide) {
  Random random;
  const auto number = [&random] { return random.uniform(-1, 1); };
  for (int repeat = 0; repeat < 50; ++repeat) {
    Sheet sheet;
    for (std::size_t i = 0; i < sheet.position.size(); ++i)
      sheet.position.add(i, {number(), number(), number()});
    sheet.scene.obstacles = {sheet.ball_at(2 * number())};
    const std::vector<PictureArrow> arrows{{{number(), 2, 0}, {0, number(), -1}}};
    const Vec3 direction(number(), number(), number());
    const PictureCamera camera =
        camera_showing(sheet.scene, sheet.position, direction, double(width) / height, arrows);
    std::vector<Vec3> points{arrows[0].from, arrows[0].to};
    for (std::size_t i = 0; i < sheet.position.size(); ++i) points.push_back(sheet.position[i]);
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
      for (const double side : {-0.1, 0.1}) points.push_back(sheet.scene.obstacles[0].center + side * axis);
    double fullest = 0;
    for (const Vec3& p : points) {
      const auto pixel = pixel_of(camera, width, height, p);
      ASSERT_TRUE(pixel);
      const Eigen::Vector2d off(2 * pixel->x() / width - 1, 2 * pixel->y() / height - 1);
      EXPECT_LT(off.cwiseAbs().maxCoeff(), 1);
      fullest = std::max(fullest, off.cwiseAbs().maxCoeff());
    }
    EXPECT_GT(fullest, 0.75);  // as near as that allows
  }
}

TEST(PictureCamera, LeavesOutParticlesThatAreNotFinite) {
  Sheet sheet;
  const PictureCamera camera = camera_showing(sheet.scene, sheet.position);
  Vec3Field with_bad(27);
  for (std::size_t i = 0; i < 25; ++i) with_bad.set(i, sheet.position[i]);
  with_bad.set(25, Vec3::Constant(std::nan("")));
  with_bad.set(26, Vec3::Constant(1e30));
  EXPECT_EQ(camera_showing(sheet.scene, with_bad), camera);
}

TEST(WindArrows, PointAlongTheWindAndLieBeforeTheCloth) {
  Sheet sheet;
  EXPECT_TRUE(wind_arrows(sheet.scene, sheet.position).empty());
  sheet.scene.air.emplace().wind = {0, 0, -3};
  const std::vector<PictureArrow> arrows = wind_arrows(sheet.scene, sheet.position);
  ASSERT_FALSE(arrows.empty());
  for (const PictureArrow& arrow : arrows) {
    EXPECT_GT((arrow.to - arrow.from).normalized().dot(Vec3(0, 0, -1)), 1 - 1e-12);
    EXPECT_GT(arrow.to.z(), 0);
  }
}

TEST(StrainColours, RunFromDarkToLightAndStopAtTheEnds) {
  const auto lightness = [](Rgb c) { return 2 * c.red + 5 * c.green + c.blue; };
  for (std::size_t i = 1; i < strain_colours().size(); ++i)
    EXPECT_GE(lightness(strain_colours()[i]), lightness(strain_colours()[i - 1])) << i;
  EXPECT_EQ(strain_colour(-1, 0.1), strain_colours().front());
  EXPECT_EQ(strain_colour(0.05, 0.1), strain_colours()[128]);
  EXPECT_EQ(strain_colour(2, 0.1), strain_colours().back());
  EXPECT_EQ(strain_colour(std::nan(""), 0.1), strain_colours().back());
}

}  // namespace
}  // namespace cloth::test::picture_test
