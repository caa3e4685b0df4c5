// Sweeps in the window, by real clicks and keys: a parameter's menu varies it, the Studies dock runs the
// sweep and draws it while it fills, a click on a point opens its run.
#include <QAccessible>
#include <QCheckBox>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QProcess>
#include <QScrollArea>
#include <fstream>
#include <nlohmann/json.hpp>

#include "document/varied_ranges.h"
#include "io/csv.h"
#include "io/text_file.h"
#include "listed_test.h"
#include "params/parameter_panel.h"
#include "params/range_slider.h"
#include "studies_bench.h"
#include "sweep/sweep_points.h"
#include "sweep/sweep_results.h"

namespace clothlab::test::sweep_window_test {
namespace {

/// Of the map: values of the stiffness, and of the damping. 1,000 points.
constexpr int across = 40, up = 25;

/// The rows of a table without what belongs to the machine.
QStringList rows_of(const cloth::CsvTable& table) {
  QStringList rows;
  for (const auto& row : table.rows) {
    QStringList fields;
    for (std::size_t k = 0; k < row.size(); ++k)
      if (table.header[k] != "wall_s" && table.header[k] != "host") fields << QString::fromStdString(row[k]);
    rows << fields.join(',');
  }
  return rows;
}

QStringList rows_of(const QString& folder) {
  std::string text;
  const auto error = cloth::read_text_file(QDir(folder).filePath("sweep.csv").toStdString(), text);
  return error ? QStringList(QString::fromStdString(error->text())) : rows_of(cloth::parse_csv(text));
}

/// The plan that a folder holds, as a file for the command line.
QString plan_file(const QString& folder, const QString& name) {
  std::ifstream index(QDir(folder).filePath("sweep.json").toStdString());
  const auto root = nlohmann::ordered_json::parse(index);
  std::ofstream file(name.toStdString());
  file << root["plan"].dump(2);
  return name;
}

}  // namespace

class SweepBench : public StudiesBench {
 public:
  explicit SweepBench(const QString& scene = "corners-shear") : StudiesBench(scene) {
    panel().choices().choose(StudyChoices::Kind::sweep);
  }

  /// Chooses an entry of the parameter's menu with the mouse.
  void from_menu(const char* path, const char* entry) {
    window.parameters().reveal(path);
    auto* button = qobject_cast<QToolButton*>(editor(path, "parameterMenu"));
    QVERIFY(button);
    QTimer::singleShot(200, [entry] {
      auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
      QVERIFY(menu);
      auto* action = menu->findChild<QAction*>(QLatin1String(entry));
      QVERIFY2(action, entry);
      QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
    });
    QTest::mouseClick(button, Qt::LeftButton);
    QTest::qWait(50);
  }
  void type_into(const char* path, const char* part, const QString& text) {
    auto* field = qobject_cast<QLineEdit*>(editor(path, part));
    QVERIFY2(field, part);
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, text);
    QTest::keyClick(field, Qt::Key_Return);
  }
  void set_count(const char* path, const QString& text) {
    auto* count = editor(path, "rangeCount");
    QVERIFY(count);
    auto* line = count->findChild<QLineEdit*>();
    line->setFocus();
    line->selectAll();
    QTest::keyClicks(line, text);
    QTest::keyClick(line, Qt::Key_Return);
  }
  VariedRanges& varied() { return window.document().varied(); }
  void vary(const char* path, const QString& from, const QString& to, const QString& count) {
    from_menu(path, "vary");
    QTRY_VERIFY_WITH_TIMEOUT(varied().find(path), patience);
    QTest::qWait(50);
    type_into(path, "rangeToField", to);
    type_into(path, "rangeFromField", from);
    set_count(path, count);
  }
  std::shared_ptr<const SweepView> view() { return panel().sweep().view(); }
  void wait_until_whole() {
    QTRY_VERIFY_WITH_TIMEOUT(!panel().isRunning() && view() && view()->results.missing() == 0, 120000);
  }
};

class SweepWindowTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    QVERIFY(folder_.isValid());
    scene_ = folder_.filePath("small.scene.json");
    std::ofstream(scene_.toStdString()) << R"({"format": "clothlab/scene/1", "title": "A small sheet",
 "cloth": {"columns": 5, "rows": 5, "width": 1, "height": 1, "mass": 0.25, "origin": [-0.5, 1, 0],
           "across": [1, 0, 0], "down": [0, -0.3, 0.95], "pins": ["top-left", "top-right"]},
 "springs": {"structural": 50, "shear": 20, "flexion": 5}, "damping": 0.01, "gravity": [0, -9.81, 0],
 "integrator": {"method": "verlet", "time_step": 0.0005}, "duration": 1, "record": {"interval": 0.01}})";
  }

  /// From the window as it opens, with its default scene, to the diagram: each press of a button and each
  /// choice in a menu is an action.
  void stiffness_against_sag_is_found_in_six_actions() {
    WindowBench bench;
    int actions = 0;
    auto* menu_button = qobject_cast<QToolButton*>(bench.editor("springs.structural", "parameterMenu"));
    QVERIFY(menu_button);
    auto* area = bench.window.parameters().findChild<QScrollArea*>("scroll");
    const QRect seen = area->viewport()->rect();
    if (!seen.contains(menu_button->mapTo(area->viewport(), menu_button->rect().center()))) {
      area->ensureWidgetVisible(menu_button);
      ++actions;
    }
    QTimer::singleShot(200, [&actions] {
      auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
      QVERIFY(menu);
      QTest::mouseClick(menu, Qt::LeftButton, {},
                        menu->actionGeometry(menu->findChild<QAction*>("vary")).center());
      ++actions;
    });
    QTest::mouseClick(menu_button, Qt::LeftButton);
    ++actions;
    QTRY_VERIFY_WITH_TIMEOUT(bench.window.studies().isVisible(), patience);
    StudiesPanel& panel = bench.window.studies();
    auto* start = panel.findChild<QPushButton*>("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(start->isVisible() && start->isEnabled(), patience);
    QTest::mouseClick(start, Qt::LeftButton);
    ++actions;
    QTRY_VERIFY_WITH_TIMEOUT(
        panel.sweep().view() && panel.sweep().view()->results.missing() == 0 && !panel.isRunning(), 120000);
    const auto* curve = std::get_if<cloth::LinePlot>(&panel.plot().diagram());
    QVERIFY(curve);
    QCOMPARE(curve->x.label, std::string("Structural stiffness"));
    QCOMPARE(curve->y.label, std::string("sag at the end"));
    QCOMPARE(curve->y.unit, std::string("m"));
    QVERIFY(curve->series.front().points.size() >= 9);
    QVERIFY2(actions <= 6, qPrintable(QString::number(actions)));
    bench.write_picture("sweep-curve");
  }

  void a_range_is_set_by_fields_handles_and_keys_and_undone() {
    SweepBench bench(scene_);
    const char* path = "springs.structural";
    bench.from_menu(path, "vary");
    QTRY_VERIFY_WITH_TIMEOUT(bench.varied().find(path), patience);
    QTest::qWait(100);
    QVERIFY(bench.varied().find(path)->from < 50 && bench.varied().find(path)->to > 50);
    bench.type_into(path, "rangeFromField", "10 N/m");
    QCOMPARE(bench.varied().find(path)->from, 10.0);
    auto* from = qobject_cast<QSlider*>(bench.editor(path, "rangeFrom"));
    QVERIFY(from);
    QVERIFY(!from->accessibleName().isEmpty());
    auto* access = QAccessible::queryAccessibleInterface(from);
    QVERIFY(access && access->valueInterface());
    from->setFocus();
    QTest::keyClick(from, Qt::Key_Right);
    QCOMPARE(bench.varied().find(path)->from, 11.0);
    auto* slider = static_cast<RangeSlider*>(bench.editor(path, "range"));
    const double before = bench.varied().find(path)->to;
    auto* to = slider->handle(RangeSlider::End::to);
    QTest::mousePress(to, Qt::LeftButton, {}, to->rect().center());
    for (int k = 1; k <= 10; ++k) QTest::mouseMove(to, to->rect().center() - QPoint(2, 0));
    QTest::mouseRelease(to, Qt::LeftButton);
    QVERIFY(bench.varied().find(path)->to < before);
    bench.window.document().undoStack().undo();  // the drag is one step
    QCOMPARE(bench.varied().find(path)->to, before);
    QVERIFY(!bench.window.document().isModified());
    bench.type_into(path, "rangeFromField", "-3");
    QCOMPARE(bench.varied().find(path)->from, 11.0);
    bench.from_menu(path, "vary");  // says now that it ends
    QTRY_VERIFY_WITH_TIMEOUT(!bench.varied().find(path), patience);
    QVERIFY(!bench.editor(path, "rangeFrom") || !bench.editor(path, "rangeFrom")->isVisible());
  }

  void a_map_stopped_three_times_has_the_rows_of_the_command_line() {
    const QString here = folder_.filePath("stopped"), there = folder_.filePath("command-line");
    for (int attempt = 0; attempt < 4; ++attempt) {
      SweepBench bench(scene_);
      if (attempt == 0) {
        bench.vary("springs.structural", "10", "400", QString::number(across));
        bench.vary("damping", "0.001", "0.1", QString::number(up));
        bench.type("studyFolder", here);
        bench.push("startStudy");
      } else {
        bench.panel().openFolder(here);
        QTRY_VERIFY_WITH_TIMEOUT(bench.part<QPushButton>("goOn")->isVisible(), patience);
        bench.push("goOn");
      }
      if (attempt == 3) {
        bench.wait_until_whole();
        break;
      }
      const auto made = [&bench] { return bench.view() ? std::ssize(bench.view()->results.rows) : 0; };
      const auto wanted = 50 + 250 * attempt;
      QTRY_VERIFY_WITH_TIMEOUT(made() > wanted, 60000);
      if (attempt == 0) bench.push("cancelStudy");  // the others are stopped by closing the window
      if (attempt == 0) QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning(), patience);
      if (attempt == 1) bench.write_picture("sweep-map");
    }
    QProcess cli;
    cli.start(CLOTHLAB_CLI, {"sweep", plan_file(here, folder_.filePath("again.sweep.json")), "--out", there});
    QVERIFY(cli.waitForFinished(120000));
    QCOMPARE(cli.exitCode(), 0);
    const QStringList rows = rows_of(there);
    QCOMPARE(rows.size(), across * up);
    QCOMPARE(rows_of(here), rows);
  }

  void a_click_opens_a_run_and_others_beside_it() {
    SweepBench bench(scene_);
    bench.panel().openFolder(folder_.filePath("stopped"));
    QTRY_VERIFY_WITH_TIMEOUT(bench.view(), patience);
    QTest::qWait(100);
    const auto click = [&](int point, Qt::KeyboardModifiers keys = {}) {
      QTest::mouseClick(&bench.plot(), Qt::LeftButton, keys, bench.plot().placeOf(point).center().toPoint());
      bench.settle();
    };
    LabDocument& document = bench.window.document();
    const cloth::SweepPoints points(bench.view()->folder.plan);
    const auto structural = [&](int point) { return std::get<double>(points.values(point)[0]); };
    click(5 * up + 3);
    QCOMPARE(document.paneCount(), 1u);
    QCOMPARE(document.scene().springs->structural, structural(5 * up + 3));
    click(9 * up + 3, Qt::ControlModifier);
    click(14 * up + 3, Qt::ControlModifier);
    click(20 * up + 3, Qt::ControlModifier);
    click(22 * up + 3, Qt::ControlModifier);  // there is no fifth
    QCOMPARE(document.paneCount(), 4u);
    QCOMPARE(scene_of(document.comparison(), 3).springs->structural, structural(20 * up + 3));
    click(22 * up + 3);  // in the last pane
    QCOMPARE(document.paneCount(), 4u);
    QCOMPARE(scene_of(document.comparison(), 3).springs->structural, structural(22 * up + 3));
    QCOMPARE(scene_of(document.comparison(), 0).springs->structural, structural(5 * up + 3));
    while (document.undoStack().canUndo()) document.undoStack().undo();
    QCOMPARE(document.paneCount(), 1u);
    QCOMPARE(document.scene().springs->structural, 50.0);
  }

  void keys_go_from_run_to_run_and_open_them() {
    SweepBench bench(scene_);
    bench.panel().openFolder(folder_.filePath("stopped"));
    QTRY_VERIFY_WITH_TIMEOUT(bench.view(), patience);
    QTest::qWait(100);
    bench.plot().setFocus();
    QTest::keyClick(&bench.plot(), Qt::Key_Right);  // the first one
    QTest::keyClick(&bench.plot(), Qt::Key_Right);  // another stiffness
    QTest::keyClick(&bench.plot(), Qt::Key_Up);     // another damping
    QVERIFY(bench.plot().accessibleDescription().contains("point 26"));
    QTest::keyClick(&bench.plot(), Qt::Key_Return);
    bench.settle();
    const cloth::SweepPoints points(bench.view()->folder.plan);
    QCOMPARE(bench.window.document().scene().springs->structural, std::get<double>(points.values(up + 1)[0]));
  }

  /// Another process fills the folder.
  void a_folder_that_the_command_line_fills_is_followed() {
    const QString there = folder_.filePath("followed");
    const QString plan = folder_.filePath("again.sweep.json");
    const auto shard = [&](const char* which) {
      QProcess cli;
      cli.start(CLOTHLAB_CLI, {"sweep", plan, "--out", there, "--shard", which});
      QVERIFY(cli.waitForFinished(60000));
      QCOMPARE(cli.exitCode(), 0);
    };
    shard("1/4");
    SweepBench bench(scene_);
    bench.panel().openFolder(there);
    QTRY_VERIFY_WITH_TIMEOUT(bench.view() && bench.view()->results.rows.size() == 250, patience);
    QVERIFY(std::holds_alternative<cloth::HeatMap>(bench.plot().diagram()));
    shard("3/4");
    QTRY_VERIFY_WITH_TIMEOUT(bench.view()->results.rows.size() == 500, patience);
    shard("2/4");
    shard("4/4");
    QTRY_VERIFY_WITH_TIMEOUT(bench.view()->results.missing() == 0, patience);
    QVERIFY(!bench.part<QPushButton>("goOn")->isVisible());
    QVERIFY(!bench.panel().sweep().isFollowed());
  }

  void the_form_says_how_long_it_would_take_before_it_starts() {
    SweepBench bench(scene_);
    bench.vary("springs.structural", "10", "400", "5");
    auto* time = bench.part<QLabel>("sweepTime");
    QTRY_VERIFY_WITH_TIMEOUT(time->text().startsWith("5 runs") && time->text().contains("each"), patience);
  }

  void three_parameters_are_parallel_coordinates() {
    SweepBench bench(scene_);
    bench.vary("springs.structural", "10", "400", "3");
    bench.vary("springs.shear", "5", "50", "3");
    bench.vary("damping", "0.001", "0.1", "3");
    bench.type("studyFolder", folder_.filePath("three"));
    bench.push("startStudy");
    bench.wait_until_whole();
    QTRY_VERIFY_WITH_TIMEOUT(std::holds_alternative<cloth::ParallelCoordinates>(bench.plot().diagram()),
                             patience);
    const auto& lines = std::get<cloth::ParallelCoordinates>(bench.plot().diagram());
    QCOMPARE(lines.table.rows(), 27u);
  }

 private:
  QTemporaryDir folder_;
  QString scene_;
};

const Listed listed{"sweep_window_test", test_main<SweepWindowTest>};

}  // namespace clothlab::test::sweep_window_test

#include "sweep_window_test.moc"
