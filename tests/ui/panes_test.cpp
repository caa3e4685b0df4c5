// A scene becomes a comparison and a comparison a scene, in one window, by real clicks, keys and drags: the
// run goes on, and timeline, contact, handles and studies work in panes as they do in one.
#include <QComboBox>
#include <QMouseEvent>
#include <QTabBar>

#include "compare_bench.h"
#include "listed_test.h"
#include "scene/builtin_scenes.h"
#include "simulation/session_json.h"
#include "studies/studies_panel.h"
#include "studies/study_choices.h"
#include "window_bench.h"

namespace clothlab::test::panes_test {
namespace {

void move_to(QWidget& on, QPointF at, Qt::MouseButtons buttons) {
  QMouseEvent event(QEvent::MouseMove, at, on.mapToGlobal(at), Qt::NoButton, buttons, Qt::NoModifier);
  QApplication::sendEvent(&on, &event);
}

void click_at(TimelineTrack& track, double time) {
  QTest::mouseClick(&track, Qt::LeftButton, {}, QPoint(qRound(track.placeOf(time)), track.height() - 10));
}

const std::vector<float>& positions(LabWindow& window, std::size_t pane) {
  return window.panes().pane(pane).view().frame()->positions;
}

/// Of the study that the form would start.
cloth::Scene ordered_scene(LabWindow& window) {
  const auto order = window.studies().choices().order();
  if (const auto* problem = std::get_if<QString>(&order)) qFatal("%s", qPrintable(*problem));
  return std::get<StudyOrder>(order).scene;
}

void choose_method(LabWindow& window, std::size_t pane, const QString& title) {
  auto* method = window.panes().pane(pane).findChild<QComboBox*>("method");
  method->setFocus();
  QTest::keyClicks(method, title);
  QCOMPARE(method->currentText(), title);
}

}  // namespace

class PanesTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
  }

  void a_running_scene_is_duplicated_at_its_present_state() {
    WindowBench bench("corners-free");
    bench.play_until(0.1);
    bench.pause();
    const double time = bench.status().time;
    const std::vector<float> before = positions(bench.window, 0);
    QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);
    bench.settle();
    QVERIFY(bench.status().is_comparison());
    QCOMPARE(bench.status().time, time);
    QCOMPARE(bench.status().history.last_time, time);
    QCOMPARE(bench.window.panes().paneCount(), std::size_t{2});
    for (const std::size_t pane : {0U, 1U}) QCOMPARE(positions(bench.window, pane), before);
    QCOMPARE(*bench.status().panes[1].rms, 0.0);

    choose_method(bench.window, 1, "Runge-Kutta 4");
    bench.play_until(time + 0.05);
    bench.pause();
    QVERIFY(*bench.status().panes[1].rms > 0);
    QVERIFY2(bench.window.notice().text().isEmpty(), qPrintable(bench.window.notice().text()));
  }

  void a_playing_scene_plays_on_in_its_panes() {
    WindowBench bench("corners-free");
    bench.play_until(0.05);
    const double time = bench.status().time;
    QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(bench.status().is_comparison() && bench.status().time > time + 0.05, 20000);
    QVERIFY(bench.status().playing);
    bench.pause();
  }

  void the_pane_that_stays_goes_on_as_a_scene_with_its_history_and_session() {
    QTemporaryDir folder;
    WindowBench bench("corners-free");
    bench.play_until(0.1);
    bench.pause();
    QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);
    bench.play_until(0.2);
    bench.pause();
    const double time = bench.status().time;
    const std::vector<float> before = positions(bench.window, 0);
    bench.window.panes().pane(1).findChild<QAction*>("removePane")->trigger();
    bench.settle();
    QVERIFY(!bench.status().is_comparison());
    QCOMPARE(bench.window.panes().paneCount(), std::size_t{1});
    QCOMPARE(bench.status().time, time);
    QCOMPARE(positions(bench.window, 0), before);
    click_at(bench.window.timeline().track(), 0.05);
    bench.settle();
    QVERIFY(bench.status().time < 0.06);
    QTest::keyClick(&bench.window.timeline().track(), Qt::Key_End);
    bench.settle();
    QCOMPARE(positions(bench.window, 0), before);

    const QString file = folder.filePath("both.session.json");
    bench.window.saveSession(file);
    bench.settle();
    WindowBench again;
    again.window.openScene(file);
    QTRY_VERIFY_WITH_TIMEOUT(again.window.notice().text().contains("to the bit"), 20000);
    QCOMPARE(positions(again.window, 0), before);
  }

  void undo_takes_the_copy_away_and_redo_brings_it_back() {
    WindowBench bench("corners-free");
    bench.play_until(0.05);
    bench.pause();
    const double time = bench.status().time;
    for (int round = 0; round < 3; ++round) {
      QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);
      bench.settle();
      QVERIFY(bench.status().is_comparison());
      bench.action("undo")->trigger();
      bench.settle();
      QVERIFY(!bench.status().is_comparison());
      QCOMPARE(bench.status().time, time);
    }
    QCOMPARE(bench.window.document().scene(), cloth::builtin_scene("corners-free"));
    QVERIFY(!bench.window.document().isModified());
  }

  void a_saved_scene_that_became_a_comparison_is_saved_as_one() {
    QTemporaryDir folder;
    const QString path = folder.filePath("x.scene.json");
    WindowBench bench("corners-free");
    QVERIFY(bench.window.saveTo(path));
    QTest::keyClick(&bench.window, Qt::Key_D, Qt::ControlModifier);
    QVERIFY(bench.window.document().path().isEmpty());
    QVERIFY(bench.window.windowTitle().contains("Comparison"));
    bench.action("undo")->trigger();
    QCOMPARE(bench.window.document().path(), path);
    QVERIFY(!bench.window.document().isModified());
  }

  void the_timeline_takes_all_panes_back_and_forth_to_the_bit() {
    CompareBench bench;
    bench.play_to_the_end();
    const std::vector<float> ends[] = {positions(bench.window, 0), positions(bench.window, 1)};
    const double rms = *bench.status().panes[1].rms;
    TimelineTrack& track = bench.window.timeline().track();
    QVERIFY(track.isVisible() && track.isEnabled());
    click_at(track, 0.1);
    bench.settle();
    QVERIFY(std::abs(bench.status().time - 0.1) < 0.011);
    QVERIFY(*bench.status().panes[1].rms != rms);
    cloth::LockStep expected(small_comparison());
    for (std::int64_t k = 1; k <= bench.status().step; ++k) QVERIFY(expected.advance(k));
    for (const std::size_t pane : {0U, 1U})
      QCOMPARE(positions(bench.window, pane)[1],
               static_cast<float>(expected.lane(pane).state.position.y()[0]));
    QCOMPARE(*bench.status().panes[1].rms, expected.difference(1)->rms);

    bench.action("playAgain")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(!bench.status().playing && bench.status().time > 0.29, 20000);
    for (const std::size_t pane : {0U, 1U}) QVERIFY(positions(bench.window, pane) == ends[pane]);
    QCOMPARE(*bench.status().panes[1].rms, rms);
  }

  void an_edit_made_in_the_past_begins_a_new_branch_and_the_document_follows_the_timeline() {
    CompareBench bench;
    bench.play_to_the_end();
    TimelineTrack& track = bench.window.timeline().track();
    click_at(track, 0.1);
    bench.settle();
    const double shared = bench.comparison().scene.springs->structural;
    QCOMPARE(bench.window.document().setParameter("springs.structural", shared + 50), QString());
    bench.settle();
    const double branch = bench.status().time;
    QCOMPARE(bench.status().history.last_time, branch);
    QVERIFY(bench.window.paneCharts().record().samples.last_time() <= branch);
    bench.action("step")->trigger();
    bench.settle();
    QTest::keyClick(&track, Qt::Key_Home);
    bench.settle();
    QCOMPARE(bench.status().time, 0.0);
    QCOMPARE(bench.comparison().scene.springs->structural, shared);
    QTest::keyClick(&track, Qt::Key_End);
    bench.settle();
    QCOMPARE(bench.comparison().scene.springs->structural, shared + 50);
  }

  void contact_is_shown_in_all_panes() {
    cloth::Comparison comparison;
    comparison.scene = cloth::builtin_scene("ball");
    comparison.scene.duration = 0.6;
    comparison.panes = cloth::panes_for({"semi-implicit-euler", "verlet"});
    comparison.reference = "A";
    CompareBench bench(comparison);
    bench.play_to_the_end();
    QTest::keyClick(&bench.window, Qt::Key_C);
    bench.settle();
    for (const std::size_t pane : {0U, 1U})
      QVERIFY(!bench.window.panes().pane(pane).view().frame()->contact.marks.empty());
    QTest::keyClick(&bench.window, Qt::Key_C);
    bench.settle();
    for (const std::size_t pane : {0U, 1U})
      QVERIFY(bench.window.panes().pane(pane).view().frame()->contact.marks.empty());
  }

  void an_obstacle_dragged_in_one_pane_moves_in_all_as_one_undo_step() {
    cloth::Comparison comparison;
    comparison.scene = cloth::builtin_scene("ball");
    comparison.panes = cloth::panes_for({"semi-implicit-euler", "verlet"});
    comparison.reference = "A";
    CompareBench bench(comparison);
    ClothView& view = bench.window.panes().pane(1).view();
    if (!view.hasOpenGl()) QSKIP("no OpenGL here");
    view.setAnimated(false);
    view.setPreset(CameraPreset::right);
    QTest::qWait(100);
    const cloth::Vec3 center = bench.comparison().scene.obstacles[0].center;
    const Eigen::Vector2d at = view.camera().project(view.frame()->target(0).at(center));
    const QPointF from(at.x(), at.y());
    move_to(view, from, Qt::NoButton);
    QTest::mousePress(&view, Qt::LeftButton, {}, from.toPoint());
    for (int part = 1; part <= 8; ++part) {
      move_to(view, from + QPointF(5, -3) * part, Qt::LeftButton);
      QTest::qWait(15);
    }
    QTest::mouseRelease(&view, Qt::LeftButton, {}, (from + QPointF(40, -24)).toPoint());
    bench.settle();
    QVERIFY((bench.comparison().scene.obstacles[0].center - center).norm() > 0.01);
    QCOMPARE(bench.window.document().undoStack().count(), 1);
    for (const std::size_t pane : {0U, 1U})
      QCOMPARE(bench.window.panes().pane(pane).view().frame()->obstacles[0].center,
               bench.comparison().scene.obstacles[0].center);
  }

  void studies_run_on_the_pane_whose_values_the_form_shows() {
    CompareBench bench;
    QTest::keyClick(&bench.window, Qt::Key_T, Qt::ControlModifier);
    QVERIFY(bench.window.studies().isVisible());
    bench.window.studies().choices().choose(StudyChoices::Kind::work_precision);
    bench.scope(2);
    bench.window.document().setParameter("springs.structural", 77.0);
    QCOMPARE(bench.window.document().scene().springs->structural, 77.0);
    QCOMPARE(scene_of(bench.comparison(), 0).springs->structural,
             small_comparison().scene.springs->structural);
    QCOMPARE(ordered_scene(bench.window).springs->structural, 77.0);
    bench.scope(1);
    QCOMPARE(ordered_scene(bench.window).springs->structural, small_comparison().scene.springs->structural);
  }
};

const Listed listed{"panes_test", test_main<PanesTest>};

}  // namespace clothlab::test::panes_test

#include "panes_test.moc"
