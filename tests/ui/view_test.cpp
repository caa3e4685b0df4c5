// Laws of the 3-D view: what is drawn where, and where the camera looks from. Runs on a real display (Xvfb
// with GLX will do).
#include "listed_test.h"
#include "scene/obstacle_shape.h"
#include "view_fixture.h"

namespace clothlab::test::view_test {

class ViewTest : public ViewFixture {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }
  void init() { open(); }
  void cleanup() { view_.reset(); }

  // ---- pixels
  // ------------------------------------------------------------------------------------------------------

  void a_cloth_is_drawn_where_its_particles_project() {
    const QImage with = picture();
    view_->clear();
    const QImage without = picture();
    const auto changed = [&](QPoint p) { return distance(with.pixelColor(p), without.pixelColor(p)) > 12; };
    for (int r = 1; r + 1 < side; r += 3)
      for (int c = 1; c + 1 < side; c += 3) {
        const Eigen::Vector3d p(c / (side - 1.0) - 0.5, 1 - r / (side - 1.0), 0);
        QVERIFY2(changed(rounded(view_->camera().project(p))), "a particle inside the sheet is covered");
      }
    for (const Eigen::Vector3d& beside :
         {Eigen::Vector3d(-0.6, 0.5, 0), Eigen::Vector3d(0.6, 0.7, 0), Eigen::Vector3d(0.2, 1.1, 0)})
      QVERIFY2(!changed(rounded(view_->camera().project(beside))), "beside the sheet nothing is drawn");
  }

  void a_cloth_that_moves_is_drawn_at_its_new_place() {
    auto moved = std::make_shared<ClothFrame>(*flat_cloth());
    for (std::size_t i = 0; i < moved->positions.size(); i += 3) moved->positions[i] += 1.1F;
    const QImage before = picture();
    view_->showFrame(moved);
    const QImage after = picture();
    const QPoint old_place = rounded(view_->camera().project({-0.2, 0.5, 0}));
    const QPoint new_place = rounded(view_->camera().project({0.8, 0.5, 0}));
    QVERIFY(distance(before.pixelColor(old_place), after.pixelColor(old_place)) > 12);
    QVERIFY(distance(before.pixelColor(new_place), after.pixelColor(new_place)) > 12);
  }

  void a_cloth_that_has_left_the_picture_is_missed_and_one_looked_at_closely_is_not() {
    QVERIFY(!view_->clothIsOutOfSight());
    view_->setCameraPose(head_on(0.02));  // between four particles, the nose on the cloth
    QVERIFY(!view_->clothIsOutOfSight());
    view_->setCameraPose(head_on());
    const auto lower_edge = [this] { return picture().copy(0, 450, 600, 50); };
    auto away = std::make_shared<ClothFrame>(*flat_cloth());
    for (std::size_t i = 2; i < away->positions.size(); i += 3) away->positions[i] += 100;  // behind the eye
    const QImage before = lower_edge();
    view_->showFrame(away);
    QVERIFY(view_->clothIsOutOfSight());
    QVERIFY2(lower_edge() != before, "it is said at the lower edge");
    view_->frameAll();
    QVERIFY(!view_->clothIsOutOfSight());
  }

  void nearly_all_of_it_is_enough_under_a_camera_that_nobody_moved() {
    view_->resetCamera();
    auto away = std::make_shared<ClothFrame>(*flat_cloth());
    for (std::size_t i = 3; i < away->positions.size(); ++i) away->positions[i] += 100;  // but for a corner
    view_->showFrame(away);
    QVERIFY(view_->clothIsOutOfSight());
    view_->setCameraPose(view_->camera().pose());
    QVERIFY2(!view_->clothIsOutOfSight(), "whoever looks at that corner may");
  }

  void the_texture_shows_both_thread_colours() {
    view_->setCameraPose(head_on(0.25));  // threads of some ten pixels
    const QImage image = picture();
    int warp = 0, weft = 0, all = 0;
    for (int y = 150; y < 350; ++y)
      for (int x = 200; x < 400; ++x, ++all) {
        const QColor c = image.pixelColor(x, y);
        (is_weft(c) ? weft : warp)++;
      }
    QVERIFY2(warp > all / 5 && weft > all / 5,
             qPrintable(QString("%1 warp, %2 weft of %3").arg(warp).arg(weft).arg(all)));
    int crossings = 0;  // from one kind of thread to the other, along that line of pixels which has most
    for (int y = 240; y < 260; ++y) {
      int along_line = 0;
      for (int x = 201; x < 400; ++x)
        along_line += is_weft(image.pixelColor(x - 1, y)) != is_weft(image.pixelColor(x, y));
      crossings = std::max(crossings, along_line);
    }
    QVERIFY2(crossings >= 8 && crossings <= 100, qPrintable(QString::number(crossings)));
  }

  void the_weave_is_the_same_every_time_and_has_no_seam() {
    const QImage tile = weave_tile(256);
    QCOMPARE(weave_tile(256), tile);
    const auto step_across = [&](int left, int right) {
      double sum = 0;
      for (int y = 0; y < 256; ++y) sum += distance(tile.pixelColor(left, y), tile.pixelColor(right, y));
      return sum;
    };
    double largest_inside = 0;  // between two threads
    for (int x = 16; x < 256; x += 16) largest_inside = std::max(largest_inside, step_across(x - 1, x));
    QVERIFY(step_across(255, 0) <= 1.1 * largest_inside);
  }

  void mipmaps_keep_the_light() {
    QImage chequered(4, 4, QImage::Format_RGBA8888);
    for (int i = 0; i < 16; ++i)
      chequered.setPixelColor(i % 4, i / 4, (i + i / 4) % 2 == 0 ? QColor(255, 200, 0) : QColor(0, 200, 0));
    const std::vector<QImage> levels = mipmaps_of(chequered);
    QCOMPARE(levels.size(), std::size_t{3});
    QCOMPARE(levels.back().size(), QSize(1, 1));
    QCOMPARE(levels.back().pixelColor(0, 0), QColor(188, 200, 0));  // sRGB of half the light, not 128
  }

  void modes_look_different() {
    QList<QImage> looks;
    for (const ViewMode mode : {ViewMode::textured, ViewMode::wireframe, ViewMode::strain}) {
      view_->setMode(mode);
      looks.push_back(picture());
    }
    const QRect sheet = QRect(at(0), at(side * side - 1)).normalized().adjusted(10, 10, -10, -10);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < i; ++k) {
        int different = 0, all = 0;
        for (int y = sheet.top(); y < sheet.bottom(); y += 2)
          for (int x = sheet.left(); x < sheet.right(); x += 2, ++all)
            different += distance(looks[i].pixelColor(x, y), looks[k].pixelColor(x, y)) > 20;
        QVERIFY2(different > all / 2,
                 qPrintable(QString("modes %1 and %2: %3 of %4").arg(i).arg(k).arg(different).arg(all)));
      }
  }

  void wireframe_lines_run_through_the_particles() {
    view_->setMode(ViewMode::wireframe);
    const QImage image = picture();
    const auto darkest_about = [&](const Eigen::Vector3d& p) {
      const QPoint middle_pixel = rounded(view_->camera().project(p));
      int darkest = 255;
      for (const QPoint by : {QPoint(0, 0), QPoint(-1, 0), QPoint(0, -1), QPoint(-1, -1)})
        darkest = std::min(darkest, image.pixelColor(middle_pixel + by).lightness());
      return darkest;
    };
    const double cell = 1.0 / (side - 1);
    for (int r = 2; r + 2 < side; r += 3)
      for (int c = 2; c + 2 < side; c += 3) {
        const Eigen::Vector3d p(c * cell - 0.5, 1 - r * cell, 0);
        const Eigen::Vector3d between = p + Eigen::Vector3d(cell / 2, cell / 2, 0);
        QVERIFY2(darkest_about(p) < darkest_about(between) - 20,
                 "on the light theme lines are darker than the sheet");
      }
  }

  void strain_mode_colours_follow_the_strain() {
    view_->setMode(ViewMode::strain);
    const QImage image = picture();
    double last = -1;
    for (int c = 1; c < side - 1; c += 3) {
      const QColor seen = image.pixelColor(at(side / 2 * side + c));
      const QColor meant = strain_colour(0.2 * c / (side - 1) / 0.2);
      QVERIFY2(distance(seen, meant) < 70, qPrintable(seen.name() + " for " + meant.name()));
      QVERIFY2(qGray(seen.rgb()) > last, "lighter where more strained");
      last = qGray(seen.rgb());
    }
    QVERIFY(saturation(image.pixelColor(at(middle()))) > 0.3);
  }

  void pinned_particles_wear_the_accent() {
    const QColor centre = picture().pixelColor(at(0));
    QVERIFY2(distance(centre, theme().accent) < 40, qPrintable(centre.name()));
  }

  void obstacles_and_their_covering_of_the_cloth_are_drawn() {
    auto frame = std::make_shared<ClothFrame>(*flat_cloth());
    const QImage before = picture();
    cloth::Obstacle ball, box;
    ball.center = {0, 0.5, 0.5}, ball.radius = 0.15;
    box.shape = &cloth::box_shape(), box.center = {0.8, 0.5, 0}, box.size = {0.2, 0.2, 0.2};
    frame->obstacles = {ball, box};
    view_->showFrame(frame);
    const QImage after = picture();
    for (const Eigen::Vector3d& p : {ball.center, box.center}) {
      const QPoint place = rounded(view_->camera().project(p));
      QVERIFY(distance(before.pixelColor(place), after.pixelColor(place)) > 10);
      QVERIFY2(saturation(after.pixelColor(place)) < 0.2, "obstacles are neutral");
    }
  }

  void an_empty_view_says_so() {
    view_->clear();
    const QImage empty = picture();
    int written = 0;
    for (int x = 150; x < 450; ++x)
      for (int y = 190; y < 270; ++y) written += empty.pixelColor(x, y).lightness() < 120;
    QVERIFY2(written > 100, "dark text in the middle of the light view");
  }

  void frames_that_contradict_themselves_are_ignored() {
    auto wrong = std::make_shared<ClothFrame>(*flat_cloth(7));
    wrong->positions.pop_back();
    view_->showFrame(wrong);
    QCOMPARE(view_->frame()->topology, 1U);
    view_->showFrame(nullptr);
    QVERIFY(view_->frame());
  }

  void the_edges_of_the_cloth_are_smooth() {
    view_->clear();
    const QImage without = picture();
    view_->showFrame(flat_cloth(2));
    view_->setMode(ViewMode::strain);
    view_->setCameraPose({{0, 0.5, 0}, 3, 0.3, 0.2});  // a slanting upper edge
    const QImage with = picture();
    int between = 0;  // columns whose edge pixel mixes cloth and background
    for (int x = 230; x < 370; ++x)
      for (int y = 1; y < 400; ++y) {
        const double covered = distance(with.pixelColor(x, y), without.pixelColor(x, y));
        if (covered < 12) continue;
        between += covered < 0.8 * distance(with.pixelColor(x, y + 3), without.pixelColor(x, y + 3));
        break;
      }
    QVERIFY2(between > 50, qPrintable(QString::number(between)));
  }

  void every_picture_is_timed() {
    QSignalSpy drawn(view_.get(), &ClothView::frameDrawn);
    view_->showFrame(flat_cloth());
    picture();
    QVERIFY(drawn.count() >= 1);
    QCOMPARE(drawn.last().at(0).toDouble(), view_->lastDrawMilliseconds());
    QVERIFY(view_->lastDrawMilliseconds() > 0);
  }

  // ---- the hand
  // ----------------------------------------------------------------------------------------------------

  void presets_look_from_the_named_side_with_y_up() {
    const std::pair<CameraPreset, Eigen::Vector3d> sides[] = {
        {CameraPreset::front, {0, 0, 1}}, {CameraPreset::back, {0, 0, -1}},
        {CameraPreset::left, {-1, 0, 0}}, {CameraPreset::right, {1, 0, 0}},
        {CameraPreset::top, {0, 1, 0}},   {CameraPreset::isometric, Eigen::Vector3d(1, 1, 1).normalized()}};
    for (const auto& [preset, from] : sides) {
      view_->setPreset(preset);
      const Camera& camera = view_->camera();
      QVERIFY((camera.forward() + from).norm() < 1e-9);
      QVERIFY(camera.up().y() >= -1e-9);
      QVERIFY(std::abs(camera.right().cross(camera.up()).dot(-camera.forward()) - 1) < 1e-9);
    }
  }

  void a_camera_that_was_not_moved_follows_a_new_topology_and_one_that_was_stays() {
    view_->resetCamera();
    auto far_away = std::make_shared<ClothFrame>(*flat_cloth(2));
    for (std::size_t i = 0; i < far_away->positions.size(); i += 3) far_away->positions[i] += 10;
    view_->showFrame(far_away);
    QVERIFY(std::abs(view_->camera().pose().target.x() - 10) < 0.2);
    drag(*view_, {10, 10}, {40, 10}, Qt::RightButton);
    const CameraPose moved = view_->camera().pose();
    view_->showFrame(flat_cloth(3));
    QVERIFY(view_->camera().pose() == moved);
    view_->resetCamera();
    QVERIFY(std::abs(view_->camera().pose().target.x()) < 0.2);
  }

  // ---- ground
  // ---------------------------------------------------------------------------------------------------------

  void the_ground_is_the_level_plane_or_below_where_the_cloth_can_hang() {
    const auto lying = std::make_shared<ClothFrame>(*flat_cloth());
    for (std::size_t i = 0; i < lying->positions.size();
         i += 3) {  // pinned at one corner, lying flat at y = 1
      lying->positions[i + 2] = 1 - lying->positions[i + 1];
      lying->positions[i + 1] = 1;
    }
    const Ground below = ground_below(reach_of_cloth(*lying), {});
    QVERIFY(!below.is_obstacle);
    QVERIFY2(below.height < 1 - std::numbers::sqrt2 + 0.05, "the diagonal hangs down from the pin");
    cloth::Obstacle plane;
    plane.shape = &cloth::plane_shape();
    plane.point = {0, -0.3, 0};
    QVERIFY(ground_below(reach_of_cloth(*lying), {plane}).is_obstacle);
    QCOMPARE(ground_below(reach_of_cloth(*lying), {plane}).height, -0.3);
  }
};

const Listed listed{"view_test", test_main<ViewTest>};

}  // namespace clothlab::test::view_test

#include "view_test.moc"
