// Ranges on the axes of a sweep's parallel coordinates, by real drags, clicks and keys.
#include <QLabel>
#include <QProcess>
#include <QScrollArea>
#include <fstream>

#include "listed_test.h"
#include "params/panel_parts.h"
#include "studies_bench.h"
#include "sweep/sweep_points.h"

namespace clothlab::test::parallel_brush_test {
namespace {

const std::string scene_text = R"({"format": "clothlab/scene/1", "title": "A small sheet",
 "cloth": {"columns": 5, "rows": 5, "width": 1, "height": 1, "mass": 0.25, "origin": [-0.5, 1, 0],
           "across": [1, 0, 0], "down": [0, -0.3, 0.95], "pins": ["top-left", "top-right"]},
 "springs": {"structural": 50, "shear": 20, "flexion": 5}, "damping": 0.01, "gravity": [0, -9.81, 0],
 "integrator": {"method": "verlet", "time_step": 0.0005}, "duration": 0.2, "record": {"interval": 0.01}})";

const std::string plan_text = R"({"format": "clothlab/sweep/1", "scene": )" + scene_text + R"(,
 "vary": [{"path": "springs.structural", "from": 10, "to": 400, "count": 4, "scale": "log"},
          {"path": "springs.shear", "from": 5, "to": 50, "count": 4},
          {"path": "damping", "from": 0.001, "to": 0.1, "count": 4, "scale": "log"}],
 "outputs": [{"name": "sag", "of": "sag", "reduce": "final"}]})";

constexpr std::size_t structural = 0, shear = 1, damping = 2, sag = 3;  // columns

}  // namespace

class BrushBench : public StudiesBench {
 public:
  BrushBench(const QString& scene, const QString& folder) : StudiesBench(scene) {
    window.resize(1400, 1000);  // the diagram is to have room
    panel().openFolder(folder);
    const auto is_drawn = [this] {
      return std::holds_alternative<cloth::ParallelCoordinates>(plot().diagram());
    };
    if (!QTest::qWaitFor(is_drawn, patience)) qFatal("no parallel coordinates were drawn");
    QTest::qWait(100);
  }

  const cloth::ParallelCoordinates& lines() { return std::get<cloth::ParallelCoordinates>(plot().diagram()); }
  QString count() { return QString::fromStdString(kept_words(lines())); }
  QString said() { return part<ElidedLabel>("studyLine")->toolTip(); }

  /// A place on an axis, as a part of its length from the bottom.
  QPoint on_axis(std::size_t column, double part) {
    const QRectF axis = plot().placeOfAxis(column);
    return QPointF(axis.center().x(), axis.bottom() - part * axis.height()).toPoint();
  }
  void press(QPoint at) { QTest::mousePress(&plot(), Qt::LeftButton, {}, at); }
  void move(QPoint from, QPoint to) {
    for (int k = 1; k <= 5; ++k) {
      QMouseEvent event(QEvent::MouseMove, from + (to - from) * k / 5.0,
                        plot().mapToGlobal(from + (to - from) * k / 5.0), Qt::NoButton, Qt::LeftButton, {});
      QApplication::sendEvent(&plot(), &event);
    }
  }
  void release(QPoint at) { QTest::mouseRelease(&plot(), Qt::LeftButton, {}, at); }
  void drag(std::size_t column, double from, double to) {
    const QPoint start = on_axis(column, from), end = on_axis(column, to);
    press(start);
    move(start, end);
    release(end);
  }
  void click_axis(std::size_t column, double part) {
    QTest::mouseClick(&plot(), Qt::LeftButton, {}, on_axis(column, part));
  }
  void key(Qt::Key key, Qt::KeyboardModifiers modifiers = {}) { QTest::keyClick(&plot(), key, modifiers); }

  /// A place between two axes where this run is what the pointer finds; null: there is none.
  QPoint place_on_line(int run) {
    const QRectF first = plot().placeOfAxis(structural), second = plot().placeOfAxis(shear);
    for (double x = first.right() + 8; x < second.left() - 8; x += 3)
      for (double y = first.top(); y < first.bottom(); y += 2)
        if (const PlotTouch* touch = plot().touchAt(QPointF(x, y).toPoint()); touch && touch->tag == run)
          return QPointF(x, y).toPoint();
    return {};
  }
  std::vector<int> runs(bool kept) {
    std::vector<int> found;
    for (std::size_t row = 0; row < lines().table.rows(); ++row)
      if (is_kept(lines(), row) == kept) found.push_back(lines().table.tag_of(row));
    return found;
  }
};

class ParallelBrushTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    QVERIFY(folder_.isValid());
    scene_ = folder_.filePath("small.scene.json");
    std::ofstream(scene_.toStdString()) << scene_text;
    std::ofstream(folder_.filePath("three.sweep.json").toStdString()) << plan_text;
    whole_ = folder_.filePath("whole");
    makeShard(whole_, {});
  }

  void a_drag_along_an_axis_picks_the_runs_with_these_values() {
    BrushBench bench(scene_, whole_);
    QCOMPARE(bench.lines().table.rows(), 64u);
    bench.drag(structural, 0.5, 1);  // the two stiffer of four
    QCOMPARE(bench.plot().brushes().size(), 1u);
    QCOMPARE(bench.count(), QString("32 of 64 runs"));
    QVERIFY2(bench.said().contains("32 of 64 runs"), qPrintable(bench.said()));
    QCOMPARE(bench.plot().accessibleDescription(), QString("32 of 64 runs"));
    for (std::size_t row = 0; row < 64; ++row) {
      const bool stiff = bench.lines().table.columns[structural].values[row] > 63;
      QCOMPARE(is_kept(bench.lines(), row), stiff);
      QCOMPARE(bench.plot().placeOf(bench.lines().table.tag_of(row)).isEmpty(), !stiff);
    }
  }

  void ranges_on_several_axes_hold_together_and_a_click_takes_one_away() {
    BrushBench bench(scene_, whole_);
    bench.drag(structural, 0.5, 1);
    bench.drag(damping, 0, 0.5);  // downwards or upwards
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    bench.write_picture("sweep-parallel");
    bench.drag(shear, 1, 0.85);  // the largest
    QCOMPARE(bench.count(), QString("4 of 64 runs"));
    bench.click_axis(damping, 0.2);  // on its range
    QCOMPARE(bench.count(), QString("8 of 64 runs"));
    bench.click_axis(structural, 0.1);  // beside its range
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    QCOMPARE(bench.plot().brushes().size(), 1u);
    bench.click_axis(sag, 0.5);  // without one
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    QCOMPARE(bench.window.document().paneCount(), 1u);
    QVERIFY(!bench.window.document().undoStack().canUndo());
  }

  void escape_lets_all_runs_pass_again_and_leaves_a_drag() {
    BrushBench bench(scene_, whole_);
    bench.drag(structural, 0.5, 1);
    bench.drag(shear, 0.5, 1);
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    const QPoint start = bench.on_axis(shear, 0), end = bench.on_axis(shear, 0.2);
    bench.press(start);
    bench.move(start, end);
    QCOMPARE(bench.count(), QString("8 of 64 runs"));
    bench.key(Qt::Key_Escape);  // as it was before this drag
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    bench.release(QPoint(end.x() + 40, end.y()));
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    bench.key(Qt::Key_Escape);
    QVERIFY(bench.plot().brushes().empty());
    QVERIFY(!bench.window.document().undoStack().canUndo());  // no run was opened
    for (int run = 0; run < 64; ++run) QVERIFY(!bench.plot().placeOf(run).isEmpty());
  }

  void a_click_on_a_picked_line_opens_its_run_and_faint_lines_are_not_there() {
    BrushBench bench(scene_, whole_);
    QPoint faint;
    bench.drag(structural, 0.5, 1);
    const std::vector<int> outside = bench.runs(false);
    bench.key(Qt::Key_Escape);
    for (const int run : outside)
      if (faint.isNull()) faint = bench.place_on_line(run);
    QVERIFY(!faint.isNull());
    bench.drag(structural, 0.5, 1);
    bench.drag(shear, 0.5, 1);
    QTest::mouseClick(&bench.plot(), Qt::LeftButton, {}, faint);
    const PlotTouch* there = bench.plot().touchAt(faint);
    QVERIFY(!there || !is_outside(outside, there->tag));
    const cloth::SweepPoints points(bench.panel().sweep().view()->folder.plan);
    for (const int run : bench.runs(true)) {
      const QPoint at = bench.place_on_line(run);
      if (at.isNull()) continue;
      QTest::mouseClick(&bench.plot(), Qt::LeftButton, {}, at);
      bench.settle();
      const cloth::Scene& opened = bench.window.document().scene();
      QCOMPARE(opened.springs->structural, std::get<double>(points.values(run)[0]));
      QCOMPARE(opened.springs->shear, std::get<double>(points.values(run)[1]));
      return;
    }
    QFAIL("no picked line has a place of its own");
  }

  void ranges_stay_while_another_process_fills_the_folder() {
    const QString filling = folder_.filePath("filling");
    makeShard(filling, "1/2");
    BrushBench bench(scene_, filling);
    QCOMPARE(bench.lines().table.rows(), 32u);
    bench.drag(structural, 0.5, 1);
    QCOMPARE(bench.count(), QString("16 of 32 runs"));
    const cloth::AxisBrush before = bench.plot().brushes().front();
    makeShard(filling, "2/2");
    QTRY_COMPARE_WITH_TIMEOUT(bench.count(), QString("32 of 64 runs"), patience);
    QCOMPARE(bench.plot().brushes().front().low, before.low);
    QCOMPARE(bench.plot().brushes().front().high, before.high);
    bench.panel().openFolder(whole_);  // another sweep
    QVERIFY(bench.plot().brushes().empty());
  }

  void keys_choose_an_axis_and_move_the_ends_of_its_range() {
    BrushBench bench(scene_, whole_);
    bench.plot().setFocus();
    bench.key(Qt::Key_Right);
    QVERIFY2(bench.said().contains("Structural stiffness: all values"), qPrintable(bench.said()));
    QVERIFY(bench.said().contains("Ctrl"));  // how it goes on
    bench.key(Qt::Key_Right);
    for (int k = 0; k < 10; ++k) bench.key(Qt::Key_Up, Qt::ControlModifier);  // half of the axis
    QCOMPARE(bench.count(), QString("32 of 64 runs"));
    QCOMPARE(bench.plot().brushes().front().column, shear);
    for (int k = 0; k < 5; ++k) bench.key(Qt::Key_Down, Qt::ShiftModifier);
    QCOMPARE(bench.count(), QString("16 of 64 runs"));
    QVERIFY2(bench.plot().accessibleDescription().contains("16 of 64 runs"),
             qPrintable(bench.plot().accessibleDescription()));
    bench.key(Qt::Key_Left);
    bench.key(Qt::Key_Down, Qt::ShiftModifier);
    QCOMPARE(bench.plot().brushes().size(), 2u);
    bench.key(Qt::Key_Delete);
    QCOMPARE(bench.plot().brushes().size(), 1u);
    bench.key(Qt::Key_Down);  // from run to run, among those that are picked
    bench.key(Qt::Key_Return);
    bench.settle();
    QVERIFY(bench.window.document().undoStack().canUndo());
    bench.plot().setFocus();
    bench.key(Qt::Key_Escape);
    QVERIFY(bench.plot().brushes().empty());
  }

  void the_saved_drawing_has_the_ranges() {
    BrushBench bench(scene_, whole_);
    bench.drag(structural, 0.5, 1);
    const QString file = folder_.filePath("picked.svg");
    QCOMPARE(bench.panel().save(file), QString());
    QFile saved(file);
    QVERIFY(saved.open(QIODevice::ReadOnly));
    const QByteArray text = saved.readAll();
    QVERIFY(text.contains("32 of 64 runs"));
    QVERIFY(text.contains("data-part=\"brushes\""));
  }

 private:
  static bool is_outside(const std::vector<int>& outside, int run) {
    return std::find(outside.begin(), outside.end(), run) != outside.end();
  }
  void makeShard(const QString& folder, const QString& which) {
    QStringList arguments{"sweep", folder_.filePath("three.sweep.json"), "--out", folder};
    if (!which.isEmpty()) arguments << "--shard" << which;
    QProcess cli;
    cli.start(CLOTHLAB_CLI, arguments);
    QVERIFY(cli.waitForFinished(60000));
    QCOMPARE(cli.exitCode(), 0);
  }

  QTemporaryDir folder_;
  QString scene_, whole_;
};

const Listed listed{"parallel_brush_test", test_main<ParallelBrushTest>};

}  // namespace clothlab::test::parallel_brush_test

#include "parallel_brush_test.moc"
