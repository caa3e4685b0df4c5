// Contact shown in the view and obstacles moved in it, by real keys and drags.
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include "listed_test.h"
#include "scene/scene_edits.h"
#include "viewport/obstacle_handle.h"
#include "window_bench.h"

namespace clothlab::test::contact_view_test {
namespace {

/// A small cloth hung by two corners; a ball beside it.
QByteArray hung_cloth(bool continuous, const QByteArray& motion = {}) {
  return QByteArray(R"({
  "format": "clothlab/scene/1", "title": "A ball beside a hung cloth",
  "cloth": { "columns": 9, "rows": 9, "width": 0.5, "height": 0.5, "mass": 0.05,
             "origin": [-0.25, 0.8, 0], "across": [1, 0, 0], "down": [0, -1, 0], "pins": ["top-left", "top-right"] },
  "springs": { "structural": 60, "shear": 30, "flexion": 3, "damping": 0.01 },
  "damping": 0.0005, "gravity": [0, -9.81, 0],
  "obstacles": [ { "shape": "sphere", "center": [0.45, 0.4, 0.05], "radius": 0.12)") +
         motion + " } ]," + (continuous ? R"("contact": { "thickness": 0.005 },)" : "") +
         R"("integrator": { "method": "semi-implicit-euler", "time_step": 0.002 }, "duration": 5,
  "record": { "interval": 0.01 } })";
}

void move(QWidget* on, QPointF at, Qt::MouseButtons buttons = Qt::LeftButton) {
  QMouseEvent event(QEvent::MouseMove, at, on->mapToGlobal(at), Qt::NoButton, buttons, Qt::NoModifier);
  QApplication::sendEvent(on, &event);
}

}  // namespace

class Bench : public WindowBench {
 public:
  explicit Bench(bool continuous, const QByteArray& motion = {})
      : WindowBench(write(hung_cloth(continuous, motion))) {
    view().setPreset(CameraPreset::front);
    QTest::qWait(50);
  }

  ClothView& view() { return window.view(); }
  QPointF center() {
    const Eigen::Vector2d p =
        view().camera().project(view().frame()->target(0).at(view().frame()->obstacles[0].center));
    return {p.x(), p.y()};
  }
  cloth::Vec3 document_center() { return window.document().scene().obstacles[0].center; }
  cloth::Vec3 drawn_center() { return view().frame()->pose(0).at(view().frame()->obstacles[0].center); }
  int undo_steps() { return window.document().undoStack().count(); }

  /// By the ring, in ten moves.
  void drag(QPointF by, bool release = true) {
    const QPointF from = center();
    QTest::mouseMove(&view(), from.toPoint());
    move(&view(), from, Qt::NoButton);
    QTest::mousePress(&view(), Qt::LeftButton, {}, from.toPoint());
    for (int part = 1; part <= 10; ++part) {
      move(&view(), from + by * part / 10.0);
      QTest::qWait(15);
    }
    if (release) QTest::mouseRelease(&view(), Qt::LeftButton, {}, (from + by).toPoint());
    settle();
  }

 private:
  QString write(const QByteArray& scene) {
    static QTemporaryDir folder;
    const QString path = folder.filePath("drag.scene.json");
    QFile file(path);
    if (!file.open(QIODevice::WriteOnly) || file.write(scene) != scene.size()) qFatal("no scene was written");
    return path;
  }
};

class ContactViewTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
  }

  void contact_is_drawn_on_request_and_only_then() {
    WindowBench bench("ball");
    bench.play_until(0.6);
    bench.pause();
    ClothView& view = bench.window.view();
    QVERIFY(!view.frame()->contact.has_marks);
    const QImage without = view.grabPicture();
    QTest::keyClick(&bench.window, Qt::Key_C);
    bench.settle();
    QVERIFY(view.contact().marks);
    QVERIFY(!view.frame()->contact.marks.empty());
    const QImage with = view.grabPicture();
    QVERIFY(with != without);
    QTest::keyClick(&bench.window, Qt::Key_C);
    bench.settle();
    QVERIFY(view.frame()->contact.marks.empty());
    QCOMPARE(view.grabPicture(), without);
  }

  void the_level_of_boxes_is_there_only_where_a_scene_has_a_hierarchy() {
    WindowBench bench("ball");
    auto* level = bench.window.findChild<QSpinBox*>("boxLevel");
    QVERIFY(level && !level->isVisible());
    bench.window.openScene("fold");
    bench.settle();
    QVERIFY(level->isVisible());
    QVERIFY(!level->isEnabled());
    bench.action("showContact")->trigger();
    bench.settle();
    QVERIFY(level->isEnabled());
    const auto boxes = [&] { return bench.window.view().frame()->contact.boxes.size() / 6; };
    QCOMPARE(boxes(), 0U);
    std::size_t before = 0;
    for (int depth = 0; depth <= level->maximum(); ++depth) {
      QTest::keyClick(level, Qt::Key_Up);
      bench.settle();
      QCOMPARE(level->value(), depth);
      QVERIFY(boxes() > before);
      before = boxes();
    }
    bench.window.openScene("ball");
    bench.settle();
    QVERIFY(!level->isVisible());
  }

  void a_hovered_obstacle_shows_a_handle() {
    Bench bench(false);
    const QImage before = bench.view().grabPicture();
    QTest::mouseMove(&bench.view(), bench.center().toPoint());
    move(&bench.view(), bench.center(), Qt::NoButton);
    QTest::qWait(50);
    QVERIFY(bench.view().grabPicture() != before);
    QCOMPARE(bench.view().cursor().shape(), Qt::SizeAllCursor);
  }

  void dragging_a_ball_by_its_handle_is_one_undo_step_and_acts_at_once_where_particles_are_tested() {
    Bench bench(false);
    const cloth::Vec3 before = bench.document_center();
    bench.drag({-60, -20});
    const cloth::Vec3 after = bench.document_center();
    QVERIFY(after.x() < before.x() - 0.02);
    QVERIFY(after.y() > before.y());
    QVERIFY2(std::abs(after.z() - before.z()) < 1e-9, "in the plane of the screen");
    QCOMPARE(bench.undo_steps(), 1);
    QVERIFY2((bench.drawn_center() - after).norm() < 1e-9, "paused, too");
    bench.window.document().undoStack().undo();
    bench.settle();
    QVERIFY((bench.drawn_center() - before).norm() < 1e-9);
  }

  void an_arrow_moves_along_its_axis_alone() {
    Bench bench(false);
    const cloth::Vec3 before = bench.document_center();
    const ObstacleHandle handle{0, bench.view().frame()->target(0).at(before)};
    const Eigen::Vector2d tip = bench.view().camera().project(handle.tips(bench.view().camera())[0]);
    const QPointF at(tip.x() - 5, tip.y());
    move(&bench.view(), bench.center(), Qt::NoButton);
    move(&bench.view(), at, Qt::NoButton);
    QTest::mousePress(&bench.view(), Qt::LeftButton, {}, at.toPoint());
    move(&bench.view(), at + QPointF(-40, 25));
    QTest::mouseRelease(&bench.view(), Qt::LeftButton, {}, (at + QPointF(-40, 25)).toPoint());
    bench.settle();
    const cloth::Vec3 by = bench.document_center() - before;
    QVERIFY(by.x() < -0.01);
    QCOMPARE(by.y(), 0.0);
    QCOMPARE(by.z(), 0.0);
  }

  void under_continuous_contact_a_dragged_ball_is_carried_and_the_cloth_gives_way() {
    Bench bench(true);
    bench.play_until(0.1);
    const cloth::Vec3 before = bench.document_center();
    const int middle = 5 * 9 + 4;
    const Eigen::Vector3f particle = bench.position_of(middle);
    const QPointF to_the_cloth(bench.pixel_of(middle) - bench.center());
    bench.drag(to_the_cloth);
    QCOMPARE(bench.undo_steps(), 1);
    const double settled = bench.status().time + 0.3;
    bench.play_until(settled);
    bench.pause();
    QVERIFY2(!bench.status().divergence, "it goes on");
    QVERIFY((bench.drawn_center() - bench.document_center()).norm() < 1e-9);
    QVERIFY((bench.document_center() - before).norm() > 0.1);
    QVERIFY((bench.position_of(middle) - particle).norm() > 0.02);
  }

  void paused_under_continuous_contact_the_ball_waits_and_its_place_to_be_is_shown() {
    Bench bench(true);
    const cloth::Vec3 before = bench.document_center();
    const QImage picture = bench.view().grabPicture();
    bench.drag({-40, 0});
    QVERIFY((bench.drawn_center() - before).norm() < 1e-9);
    const ClothFrame& frame = *bench.view().frame();
    QVERIFY((frame.target(0).at(frame.obstacles[0].center) - bench.document_center()).norm() < 1e-9);
    QVERIFY(bench.view().grabPicture() != picture);
  }

  void dragging_an_obstacle_with_keyframes_shifts_all_of_them_as_one_undo_step() {
    Bench bench(true, R"(, "keyframes": [ { "time": 0, "position": [0.45, 0.4, 0.05] },
                                          { "time": 0.4, "position": [0.3, 0.6, 0.05], "rotation": [0, 1, 0] } ])");
    const auto scene = [&] { return bench.window.document().scene(); };
    const cloth::Scene before = scene();
    const QImage picture = bench.view().grabPicture();
    bench.drag({40, 20});
    QVERIFY(bench.view().grabPicture() != picture);
    QCOMPARE(bench.undo_steps(), 1);
    const cloth::Scene after = scene();
    const auto &old_keys = before.obstacles[0].keyframes, &keys = after.obstacles[0].keyframes;
    const cloth::Vec3 by = keys[0].position - old_keys[0].position;
    QVERIFY(by.x() > 0.02 && by.y() < -0.01);
    QVERIFY((keys[1].position - old_keys[1].position - by).norm() < 1e-12);
    QCOMPARE(keys[1].time, old_keys[1].time);
    QVERIFY(keys[1].rotation == old_keys[1].rotation);
    QVERIFY2(*cloth::edited_scene(before, cloth::edits_between(before, after)).scene == after,
             "in a session");
    bench.play_until(0.2);
    bench.pause();
    const double time = bench.view().frame()->time;
    QVERIFY((bench.drawn_center() - cloth::pose_of(after.obstacles[0], time).at(after.obstacles[0].center))
                .norm() < 1e-9);
    bench.window.document().undoStack().undo();
    QVERIFY(scene() == before);
  }

  void dragging_an_obstacle_with_a_velocity_shifts_where_it_starts() {
    Bench bench(true, R"(, "velocity": [0.1, 0, 0])");
    bench.play_until(0.2);
    bench.pause();
    const cloth::Vec3 start = bench.document_center(), place = bench.drawn_center();
    bench.drag({0, -40});
    QCOMPARE(bench.undo_steps(), 1);
    const cloth::Vec3 by = bench.document_center() - start;
    QVERIFY(by.y() > 0.02);
    const ClothFrame& frame = *bench.view().frame();
    QVERIFY((frame.target(0).at(frame.obstacles[0].center) - place - by).norm() < 1e-9);
  }

  void fields_that_keyframes_overrule_say_so() {
    Bench bench(true, R"(, "keyframes": [ { "time": 0, "position": [0.45, 0.4, 0.05] } ])");
    const auto note = [&] { return qobject_cast<QLabel*>(bench.editor("obstacles.0.center", "note")); };
    QVERIFY(note() && note()->isVisibleTo(&bench.window));
    QVERIFY(note()->text().contains("keyframes"));
    bench.window.openScene("ball");
    bench.settle();
    QVERIFY(!note()->isVisibleTo(&bench.window));
  }

  void a_drag_into_pinned_cloth_stops_pinched_and_one_click_undoes_it() {
    Bench bench(true);
    bench.play_until(0.1);
    const cloth::Vec3 before = bench.document_center();
    bench.drag(QPointF(bench.pixel_of(0)) - bench.center());
    QTRY_VERIFY_WITH_TIMEOUT(bench.status().divergence.has_value(), 20000);
    bench.settle();
    QVERIFY(bench.status().divergence->pinched);
    const QString text = bench.window.notice().text();
    QVERIFY2(text.contains("pinched") && text.contains("t = ") && text.contains("particle"),
             qPrintable(text));
    QVERIFY2(text.contains("sphere 1 (obstacles.0)"), qPrintable(text));  // as the form and the file call it
    auto* button = bench.window.findChild<QPushButton*>("noticeButton");
    QVERIFY2(button->isVisible() && button->text().contains("Move sphere 1"), qPrintable(button->text()));
    const double stopped = bench.status().time;
    QTest::mouseClick(button, Qt::LeftButton);
    bench.settle();
    QVERIFY((bench.document_center() - before).norm() == 0);
    QVERIFY2(!bench.window.notice().shows("divergence"), qPrintable(bench.window.notice().text()));
    bench.play_until(stopped + 0.3);
    bench.pause();
    QVERIFY(!bench.status().divergence);
    QVERIFY2((bench.drawn_center() - before).norm() < 1e-9, "back where it was");
  }

  void a_pinched_drag_can_be_dragged_elsewhere_instead() {
    Bench bench(true);
    bench.play_until(0.1);
    bench.drag(QPointF(bench.pixel_of(0)) - bench.center());
    QTRY_VERIFY_WITH_TIMEOUT(bench.status().divergence.has_value(), 20000);
    bench.settle();
    const double stopped = bench.status().time;
    QVERIFY(bench.window.notice().shows("divergence"));
    bench.drag({140, 60});
    QVERIFY2(!bench.window.notice().shows("divergence"), "what it offers to undo is no longer the last edit");
    bench.play_until(stopped + 0.3);
    bench.pause();
    QVERIFY(!bench.status().divergence);
    QVERIFY((bench.drawn_center() - bench.document_center()).norm() < 1e-9);
  }

  void escape_takes_a_drag_back() {
    for (const bool continuous : {false, true}) {
      Bench bench(continuous);
      const cloth::Vec3 before = bench.document_center();
      bench.drag({-60, 0}, false);
      QVERIFY((bench.document_center() - before).norm() > 0.02);
      QTest::keyClick(&bench.view(), Qt::Key_Escape);
      bench.settle();
      QVERIFY((bench.document_center() - before).norm() == 0);
      QCOMPARE(bench.undo_steps(), 0);
      move(&bench.view(), bench.center() + QPointF(30, 30));
      bench.settle();
      QVERIFY2((bench.document_center() - before).norm() == 0, "the hand holds nothing any more");
      QTest::mouseRelease(&bench.view(), Qt::LeftButton, {}, bench.center().toPoint());
    }
  }
};

const Listed listed{"contact_view_test", test_main<ContactViewTest>};

}  // namespace clothlab::test::contact_view_test

#include "contact_view_test.moc"
