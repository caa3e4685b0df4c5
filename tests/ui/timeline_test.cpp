// Going back and forth on the timeline, and sessions, as a user does it.
#include <QDialogButtonBox>
#include <QDir>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QProcess>
#include <QPushButton>
#include <QTimer>
#include <QToolTip>

#include "io/obj_reader.h"
#include "listed_test.h"
#include "main_window/lab_files.h"
#include "simulation/session_json.h"
#include "window_bench.h"

namespace clothlab::test::timeline_test {
namespace {

void drag_along(TimelineTrack& track, double from, double to) {
  const int y = track.height() - 10;
  const auto place = [&](double time) { return QPoint(qRound(track.placeOf(time)), y); };
  QTest::mousePress(&track, Qt::LeftButton, {}, place(from));
  for (int part = 1; part <= 10; ++part) {
    const QPointF at = place(from + (to - from) * part / 10);
    QMouseEvent move(QEvent::MouseMove, at, track.mapToGlobal(at), Qt::NoButton, Qt::LeftButton, {});
    QApplication::sendEvent(&track, &move);
    QTest::qWait(15);
  }
  QTest::mouseRelease(&track, Qt::LeftButton, {}, place(to));
}

QString later_text(WindowBench& bench) {
  auto* label = bench.window.findChild<QLabel*>("timelineLater");
  return label->isHidden() ? QString() : label->text();
}

/// By the menu's entry and the file dialog, typing the file's name.
void save_cloth(WindowBench& bench, const QString& path) {
  QTimer watch;
  bool typed = false;
  QObject::connect(&watch, &QTimer::timeout, [&] {
    auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
    if (!dialog || std::exchange(typed, true)) return;
    dialog->findChild<QLineEdit*>("fileNameEdit")->setText(path);
    QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save), Qt::LeftButton);
  });
  watch.start(50);
  bench.action("saveCloth")->trigger();
  QVERIFY(typed);
}

}  // namespace

class TimelineTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    apply_theme(*qApp, false);
  }

  void before_anything_was_played_there_is_nowhere_to_go() {
    WindowBench bench;
    QVERIFY(!bench.window.timeline().track().isEnabled());
    QVERIFY(!bench.action("playAgain")->isEnabled());
    bench.play_until(0.05);
    QVERIFY(bench.window.timeline().track().isEnabled());
  }

  void memory_and_states_are_shown() {
    WindowBench bench;
    bench.play_until(0.1);
    bench.pause();
    const QString text = bench.window.findChild<QLabel*>("timelineMemory")->text();
    QVERIFY2(text.contains("MB of 256 MB"), qPrintable(text));
    QVERIFY2(text.contains(QString("%1 states").arg(bench.status().history.states)), qPrintable(text));
  }

  void dragging_back_shows_the_earlier_cloth_and_forth_the_later_one() {
    WindowBench bench;
    bench.play_until(0.3);
    bench.pause();
    const double end = bench.status().time;
    const auto last = bench.window.view().frame()->positions;
    TimelineTrack& track = bench.window.timeline().track();
    drag_along(track, end, 0.1);
    bench.settle();
    const double there = bench.status().time;
    QVERIFY2(std::abs(there - 0.1) < 0.02, qPrintable(QString::number(there)));
    QCOMPARE(bench.window.view().frame()->step, bench.status().step);
    QVERIFY(bench.window.view().frame()->positions != last);
    QCOMPARE(bench.status().history.last_time, end);
    QVERIFY(!later_text(bench).isEmpty());
    drag_along(track, there, end);
    bench.settle();
    QCOMPARE(bench.status().time, end);
    QVERIFY(bench.window.view().frame()->positions == last);
    QVERIFY(later_text(bench).isEmpty());
  }

  void the_cloth_is_saved_as_it_is_shown_also_at_an_earlier_time() {
    const QTemporaryDir files;
    WindowBench bench;
    bench.play_until(0.3);
    bench.pause();
    drag_along(bench.window.timeline().track(), bench.status().time, 0.1);
    bench.settle();
    const auto shown = bench.window.view().frame()->positions;
    save_cloth(bench, files.filePath("earlier"));
    const cloth::ObjReading reading = cloth::read_obj(files.filePath("earlier.obj").toStdString());
    QVERIFY2(reading.mesh, reading.problem.c_str());
    QCOMPARE(3 * reading.mesh->vertices.size(), shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i)
      QCOMPARE(static_cast<float>(reading.mesh->vertices[i / 3][static_cast<int>(i % 3)]), shown[i]);
    QVERIFY(bench.status().history.last_time >= 0.3);  // nothing of the run is lost
    QCOMPARE(bench.window.document().undoStack().count(), 0);
    QVERIFY(!bench.window.document().isModified());
  }

  void a_cloth_that_cannot_be_saved_is_answered_with_place_and_reason() {
    const QTemporaryDir files;
    const QString taken = files.filePath("taken.obj");
    QVERIFY(QDir().mkpath(taken + "/below"));
    WindowBench bench;
    const QString problem = save_cloth_file(*bench.window.view().frame(), "x", taken);
    QVERIFY2(problem.contains("taken.obj") && problem.contains("is a folder"), qPrintable(problem));
  }

  void keys_go_by_record_intervals_and_to_the_ends() {
    WindowBench bench;
    bench.play_until(0.1);
    bench.pause();
    const double end = bench.status().time;
    const double interval = bench.window.document().scene().record.interval;
    TimelineTrack& track = bench.window.timeline().track();
    track.setFocus();
    QTest::keyClick(&track, Qt::Key_Home);
    bench.settle();
    QCOMPARE(bench.status().step, 0);
    QTest::keyClick(&track, Qt::Key_Right);
    QTest::keyClick(&track, Qt::Key_Right);
    bench.settle();
    QVERIFY(std::abs(bench.status().time - 2 * interval) <= bench.status().time_step);
    QTest::keyClick(&track, Qt::Key_Left);
    bench.settle();
    QVERIFY(std::abs(bench.status().time - interval) <= bench.status().time_step);
    QTest::keyClick(&track, Qt::Key_End);
    bench.settle();
    QCOMPARE(bench.status().time, end);
  }

  void nothing_moves_under_the_mouse_that_drags_to_the_left() {
    WindowBench bench;
    bench.play_until(0.3);
    bench.pause();
    TimelineTrack& track = bench.window.timeline().track();
    const QRect place = track.geometry();
    const int y = track.height() - 10, from = qRound(track.placeOf(bench.status().time));
    int x = from;
    QTest::mousePress(&track, Qt::LeftButton, {}, {x, y});
    for (; x > from / 3; x -= 20) {
      QMouseEvent move(QEvent::MouseMove, QPointF(x, y), track.mapToGlobal(QPointF(x, y)), Qt::NoButton,
                       Qt::LeftButton, {});
      QApplication::sendEvent(&track, &move);
      bench.settle();
      QTest::qWait(1);
      QCOMPARE(track.geometry(), place);
      const double shown = track.placeOf(bench.status().time);
      QVERIFY2(std::abs(shown - x) < 3, qPrintable(QString("at %1 instead of %2 px").arg(shown).arg(x)));
    }
    QTest::mouseRelease(&track, Qt::LeftButton, {}, {x, y});
    QVERIFY(!later_text(bench).isEmpty());
    QCOMPARE(track.geometry(), place);
  }

  void keys_move_wherever_the_focus_is_but_in_what_uses_them_itself() {
    WindowBench bench("corners-free");
    bench.play_until(0.1);
    bench.pause();
    const double end = bench.status().time;
    const auto press = [&](QWidget* on, Qt::Key key) {
      on->setFocus();
      QTest::keyClick(on, key);
      bench.settle();
      return bench.status().time;
    };
    QCOMPARE(press(&bench.window.view(), Qt::Key_Home), 0.0);
    QVERIFY(press(&bench.window.view(), Qt::Key_Right) > 0);
    QCOMPARE(press(bench.window.findChild<QToolButton*>("playButton"), Qt::Key_End), end);
    QVERIFY(press(bench.window.findChild<QToolButton*>("playButton"), Qt::Key_Left) < end);

    const double there = bench.status().time;
    QWidget* slider = bench.editor("springs.structural", "slider");
    QWidget* field = bench.editor("springs.structural", "field");
    QVERIFY(slider && field);
    for (QWidget* own : {field, static_cast<QWidget*>(&bench.window.charts())})
      for (const Qt::Key key : {Qt::Key_Left, Qt::Key_Home, Qt::Key_End}) QCOMPARE(press(own, key), there);
    const double before = bench.window.document().scene().springs->structural;
    QCOMPARE(press(slider, Qt::Key_Right), there);
    QVERIFY(bench.window.document().scene().springs->structural > before);
  }

  void marks_say_what_was_done_until_that_time_is_cut_off() {
    WindowBench bench("corners-free");
    TimelineTrack& track = bench.window.timeline().track();
    const auto marks = [&](double time) { return track.marksAt(track.placeOf(time)); };
    bench.play_until(0.1);
    QCOMPARE(marks(0.05), QString());
    const auto middle = [&] { return bench.pixel_of(16 * 33 + 16); };
    QWidget* view = bench.window.view().childAt(middle());
    if (!view) view = &bench.window.view();
    const QPoint grip = middle();
    QTest::mousePress(view, Qt::LeftButton, {}, grip);
    for (int part = 1; part <= 5; ++part) {
      const QPointF at = grip + QPointF(4 * part, 0);
      QMouseEvent move(QEvent::MouseMove, at, view->mapToGlobal(at), Qt::NoButton, Qt::LeftButton, {});
      QApplication::sendEvent(view, &move);
      QTest::qWait(20);
    }
    const double held = bench.status().time;
    QTest::mouseRelease(view, Qt::LeftButton, {}, grip + QPoint(20, 0));
    bench.play_until(held + 0.2);
    bench.pause();
    const double edited = bench.status().time;
    const double stiffness = bench.window.document().scene().springs->structural;
    QCOMPARE(bench.window.document().setParameter("springs.structural", 1.2 * stiffness), QString());
    bench.play_until(edited + 0.3);
    bench.pause();
    bench.click("toolPinButton");
    QTest::mouseClick(view, Qt::LeftButton, {}, middle());
    bench.settle();
    const double pinned = bench.status().time;
    QVERIFY2(marks(held).startsWith("Pulled from"), qPrintable(marks(held)));
    QVERIFY2(marks(edited).startsWith("Edited (Structural"), qPrintable(marks(edited)));
    QVERIFY2(marks(pinned).startsWith("Pinned"), qPrintable(marks(pinned)));

    const QPoint place(qRound(track.placeOf(edited)), track.height() - 5);
    QHelpEvent help(QEvent::ToolTip, place, track.mapToGlobal(place));
    QApplication::sendEvent(&track, &help);
    QCOMPARE(QToolTip::text(), marks(edited));

    drag_along(track, pinned, edited - 0.1);
    bench.settle();
    QVERIFY(!marks(edited).isEmpty());  // going back cuts nothing off
    QVERIFY(!marks(pinned).isEmpty());
    bench.click("stepButton");
    bench.settle();
    QVERIFY2(marks(held).startsWith("Pulled from"), qPrintable(marks(held)));
    QVERIFY2(!marks(bench.status().history.last_time).contains("Edited"),
             qPrintable(marks(bench.status().history.last_time)));
    bench.play_until(pinned + 0.1);
    bench.pause();
    QCOMPARE(marks(edited), QString());
    QCOMPARE(marks(pinned), QString());
  }

  void playing_on_from_an_earlier_point_drops_the_later_part() {
    WindowBench bench;
    bench.play_until(0.4);
    bench.pause();
    const double end = bench.status().history.last_time;
    QTest::keyClick(&bench.window.timeline().track(), Qt::Key_Home);
    bench.settle();
    bench.click("stepButton");
    bench.settle();
    QVERIFY(bench.status().history.last_time < end / 2);
    QVERIFY(!bench.action("playAgain")->isEnabled());
    bench.play_until(0.02);
    QCOMPARE(bench.status().history.last_time, bench.status().time);
  }

  void playing_again_keeps_the_later_part_and_stops_at_its_end() {
    WindowBench bench;
    bench.play_until(0.2);
    bench.pause();
    const double end = bench.status().time;
    QTest::keyClick(&bench.window.timeline().track(), Qt::Key_Home);
    bench.settle();
    bench.action("playAgain")->trigger();
    QTRY_COMPARE_WITH_TIMEOUT(bench.status().time, end, 30000);
    bench.settle();
    QVERIFY(!bench.status().playing);
    QCOMPARE(bench.status().history.last_time, end);
  }

  void the_form_shows_what_was_in_force_and_going_there_and_back_is_no_undo_step() {
    WindowBench bench("corners-free");
    bench.play_until(0.1);
    bench.pause();
    LabDocument& document = bench.window.document();
    const double before = document.scene().springs->structural;
    QCOMPARE(document.setParameter("springs.structural", 2 * before), QString());
    bench.play_until(0.2);
    bench.pause();
    QCOMPARE(document.undoStack().count(), 1);
    TimelineTrack& track = bench.window.timeline().track();
    QTest::keyClick(&track, Qt::Key_Home);
    bench.settle();
    QCOMPARE(document.scene().springs->structural, before);
    QCOMPARE(document.undoStack().count(), 2);
    QTest::keyClick(&track, Qt::Key_End);
    bench.settle();
    QCOMPARE(document.scene().springs->structural, 2 * before);
    QCOMPARE(document.undoStack().count(), 1);
    QVERIFY(bench.status().history.last_time > 0.2);  // looking has dropped nothing
  }

  void a_session_with_an_edit_in_the_past_comes_out_to_the_bit_here_and_on_the_command_line() {
    const QString file = folder.filePath("edited.session.json");
    std::vector<float> ended;
    {
      WindowBench bench("corners-free");
      bench.play_until(0.3);
      bench.pause();
      drag_along(bench.window.timeline().track(), bench.status().time, 0.1);
      bench.settle();
      const double stiffness = bench.window.document().scene().springs->structural;
      QCOMPARE(bench.window.document().setParameter("springs.structural", 1.5 * stiffness), QString());
      bench.settle();
      QVERIFY(bench.status().history.last_time < 0.15);
      bench.play_until(0.2);
      bench.pause();
      ended = bench.window.view().frame()->positions;
      bench.window.saveSession(file);
      bench.settle();
      QVERIFY2(bench.window.notice().text().contains("Saved"), qPrintable(bench.window.notice().text()));
    }
    WindowBench bench;
    bench.window.openScene(file);
    QTRY_COMPARE_WITH_TIMEOUT(bench.status().session_agrees, std::optional<bool>(true), 30000);
    bench.settle();
    QVERIFY(bench.window.view().frame()->positions == ended);
    QVERIFY(bench.window.notice().text().contains("to the bit"));
    QVERIFY(!bench.window.document().isModified());
    QCOMPARE(bench.window.document().scene(), bench.status().comparison->scene);

    QProcess replay;
    replay.start(CLOTHLAB_CLI, {"replay", file, "--json"});
    QVERIFY(replay.waitForFinished(60000));
    QCOMPARE(replay.exitCode(), 0);  // 5: another end
    QVERIFY(replay.readAllStandardOutput().replace(' ', "").contains("\"agrees\":true"));
  }

  void a_session_with_a_problem_says_it_and_keeps_the_scene() {
    WindowBench bench;
    const QString name = folder.filePath("bad.session.json");
    QFile file(name);
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("{\"scene\": {}, \"steps\": -3}");
    file.close();
    bench.window.openScene(name);
    QCOMPARE(bench.window.notice().cause(), QString("open"));
    QVERIFY2(bench.window.notice().text().contains("steps"), qPrintable(bench.window.notice().text()));
    QCOMPARE(bench.window.document().scene().cloth.rows, 33);
  }

 private:
  QTemporaryDir folder;
};

const Listed listed{"timeline_test", test_main<TimelineTest>};

}  // namespace clothlab::test::timeline_test

#include "timeline_test.moc"
