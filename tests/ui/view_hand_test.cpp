// What the mouse means in the 3-D view: pulling, the brush, picking, tools.
#include "listed_test.h"
#include "view_fixture.h"

namespace clothlab::test::view_hand_test {

class ViewHandTest : public ViewFixture {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }
  void init() { open(); }
  void cleanup() { view_.reset(); }

  void dragging_the_cloth_pulls_the_particle_under_the_cursor() {
    QSignalSpy pulled(view_.get(), &ClothView::pullChanged), ended(view_.get(), &ClothView::pullEnded);
    const QPoint from = at(middle()), to = from + QPoint(60, -40);
    drag(*view_, from, to, Qt::LeftButton, {}, false);
    QVERIFY(pulled.count() >= 3);
    const auto first = pulled.first().at(0).value<cloth::Pull>(),
               last = pulled.last().at(0).value<cloth::Pull>();
    QCOMPARE(first.particle, middle());
    QCOMPARE(last.particle, middle());
    QVERIFY((first.target - particle_position(*view_->frame(), middle())).norm() < 0.01);
    QCOMPARE(rounded(view_->camera().project(last.target)), to);
    QVERIFY2(std::abs(last.target.z()) < 1e-9, "the plane through the particle, parallel to the screen");
    QVERIFY(ended.isEmpty());
    QTest::mouseRelease(view_.get(), Qt::LeftButton, {}, to);
    QCOMPARE(ended.count(), 1);
  }

  void dragging_beside_the_cloth_orbits_and_pulls_nothing() {
    QSignalSpy pulled(view_.get(), &ClothView::pullChanged);
    drag(*view_, {20, 20}, {60, 30});
    QVERIFY(pulled.isEmpty());
    QVERIFY(view_->camera().pose().yaw < 0);
    QVERIFY(view_->camera().pose().pitch > 0);
  }

  void a_pull_ends_when_the_cloth_is_replaced() {
    QSignalSpy ended(view_.get(), &ClothView::pullEnded);
    drag(*view_, at(middle()), at(middle()) + QPoint(20, 0), Qt::LeftButton, {}, false);
    view_->showFrame(flat_cloth(2, 5));
    QCOMPARE(ended.count(), 1);
  }

  void the_brush_reports_cursor_radius_and_velocity() {
    view_->setTool(Tool::brush);
    view_->setBrushRadius(64);
    QSignalSpy blown(view_.get(), &ClothView::brushChanged), ended(view_.get(), &ClothView::brushEnded);
    drag(*view_, {200, 200}, {250, 170});
    QCOMPARE(blown.count(), 2);  // one per move
    const auto gust = blown.last().at(0).value<cloth::BrushGust>();
    QVERIFY((gust.cursor - Eigen::Vector2d(250, 170)).norm() < 1e-9);
    QCOMPARE(gust.radius, 64.0);
    QVERIFY2((gust.velocity - Eigen::Vector3d(2.5, 1.5, 0)).norm() < 1e-9,
             "50 px right, 30 px up, 0.05 m/s each");
    QCOMPARE(ended.count(), 1);
  }

  void shift_is_the_brush_in_every_tool() {
    QSignalSpy blown(view_.get(), &ClothView::brushChanged), pulled(view_.get(), &ClothView::pullChanged);
    drag(*view_, at(middle()), at(middle()) + QPoint(30, 0), Qt::LeftButton, Qt::ShiftModifier);
    QVERIFY(!blown.isEmpty());
    QVERIFY(pulled.isEmpty());
  }

  void the_wheel_sizes_the_brush_while_it_blows() {
    view_->setTool(Tool::brush);
    drag(*view_, {200, 200}, {230, 200}, Qt::LeftButton, {}, false);
    const double before = view_->brushRadius(), distance_before = view_->camera().pose().distance;
    QWheelEvent turn({230, 200}, view_->mapToGlobal(QPointF(230, 200)), {}, {0, 120}, Qt::LeftButton, {},
                     Qt::NoScrollPhase, false);
    QApplication::sendEvent(view_.get(), &turn);
    QVERIFY(view_->brushRadius() > before);
    QCOMPARE(view_->camera().pose().distance, distance_before);
  }

  void a_particle_at_the_cursor_projects_to_the_cursor() {
    view_->setCameraPose({{0.1, 0.4, 0.05}, 2.2, 0.7, 0.3});
    QSignalSpy blown(view_.get(), &ClothView::brushChanged);
    const int particle = 4 * side + 11;
    const QPoint to = at(particle);
    drag(*view_, to - QPoint(30, 10), to, Qt::LeftButton, Qt::ShiftModifier);
    const auto gust = blown.last().at(0).value<cloth::BrushGust>();
    const Eigen::Vector2d seen = through(gust.world_to_screen, particle_position(*view_->frame(), particle));
    QVERIFY2((seen - gust.cursor).norm() < 1, "within the rounding of a mouse position");
  }

  void pin_mode_click_names_the_particle() {
    view_->setTool(Tool::pin);
    QSignalSpy toggled(view_.get(), &ClothView::pinToggled), pulled(view_.get(), &ClothView::pullChanged);
    const int particle = 5 * side + 3;
    QTest::mouseClick(view_.get(), Qt::LeftButton, {}, at(particle));
    QCOMPARE(toggled.count(), 1);
    QCOMPARE(toggled.first().at(0).toInt(), particle);
    QTest::mouseClick(view_.get(), Qt::LeftButton, {}, {10, 10});
    QCOMPARE(toggled.count(), 1);
    QVERIFY(pulled.isEmpty());
  }

  void a_particle_just_beside_the_cursor_is_still_picked() {
    const Eigen::Vector2d corner = view_->camera().project(particle_position(*view_->frame(), side - 1));
    QCOMPARE(pick_particle(*view_->frame(), view_->camera(), corner + Eigen::Vector2d(6, -6)),
             std::optional(side - 1));
    QVERIFY(!pick_particle(*view_->frame(), view_->camera(), corner + Eigen::Vector2d(30, -30)));
  }

  void the_tool_announces_its_change_once() {
    QSignalSpy changed(view_.get(), &ClothView::toolChanged);
    view_->setTool(Tool::brush);
    view_->setTool(Tool::brush);
    QCOMPARE(changed.count(), 1);
  }

  // ---- camera
  // ------------------------------------------------------------------------------------------------------
};

const Listed listed{"view_hand_test", test_main<ViewHandTest>};

}  // namespace clothlab::test::view_hand_test

#include "view_hand_test.moc"
