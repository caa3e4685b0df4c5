// What a user does in the window, by real clicks, keys and drags.
#include <QCloseEvent>
#include <QComboBox>
#include <QDir>
#include <QDropEvent>
#include <QFile>
#include <QLabel>
#include <QMimeData>
#include <QProcess>
#include <QPushButton>

#include "io/csv.h"
#include "listed_test.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_json.h"
#include "simulation/recorder.h"
#include "window_bench.h"

namespace clothlab::test::window_test {
namespace {

QByteArray content_of(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

std::vector<std::vector<std::string>> timeless_rows(const QString& path) {
  cloth::CsvTable table = cloth::parse_csv(content_of(path).toStdString());
  for (auto& row : table.rows) row.pop_back();  // step_time_us
  return table.rows;
}

void drag(QWidget* on, QPoint from, QPoint to, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QTest::mouseMove(on, from);
  QTest::mousePress(on, Qt::LeftButton, modifiers, from);
  for (int part = 1; part <= 10; ++part) {
    const QPointF at = QPointF(from) + (QPointF(to) - QPointF(from)) * part / 10.0;
    QMouseEvent move(QEvent::MouseMove, at, on->mapToGlobal(at), Qt::NoButton, Qt::LeftButton, modifiers);
    QApplication::sendEvent(on, &move);
    QTest::qWait(15);
  }
}

void release(QWidget* on, QPoint at, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
  QTest::mouseRelease(on, Qt::LeftButton, modifiers, at);
}

}  // namespace

class WindowTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
  }

  void the_default_scene_opens_paused_at_its_start() {
    WindowBench bench;
    QVERIFY(!bench.status().playing);
    QCOMPARE(bench.status().step, 0);
    QCOMPARE(bench.window.view().frame()->rows, 33);
    QVERIFY(bench.window.windowTitle().contains("Hung by two corners"));
  }

  void play_runs_and_pause_stops() {
    WindowBench bench;
    bench.click("playButton");
    bench.play_until(0.1);
    bench.click("playButton");
    bench.settle();
    const auto step = bench.status().step;
    QTest::qWait(100);
    bench.settle();
    QCOMPARE(bench.status().step, step);
  }

  void the_space_key_plays_and_pauses() {
    WindowBench bench;
    QTest::keyClick(&bench.window, Qt::Key_Space);
    bench.settle();
    QVERIFY(bench.status().playing);
    QTest::keyClick(&bench.window, Qt::Key_Space);
    bench.settle();
    QVERIFY(!bench.status().playing);
  }

  void step_makes_one_step_and_reset_goes_back() {
    WindowBench bench;
    bench.click("stepButton");
    bench.click("stepButton");
    bench.settle();
    QCOMPARE(bench.status().step, 2);
    bench.click("resetButton");
    bench.settle();
    QCOMPARE(bench.status().step, 0);
  }

  void a_slower_speed_slows_simulated_time() {
    WindowBench bench;
    auto* speed = bench.window.findChild<QComboBox*>("speed");
    QTest::keyClick(speed, Qt::Key_Home);  // 0.01x
    QTest::keyClick(speed, Qt::Key_Down);
    bench.settle();
    QCOMPARE(bench.status().speed, 0.1);
    QElapsedTimer clock;
    clock.start();
    bench.play_until(0.02);
    QVERIFY(bench.status().time <= 0.1 * static_cast<double>(clock.elapsed() + 1) / 1000);
  }

  void a_scene_that_is_over_in_a_blink_opens_slowed_down_and_the_next_one_as_before() {
    WindowBench bench;
    auto* speed = bench.window.findChild<QComboBox*>("speed");
    QTest::keyClick(speed, Qt::Key_Down);
    bench.settle();
    QCOMPARE(bench.status().speed, 2.0);
    for (const char* name : {"fast-ball", "fast-ball"}) {
      bench.window.openScene(name);
      bench.settle();
      QCOMPARE(bench.status().speed, 0.01);
    }
    bench.window.openScene("ball");
    bench.settle();
    QCOMPARE(bench.status().speed, 2.0);
  }

  void dragging_a_slider_acts_on_the_running_simulation_and_is_one_undo_step() {
    WindowBench bench("corners-free");
    bench.play_until(0.05);
    auto* slider = bench.editor("springs.structural", "slider");
    QVERIFY(slider);
    const auto step = bench.status().step;
    const double before = bench.window.document().scene().springs->structural;
    const int y = slider->height() / 2;
    drag(slider, {slider->width() * 2 / 5, y}, {slider->width() * 3 / 5, y});
    release(slider, {slider->width() * 3 / 5, y});
    const double after = bench.window.document().scene().springs->structural;
    QVERIFY(after > before);
    QCOMPARE(bench.window.document().undoStack().count(), 1);
    bench.settle();
    QVERIFY(bench.status().step >= step);  // no restart
    QVERIFY(bench.status().playing);

    bench.action("undo")->trigger();
    QCOMPARE(bench.window.document().scene().springs->structural, before);
    bench.action("redo")->trigger();
    QCOMPARE(bench.window.document().scene().springs->structural, after);
  }

  void changing_the_number_of_rows_starts_anew() {
    WindowBench bench;
    bench.play_until(0.02);
    QCOMPARE(bench.window.document().setParameter("cloth.rows", std::int64_t{17}), QString());
    bench.settle();
    QTRY_COMPARE_WITH_TIMEOUT(bench.window.view().frame()->rows, 17, 10000);
  }

  void pulling_a_particle_moves_it_towards_the_cursor() {
    WindowBench bench("corners-free");
    const int particle = 20 * 33 + 16;
    bench.play_until(0.02);
    bench.pause();
    QWidget* view = bench.window.view().childAt(bench.pixel_of(particle));
    if (!view) view = &bench.window.view();
    const QPoint from = view->mapFrom(&bench.window.view(), bench.pixel_of(particle));
    const auto start = bench.position_of(particle);
    drag(view, from, from + QPoint(120, 0));
    bench.action("play")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT((bench.position_of(particle) - start).norm() > 0.05, 30000);
    release(view, from + QPoint(120, 0));
    bench.pause();
  }

  void the_wind_brush_blows_where_it_is() {
    WindowBench bench("wind");
    bench.window.document().setParameter("air.wind", cloth::Vec3(0, 0, 0));
    bench.click("toolBrushButton");
    const int particle = 16 * 33 + 16;
    QWidget* view = bench.window.view().childAt(bench.pixel_of(particle));
    if (!view) view = &bench.window.view();
    const QPoint at = view->mapFrom(&bench.window.view(), bench.pixel_of(particle));
    bench.window.startRecording(folder.filePath("brush"));
    drag(view, at - QPoint(100, 0), at);
    bench.play_until(0.15);
    release(view, at);
    bench.action("record")->trigger();
    bench.pause();
    QVERIFY(content_of(folder.filePath("brush/edits.jsonl")).contains("\"brush\""));
    const bool column = content_of(folder.filePath("brush/record.csv")).contains("brush_work_J") ||
                        content_of(folder.filePath("brush/record-2.csv")).contains("brush_work_J");
    QVERIFY(column);
  }

  void the_brush_in_a_scene_without_air_says_what_it_needs_and_offers_it() {
    WindowBench bench("corners-free");
    bench.click("toolBrushButton");
    const QPoint middle = bench.window.view().rect().center();
    QWidget* view = bench.window.view().childAt(middle);
    if (!view) view = &bench.window.view();
    const QPoint at = view->mapFrom(&bench.window.view(), middle);
    drag(view, at, at + QPoint(60, 0));
    release(view, at + QPoint(60, 0));
    QCOMPARE(bench.window.notice().cause(), QString("brush"));
    QTest::mouseClick(bench.window.findChild<QPushButton*>("noticeButton"), Qt::LeftButton);
    QVERIFY(bench.window.document().scene().air.has_value());
    QCOMPARE(bench.window.document().undoStack().count(), 1);
  }

  void a_click_in_pin_mode_pins_and_a_second_one_frees() {
    WindowBench bench("corners-free");
    bench.click("toolPinButton");
    const int particle = 16 * 33 + 16;
    QWidget* view = bench.window.view().childAt(bench.pixel_of(particle));
    if (!view) view = &bench.window.view();
    const QPoint at = view->mapFrom(&bench.window.view(), bench.pixel_of(particle));
    QTest::mouseMove(view, at);
    QTest::mouseClick(view, Qt::LeftButton, Qt::NoModifier, at);
    bench.settle();
    QCOMPARE(int(bench.window.view().frame()->pinned[particle]), 1);
    QTest::mouseClick(view, Qt::LeftButton, Qt::NoModifier, at);
    bench.settle();
    QCOMPARE(int(bench.window.view().frame()->pinned[particle]), 0);
  }

  void a_recording_has_the_rows_of_the_command_line() {
    const cloth::Scene scene = [] {
      cloth::Scene s = cloth::builtin_scene("wind");
      s.duration = 0.3;
      return s;
    }();
    const QString file = folder.filePath("short.scene.json");
    QFile out(file);
    QVERIFY(out.open(QIODevice::WriteOnly));
    out.write(QByteArray::fromStdString(cloth::write_scene(scene)));
    out.close();
    const cloth::RunResult run =
        cloth::run_scene(scene, {.folder = folder.filePath("cli").toStdString(), .progress = {}});
    QVERIFY(!run.io_error);

    WindowBench bench(file);
    bench.window.startRecording(folder.filePath("window"));
    bench.play_until(scene.duration);
    bench.click("recordButton");
    bench.pause();
    auto recorded = timeless_rows(folder.filePath("window/record.csv"));
    const auto expected = timeless_rows(folder.filePath("cli/record.csv"));
    QVERIFY(recorded.size() >= expected.size());
    recorded.resize(expected.size());
    QVERIFY(recorded == expected);
    QCOMPARE(bench.window.notice().cause(), QString("recording"));
  }

  void a_run_whose_energy_is_not_accounted_for_says_so_until_it_is_restarted() {
    cloth::Scene scene = cloth::builtin_scene("pendulum");
    scene.integrator.method = "implicit-euler";  // it damps what its long steps cannot follow
    scene.integrator.time_step = scene.record.interval = 0.05;
    const QString file = folder.filePath("losing.scene.json");
    QFile out(file);
    QVERIFY(out.open(QIODevice::WriteOnly));
    out.write(QByteArray::fromStdString(cloth::write_scene(scene)));
    out.close();
    WindowBench bench(file);
    QVERIFY(bench.window.notice().text().isEmpty());
    bench.play_until(1);
    bench.pause();
    QVERIFY2(bench.window.notice().text().contains("Energy is not accounted for"),
             qPrintable(bench.window.notice().text()));
    bench.action("reset")->trigger();
    bench.settle();
    QVERIFY2(bench.window.notice().text().isEmpty(), qPrintable(bench.window.notice().text()));
  }

  void changing_the_scene_replaces_cloth_and_forms() {
    WindowBench bench;
    bench.play_until(0.02);
    bench.window.openScene("pendulum");
    bench.settle();
    QCOMPARE(bench.window.view().frame()->rows, 2);
    QCOMPARE(bench.status().step, 0);
    QVERIFY(!bench.editor("deformation.rate", "field"));
    QVERIFY(bench.editor("damping", "field"));
  }

  void a_file_with_problems_says_them_all_and_keeps_the_scene() {
    WindowBench bench;
    const QString file = folder.filePath("bad.scene.json");
    QFile out(file);
    QVERIFY(out.open(QIODevice::WriteOnly));
    out.write("{\"cloth\": {\"rows\": 1, \"mass\": -1}}");
    out.close();
    bench.window.openScene(file);
    QCOMPARE(bench.window.notice().cause(), QString("open"));
    QVERIFY(bench.window.notice().text().contains("cloth.rows = 1"));
    QVERIFY(bench.window.notice().text().contains("cloth.mass = -1"));
    QCOMPARE(bench.window.document().scene().cloth.rows, 33);
  }

  void a_scene_dropped_on_the_window_opens() {
    WindowBench bench;
    const QString file = folder.filePath("dropped.scene.json");
    QFile out(file);
    QVERIFY(out.open(QIODevice::WriteOnly));
    out.write(QByteArray::fromStdString(cloth::write_scene(cloth::builtin_scene("free-fall"))));
    out.close();
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(file)});
    QDragEnterEvent enter(QPoint(300, 300), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&bench.window, &enter);
    QVERIFY(enter.isAccepted());
    QDropEvent drop(QPointF(300, 300), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&bench.window, &drop);
    bench.settle();
    QCOMPARE(bench.window.view().frame()->rows, 17);
  }

  void a_step_over_the_limit_warns_and_a_divergence_is_explained() {
    WindowBench bench("corners-free");
    bench.window.document().setParameter("integrator.time_step", 0.005);
    QCOMPARE(bench.window.notice().cause(), QString("stability"));
    bench.action("play")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(bench.window.notice().cause() == "divergence", 30000);
    QVERIFY(bench.window.notice().text().contains("row"));
    QTest::mouseClick(bench.window.findChild<QPushButton*>("noticeButton"), Qt::LeftButton);
    bench.settle();
    QVERIFY(!bench.window.document().scene().integrator.time_step);
    QCOMPARE(bench.status().step, 0);
  }

  void a_method_without_a_stable_step_cannot_be_played_and_says_why() {
    WindowBench bench("wind");
    bench.window.document().setParameter("integrator.method", std::string("explicit-euler"));
    bench.settle();
    QVERIFY(!bench.action("play")->isEnabled());
    QCOMPARE(bench.window.notice().cause(), QString("refusal"));
    bench.window.document().undoStack().undo();
    bench.settle();
    QVERIFY(bench.action("play")->isEnabled());
    QCOMPARE(bench.window.notice().cause(), QString());
  }

  void closing_while_it_runs_and_records_leaves_whole_files() {
    {
      WindowBench bench("ball");
      bench.window.startRecording(folder.filePath("closed"));
      bench.play_until(0.1);
      QVERIFY(bench.window.close());
    }
    const auto table = cloth::parse_csv(content_of(folder.filePath("closed/record.csv")).toStdString());
    QVERIFY(table.rows.size() > 5);
    for (const auto& row : table.rows) QCOMPARE(row.size(), table.header.size());
    QVERIFY(content_of(folder.filePath("closed/summary.json")).contains("stopped"));
  }

  void a_display_without_opengl_gets_the_rest_of_the_window() {
    QProcess program;
    auto environment = QProcessEnvironment::systemEnvironment();
    environment.insert("QT_QPA_PLATFORM", "offscreen");
    program.setProcessEnvironment(environment);
    program.start(CLOTHLAB_PROGRAM, {"pendulum"});
    QVERIFY(program.waitForStarted());
    QVERIFY2(!program.waitForFinished(2500), "it ended by itself");
    program.kill();
    program.waitForFinished();
  }

  void an_idle_window_fetches_nothing() {
    WindowBench bench;
    QTest::qWait(200);
    QSignalSpy fetches(&bench.window.simulation(), &RunLink::statusChanged);
    QTest::qWait(300);
    QCOMPARE(fetches.count(), 0);
  }

 private:
  QTemporaryDir folder;
};

const Listed listed{"window_test", test_main<WindowTest>};

}  // namespace clothlab::test::window_test

#include "window_test.moc"
