// What a user does with methods side by side, by real clicks, keys and drags.
#include <QApplication>
#include <QClipboard>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QTemporaryDir>
#include <cmath>

#include "charts/live_chart.h"
#include "compare/comparison_json.h"
#include "compare/run_comparison.h"
#include "compare_bench.h"
#include "io/csv.h"
#include "io/text_file.h"
#include "listed_test.h"
#include "main_window/lab_window.h"
#include "patience.h"
#include "theme/theme.h"
#include "viewport/picking.h"

namespace clothlab::test::compare_test {
namespace {

std::vector<std::vector<std::string>> timeless_rows(const std::filesystem::path& path) {
  std::string text;
  cloth::read_text_file(path, text);
  const cloth::CsvTable table = cloth::parse_csv(text);
  std::vector<std::vector<std::string>> rows;
  for (const auto& row : table.rows) {
    rows.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c)
      if (table.header[c].find("step_time_us") == std::string::npos) rows.back().push_back(row[c]);
  }
  return rows;
}

}  // namespace

class CompareTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void the_main_window_compares_the_scene_being_edited_with_two_other_methods() {
    LabWindow window;
    window.setAsksToSave(false);
    window.show();
    QVERIFY(QTest::qWaitForWindowActive(&window, patience));
    window.openScene("corners-free");
    window.document().setParameter("springs.structural", 123.0);
    window.findChild<QAction*>("compareMethods")->trigger();
    LabWindow* compare = nullptr;
    for (QWidget* top : QApplication::topLevelWidgets())
      if (auto* found = qobject_cast<LabWindow*>(top); found && found != &window) compare = found;
    QVERIFY(compare);
    compare->simulation().settle();
    const cloth::Comparison& comparison = compare->document().comparison();
    QCOMPARE(comparison.scene, window.document().scene());
    QCOMPARE(comparison.panes.size(), std::size_t{3});
    QCOMPARE(compare->panes().paneCount(), std::size_t{3});
    QVERIFY(compare->simulation().status().refusal.empty());
    compare->setAsksToSave(false);
    compare->close();
  }

  void panes_show_what_lock_step_computes_to_the_bit() {
    CompareBench bench;
    bench.play_to_the_end();
    cloth::LockStep expected(small_comparison());
    for (std::int64_t k = 1; k <= expected.last_index(); ++k) QVERIFY(expected.advance(k));
    for (std::size_t pane = 0; pane < 2; ++pane) {
      const auto& shown = bench.window.panes().pane(pane).view().frame();
      const cloth::Vec3Field& position = expected.lane(pane).state.position;
      QCOMPARE(shown->positions.size(), 3 * position.size());
      for (std::size_t i = 0; i < position.size(); ++i)
        QCOMPARE(shown->positions[3 * i + 1], static_cast<float>(position.y()[i]));
    }
    QCOMPARE(*bench.status().panes[1].rms, expected.difference(1)->rms);
    QVERIFY(bench.part<QLabel>(1, "difference")->text().startsWith("RMS "));
    QCOMPARE(bench.part<QLabel>(0, "difference")->text(), QString("Reference"));
    QVERIFY(bench.part<Reading>(0, "cost")->text().endsWith("s/s"));
  }

  void dragging_a_shared_slider_acts_on_all_panes_and_is_one_undo_step() {
    CompareBench bench;
    auto* slider = bench.editor("springs.structural", "slider");
    QVERIFY(slider);
    const double before = bench.comparison().scene.springs->structural;
    const int y = slider->height() / 2;
    drag(slider, {slider->width() * 2 / 5, y}, {slider->width() * 3 / 5, y});
    const double after = bench.comparison().scene.springs->structural;
    QVERIFY(after != before);
    QCOMPARE(bench.window.document().undoStack().count(), 1);
    bench.settle();
    QCOMPARE(bench.status().comparison->scene.springs->structural, after);
    bench.action("undo")->trigger();
    QCOMPARE(bench.comparison().scene.springs->structural, before);
    QCOMPARE(bench.window.document().scene().springs->structural, before);
    bench.action("redo")->trigger();
    bench.settle();
    QCOMPARE(bench.status().comparison->scene.springs->structural, after);
  }

  void a_value_changed_with_a_pane_chosen_is_its_own_until_it_is_shared_again() {
    CompareBench bench;
    bench.scope(2);  // B
    QCOMPARE(bench.window.document().scope(), std::optional<std::size_t>(1));
    auto* field = qobject_cast<ExactField*>(bench.editor("springs.structural", "field"));
    QVERIFY(field);
    const double shared = bench.comparison().scene.springs->structural;
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, "77");
    QTest::keyClick(field, Qt::Key_Return);
    QCOMPARE(bench.comparison().scene.springs->structural, shared);
    QCOMPARE(scene_of(bench.comparison(), 0).springs->structural, shared);
    QCOMPARE(scene_of(bench.comparison(), 1).springs->structural, 77.0);
    auto* note = qobject_cast<QLabel*>(bench.editor("springs.structural", "note"));
    QVERIFY(note->text().startsWith("Own value"));

    bench.scope(0);
    note = qobject_cast<QLabel*>(bench.editor("springs.structural", "note"));
    QVERIFY2(note->text().contains("B 77"), qPrintable(note->text()));
    bench.settle();
    QCOMPARE(bench.status().comparison->panes[1].own.size(), std::size_t{2});

    bench.scope(2);
    QTest::mouseClick(bench.editor("springs.structural", "noteButton"), Qt::LeftButton);
    QCOMPARE(scene_of(bench.comparison(), 1).springs->structural, shared);
    QCOMPARE(bench.window.document().scene().springs->structural, shared);
  }

  void method_and_step_are_changed_in_the_head_of_a_pane() {
    CompareBench bench;
    auto* method = bench.part<QComboBox>(1, "method");
    QCOMPARE(method->currentText(), QString("Runge-Kutta 4"));
    method->setFocus();
    QTest::keyClick(method, Qt::Key_Up);  // Verlet
    QCOMPARE(method->currentText(), QString("Verlet"));
    QCOMPARE(scene_of(bench.comparison(), 1).integrator.method, std::string("verlet"));
    bench.type_step(1, "0.25 ms");
    QCOMPARE(*scene_of(bench.comparison(), 1).integrator.time_step, 0.00025);
    bench.type_step(1, "nonsense");
    QCOMPARE(*scene_of(bench.comparison(), 1).integrator.time_step, 0.00025);
    bench.type_step(1, "auto");
    QVERIFY(!scene_of(bench.comparison(), 1).integrator.time_step);
    bench.settle();
    QVERIFY(bench.status().refusal.empty());
  }

  void a_pane_is_duplicated_and_removed_and_keeps_its_name_and_colour() {
    CompareBench bench(small_comparison({"verlet", "rk4", "semi-implicit-euler"}));
    bench.choose(1, "duplicate");
    QCOMPARE(bench.window.panes().paneCount(), std::size_t{4});
    QCOMPARE(bench.comparison().panes[2].name, std::string("D"));
    QCOMPARE(bench.comparison().panes[2].own, bench.comparison().panes[1].own);
    QVERIFY(!bench.part<QAction>(0, "duplicate")->isEnabled());
    bench.settle();
    QCOMPARE(bench.status().panes.size(), std::size_t{4});
    bench.choose(1, "removePane");
    QCOMPARE(bench.window.panes().paneCount(), std::size_t{3});
    QCOMPARE(bench.comparison().panes[1].name, std::string("D"));
    bench.settle();
    QCOMPARE(bench.status().panes[1].style, 3);
    bench.action("undo")->trigger();
    QCOMPARE(bench.window.panes().paneCount(), std::size_t{4});
  }

  void a_pane_added_while_it_runs_joins_the_run() {
    CompareBench bench;
    bench.action("step")->trigger();
    bench.action("step")->trigger();
    bench.settle();
    const double time = bench.status().time;
    QVERIFY(time > 0);
    const std::size_t recorded = bench.window.paneCharts().record().samples.size();
    bench.choose(1, "duplicate");
    bench.settle();
    QCOMPARE(bench.status().time, time);
    QCOMPARE(bench.window.panes().pane(2).view().frame()->positions,
             bench.window.panes().pane(1).view().frame()->positions);
    QCOMPARE(bench.window.paneCharts().record().samples.size(), recorded);
    QVERIFY(bench.window.notice().text().isEmpty());
    bench.choose(0, "removePane");  // the reference: another one has to be run from the start
    bench.settle();
    QCOMPARE(bench.status().time, 0.0);
    QVERIFY2(bench.window.notice().text().startsWith("Started anew"),
             qPrintable(bench.window.notice().text()));
  }

  void a_pane_that_diverges_says_why_and_the_others_go_on() {
    cloth::Comparison comparison = small_comparison({"rk4", "explicit-euler"});
    comparison.scene.deformation.reset();  // a limited cloth cannot diverge
    cloth::set_own(comparison.panes[1], "integrator.time_step", 0.005);
    CompareBench bench(comparison);
    bench.play_to_the_end();
    auto* why = bench.part<QWidget>(1, "notice:divergence");
    QVERIFY(why && why->isVisible());
    const QString text = why->findChild<QLabel*>("noticeText")->text();
    QVERIFY2(text.startsWith("Diverged at ") && text.contains("energy"), qPrintable(text));
    QVERIFY(bench.part<QLabel>(1, "difference")->text().startsWith("Stopped at "));
    QVERIFY(!bench.part<QWidget>(0, "notice:divergence"));
    QCOMPARE(bench.status().panes[0].simulated, bench.status().duration);
    QCOMPARE(bench.window.ranking().item(1, 0)->text(), QString("B"));  // stopped ones come last
  }

  void the_reference_is_chosen_and_differences_colour_the_cloth() {
    CompareBench bench;
    auto* reference = bench.window.findChild<QComboBox*>("reference");
    QCOMPARE(reference->currentText(), QString("Pane A, Verlet"));
    bench.choose(1, "makeReference");
    QCOMPARE(bench.comparison().reference, std::string("B"));
    QCOMPARE(reference->currentText(), QString("Pane B, Runge-Kutta 4"));
    reference->setFocus();
    QTest::keyClick(reference, Qt::Key_Home);
    QCOMPARE(bench.comparison().reference, std::string("controlled"));
    bench.window.panes().pane(0).view().setFocus();
    QTest::keyClick(&bench.window, Qt::Key_D);
    QCOMPARE(bench.window.panes().pane(0).view().mode(), ViewMode::strain);
    bench.play_to_the_end();
    const auto& frame = bench.window.panes().pane(0).view().frame();
    QVERIFY(frame->shows_difference);
    QCOMPARE(*std::max_element(frame->strain.begin(), frame->strain.end()),
             static_cast<float>(*bench.status().panes[0].largest));
    QVERIFY(bench.status().floor.has_value());
  }

  void one_camera_moves_in_all_panes() {
    CompareBench bench;
    ClothView& first = bench.window.panes().pane(0).view();
    if (!first.hasOpenGl()) QSKIP("no OpenGL here");
    drag(&first, {20, 60}, {90, 80}, Qt::RightButton);
    QVERIFY(!(first.camera().pose() == CameraPose()));
    QCOMPARE(bench.window.panes().pane(1).view().camera().pose() == first.camera().pose(), true);
    bench.choose(0, "duplicate");
    QVERIFY(bench.window.panes().pane(2).view().camera().pose() == first.camera().pose());
  }

  void a_hand_and_pins_act_on_all_panes_alike() {
    cloth::Comparison comparison = small_comparison({"verlet", "verlet"});
    CompareBench bench(comparison);
    ClothView& view = bench.window.panes().pane(1).view();
    if (!view.hasOpenGl()) QSKIP("no OpenGL here");
    QTest::qWait(100);
    const int particle = 4 * 9 + 4;
    const Eigen::Vector2d p = view.camera().project(particle_position(*view.frame(), particle));
    const QPoint at(qRound(p.x()), qRound(p.y()));
    bench.action("play")->trigger();
    drag(&view, at, at + QPoint(30, -20));
    bench.action("toolPin")->trigger();
    bench.settle();
    QTest::mouseClick(&view, Qt::LeftButton, Qt::NoModifier, at);
    bench.action("play")->trigger();
    bench.settle();
    QCOMPARE(bench.status().panes[1].rms.value_or(-1), 0.0);  // the same hand at the same times
  }

  void the_table_ranks_sorts_and_copies() {
    CompareBench bench(small_comparison({"rk4", "verlet", "semi-implicit-euler"}));
    bench.play_to_the_end();
    RankingTable& table = bench.window.ranking();
    QCOMPARE(table.rowCount(), 3);
    const auto order = cloth::ranked(bench.status().panes);
    for (int row = 0; row < 3; ++row)
      QCOMPARE(table.item(row, 0)->text().toStdString(),
               bench.status().panes[order[static_cast<std::size_t>(row)]].name);
    table.setFocus();
    QTest::keyClick(&table, Qt::Key_C, Qt::ControlModifier);
    const QString text = QApplication::clipboard()->text();
    QCOMPARE(text.count('\n'), 4);
    QVERIFY(text.startsWith("Pane\tMethod\tBy error\tRMS [mm]"));
  }

  void recording_writes_the_rows_of_the_command_line() {
    QTemporaryDir folder;
    CompareBench bench;
    bench.window.startRecording(folder.filePath("window"));
    bench.play_to_the_end();
    QVERIFY(!bench.status().recording);
    const std::filesystem::path alone = folder.filePath("alone").toStdString();
    cloth::run_comparison(small_comparison(), {.folder = alone, .progress = {}, .may_go_on = {}});
    const std::filesystem::path window = folder.filePath("window").toStdString();
    for (const char* file : {"A.csv", "B.csv", "compare.csv"}) {
      QCOMPARE(timeless_rows(window / file).size(), std::size_t{31});
      QVERIFY2(timeless_rows(window / file) == timeless_rows(alone / file), file);
    }
  }

  void legends_name_methods_and_another_method_changes_no_more_than_its_name() {
    CompareBench bench;
    CompareCharts& charts = bench.window.paneCharts();
    const auto entry = [&](const char* name) {
      return charts.findChild<QAbstractButton*>(QLatin1String(name));
    };
    QVERIFY(entry("compare_name_a")->isVisible());
    QCOMPARE(entry("compare_name_a")->text(), QString("A  Verlet"));
    QCOMPARE(entry("compare_energy_a")->text(), QString("A"));
    QVERIFY(entry("compare_energy_a")->toolTip().contains("A  Verlet"));
    LiveChart* energy = charts.chart("compare_energy");
    QTest::mouseClick(entry("compare_energy_log"), Qt::LeftButton);
    QVERIFY(energy->is_logarithmic());
    auto* methods = bench.part<QComboBox>(0, "method");
    methods->setFocus();
    QTest::keyClick(methods, Qt::Key_Home);
    bench.settle();
    QVERIFY(!entry("compare_name_a")->text().endsWith("Verlet"));
    QVERIFY(entry("compare_name_a")->text().startsWith("A  "));
    QCOMPARE(charts.chart("compare_energy"), energy);
    QVERIFY(energy->is_logarithmic());
    QTest::mouseClick(entry("compare_name_a"), Qt::LeftButton);
    for (const char* key : {"compare_energy", "compare_difference"})
      QCOMPARE(charts.chart(key)->shown_curves(), (std::vector<bool>{false, true}));
  }

  void the_charts_are_saved_with_a_column_for_each_pane_and_quantity() {
    QTemporaryDir folder;
    CompareBench bench;
    bench.play_to_the_end();
    CompareCharts& charts = bench.window.paneCharts();
    QCOMPARE(charts.exportPng(folder.filePath("charts.png")), QString());
    QCOMPARE(QImage(folder.filePath("charts.png")).size(), QSize(1600, 1400));
    QCOMPARE(charts.exportSvg(folder.filePath("charts.svg")), QString());
    QCOMPARE(charts.exportCsv(folder.filePath("charts.csv")), QString());
    std::string text;
    cloth::read_text_file(folder.filePath("charts.csv").toStdString(), text);
    const cloth::CsvTable table = cloth::parse_csv(text);
    QCOMPARE(table.header, (std::vector<std::string>{"time_s", "A_total_J", "A_max_strain", "A_step_ms",
                                                     "A_rms_difference_m", "B_total_J", "B_max_strain",
                                                     "B_step_ms", "B_rms_difference_m"}));
    QCOMPARE(table.rows.size(), charts.record().samples.size());
    QCOMPARE(std::stod(table.rows.back().back()), *bench.status().panes[1].rms);
    QVERIFY(!charts.exportCsv(folder.filePath("no/such/folder.csv")).isEmpty());
  }

  void a_comparison_is_saved_and_opened_again() {
    QTemporaryDir folder;
    CompareBench bench;
    bench.choose(0, "duplicate");
    QVERIFY(bench.window.document().isModified());
    const QString path = folder.filePath("mine.compare.json");
    QVERIFY(bench.window.saveTo(path));
    QVERIFY(!bench.window.document().isModified());
    const cloth::Comparison saved = bench.comparison();
    CompareBench again;
    again.window.openComparison(path);
    again.settle();
    QCOMPARE(again.comparison(), saved);
    QCOMPARE(again.window.panes().paneCount(), std::size_t{3});
    again.window.openComparison(folder.filePath("missing.compare.json"));
    QVERIFY(again.window.notice().text().contains("missing.compare.json"));
    QCOMPARE(again.comparison(), saved);
  }
};

const Listed listed{"compare_test", test_main<CompareTest>};

}  // namespace clothlab::test::compare_test

#include "compare_test.moc"
