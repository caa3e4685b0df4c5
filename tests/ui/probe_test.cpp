// Probes in the window: set by clicks, shown beside the cloth, charted, renamed, taken out, recorded.
#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QPainter>

#include "charts/chart_panel.h"
#include "listed_test.h"
#include "scene/scene_json.h"
#include "viewport/picking.h"
#include "viewport/probe_text.h"
#include "window_bench.h"

namespace clothlab::test::probe_test {

using cloth::ParticlePlace;
using cloth::Probe;
using cloth::ProbeMeasure;

class ProbeTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void the_combo_of_measures_is_there_with_the_tool() {
    WindowBench bench;
    auto* combo = bench.window.findChild<QComboBox*>("probeMeasure");
    QVERIFY(!combo->isVisible());
    QTest::keyClick(&bench.window.view(), Qt::Key_4);
    QVERIFY(combo->isVisible());
    QCOMPARE(combo->count(), 4);
    QTest::keyClick(&bench.window.view(), Qt::Key_1);
    QVERIFY(!combo->isVisible());
  }

  void one_click_measures_a_particle_and_undo_takes_the_probe_out() {
    WindowBench bench;
    bench.action("toolProbe")->trigger();
    const int columns = bench.window.view().frame()->columns, particle = 5 * columns + 7;
    click(bench, particle);
    QCOMPARE(probes(bench).size(), std::size_t{1});
    QCOMPARE(probes(bench)[0].name, std::string("particle-1"));
    QVERIFY(probes(bench)[0].particles == std::vector<ParticlePlace>({{5, 7}}));
    bench.settle();
    const auto& frame = bench.window.view().frame();
    QCOMPARE(frame->probes.size(), std::size_t{1});
    QCOMPARE(frame->probe_values.size(), std::size_t{5});
    QVERIFY(std::abs(frame->probe_values[0] - bench.position_of(particle).x()) < 1e-6);
    QVERIFY2(bench.window.document().undoStack().undoText() == "Add probe particle-1",
             qPrintable(bench.window.document().undoStack().undoText()));
    bench.window.document().undoStack().undo();
    bench.settle();
    QVERIFY(probes(bench).empty());
    QVERIFY(bench.window.view().frame()->probes.empty());
  }

  void two_and_three_clicks_measure_a_distance_and_an_angle() {
    WindowBench bench;
    bench.action("toolProbe")->trigger();
    choose(bench, ProbeMeasure::distance);
    const int columns = bench.window.view().frame()->columns;
    click(bench, 2 * columns + 2);
    QVERIFY2(probes(bench).empty(), "one of two");
    click(bench, 2 * columns + 2);
    QVERIFY2(probes(bench).empty(), "the same again is no other particle");
    click(bench, 8 * columns + 5);
    QCOMPARE(probes(bench).size(), std::size_t{1});
    QVERIFY(probes(bench)[0].measure == ProbeMeasure::distance);
    choose(bench, ProbeMeasure::angle);
    for (const int particle : {4 * columns + 4, 6 * columns + 6, 4 * columns + 8}) click(bench, particle);
    QCOMPARE(probes(bench).size(), std::size_t{2});
    QVERIFY(probes(bench)[1].particles == std::vector<ParticlePlace>({{4, 4}, {6, 6}, {4, 8}}));
  }

  void a_line_ends_in_its_row_column_or_diagonal_nearest_to_the_click() {
    WindowBench bench;
    bench.action("toolProbe")->trigger();
    choose(bench, ProbeMeasure::line);
    const int columns = bench.window.view().frame()->columns;
    click(bench, 3 * columns + 2);
    click(bench, 4 * columns + 9);
    QCOMPARE(probes(bench).size(), std::size_t{1});
    QVERIFY(probes(bench)[0].particles == std::vector<ParticlePlace>({{3, 2}, {3, 9}}));
    bench.settle();
    QCOMPARE(bench.window.view().frame()->probes[0].particles.size(), std::size_t{8});
  }

  void escape_and_another_tool_forget_the_clicks() {
    WindowBench bench;
    bench.action("toolProbe")->trigger();
    choose(bench, ProbeMeasure::distance);
    const int columns = bench.window.view().frame()->columns;
    click(bench, 2 * columns + 2);
    QTest::keyClick(&bench.window.view(), Qt::Key_Escape);
    click(bench, 3 * columns + 3);
    QVERIFY(probes(bench).empty());
    bench.action("toolPull")->trigger();
    bench.action("toolProbe")->trigger();
    click(bench, 5 * columns + 5);
    QVERIFY(probes(bench).empty());
  }

  void a_press_with_a_drag_orbits_and_measures_nothing() {
    WindowBench bench;
    bench.action("toolProbe")->trigger();
    ClothView& view = bench.window.view();
    const double yaw = view.camera().pose().yaw;
    const QPoint from = bench.pixel_of(40), to = from + QPoint(60, 0);
    QTest::mousePress(&view, Qt::LeftButton, {}, from);
    for (const QPoint at : {(from + to) / 2, to}) {
      QMouseEvent move(QEvent::MouseMove, at, view.mapToGlobal(at), Qt::NoButton, Qt::LeftButton, {});
      QApplication::sendEvent(&view, &move);
    }
    QTest::mouseRelease(&view, Qt::LeftButton, {}, to);
    QVERIFY(probes(bench).empty());
    QVERIFY(view.camera().pose().yaw != yaw);
  }

  void each_unit_has_a_live_chart_and_its_curves_begin_where_the_probe_came() {
    WindowBench bench;
    auto* charts = bench.window.findChild<ChartPanel*>();
    QVERIFY(!charts->findChild<QWidget*>("probes_m"));
    bench.play_until(0.05);
    bench.pause();
    bench.action("toolProbe")->trigger();
    click(bench, 3 * bench.window.view().frame()->columns + 3);
    bench.play_until(0.15);
    bench.pause();
    QTRY_VERIFY(charts->findChild<QWidget*>("probes_m"));
    QVERIFY(charts->findChild<QWidget*>("probes_m_s"));
    const ChartRecord& record = charts->record();
    QCOMPARE(record.probes.size(), std::size_t{5});
    QVERIFY2(std::isnan(record.samples.value(sample_columns, 1)), "before the probe");
    const std::size_t last = record.samples.size() - 1;
    QVERIFY(std::isfinite(record.samples.value(sample_columns, last)));
    QTemporaryDir folder;
    QVERIFY(charts->exportCsv(folder.filePath("points.csv")).isEmpty());
    QFile file(folder.filePath("points.csv"));
    QVERIFY(file.open(QIODevice::ReadOnly));
    QVERIFY(file.readLine().contains(",probe.particle-1.x_m,"));
    bench.window.document().undoStack().undo();
    bench.play_until(0.2);
    QTRY_VERIFY(!charts->findChild<QWidget*>("probes_m"));
  }

  void the_form_adds_renames_and_takes_out() {
    WindowBench bench;
    LabDocument& document = bench.window.document();
    QVERIFY(document.addBlock("lowest-point"));
    QCOMPARE(probes(bench)[0].name, std::string("lowest-point-1"));
    auto* field = bench.editor("probes.0.name", "field");
    QVERIFY(field);
    QVERIFY(document.setParameter("probes.0.name", std::string("low")).isEmpty());
    QCOMPARE(probes(bench)[0].name, std::string("low"));
    QVERIFY2(document.setParameter("probes.0.name", std::string("no name")).contains("must be a letter"),
             "a name that no column can have");
    QVERIFY(document.addBlock("extent"));
    QVERIFY(document.setParameter("probes.1.name", std::string("low")).contains("another name"));
    QVERIFY(document.removeBlock("probes.0"));
    QCOMPARE(probes(bench).size(), std::size_t{1});
    QCOMPARE(probes(bench)[0].name, std::string("extent-1"));
    bench.settle();
    QVERIFY(bench.status().refusal.empty());
  }

  void a_smaller_grid_loses_the_probes_beyond_it() {
    WindowBench bench;
    LabDocument& document = bench.window.document();
    const int rows = document.scene().cloth.rows;
    QVERIFY(document.addProbe({.name = "in", .particles = {{1, 1}}}).isEmpty());
    QVERIFY(document.addProbe({.name = "out", .particles = {{rows - 1, 1}}}).isEmpty());
    QVERIFY(document.addProbe({.name = "no", .particles = {{rows, 1}}}).contains("must lie in the grid"));
    QVERIFY(document.setParameter("cloth.rows", std::int64_t{rows - 2}).isEmpty());
    QCOMPARE(probes(bench).size(), std::size_t{1});
    QCOMPARE(probes(bench)[0].name, std::string("in"));
    document.undoStack().undo();
    QCOMPARE(probes(bench).size(), std::size_t{2});
  }

  void a_mesh_line_is_a_chain_that_a_second_click_ends() {
    WindowBench bench("disc");
    bench.action("toolProbe")->trigger();
    choose(bench, ProbeMeasure::line);
    const std::vector<int> chain = apart(bench, 3);
    for (const int vertex : chain) click(bench, vertex);
    QVERIFY(probes(bench).empty());
    click(bench, chain.back());
    QCOMPARE(probes(bench).size(), std::size_t{1});
    QCOMPARE(probes(bench)[0].particles.size(), std::size_t{3});
    bench.settle();
    QVERIFY(bench.status().refusal.empty());
  }

  /// CLOTHLAB_WRITE_PICTURES=1 makes the picture of docs/guide.md anew.
  void probes_are_drawn_beside_the_cloth() {
    WindowBench bench("corners-free");
    LabDocument& document = bench.window.document();
    const QImage without = bench.window.view().grabPicture();
    for (const Probe& probe :
         {Probe{.name = "tip", .particles = {{32, 16}}},
          Probe{.name = "bend", .measure = ProbeMeasure::angle, .particles = {{24, 6}, {24, 8}, {24, 10}}},
          Probe{.name = "hem", .measure = ProbeMeasure::line, .particles = {{22, 0}, {22, 32}}},
          Probe{.name = "low", .measure = ProbeMeasure::lowest_point}})
      QVERIFY(document.addProbe(probe).isEmpty());
    QTRY_VERIFY(bench.window.view().frame()->probes.size() == 4);
    QVERIFY(bench.window.view().grabPicture() != without);
    bench.play_until(0.35);
    bench.pause();
    bench.action("toolProbe")->trigger();
    QTest::mouseMove(&bench.window.view(), bench.pixel_of(10 * 33 + 20));
    QTest::qWait(300);
    if (qEnvironmentVariableIntValue("CLOTHLAB_WRITE_PICTURES") == 0) return;
    QImage picture = bench.window.grab().toImage();
    QPainter painter(&picture);
    painter.drawImage(bench.window.view().mapTo(&bench.window, QPoint()), bench.window.view().grabPicture());
    painter.end();
    QVERIFY(picture.save(CLOTHLAB_SOURCE_DIR "/docs/pictures/probes.png"));
  }

  void labels_at_particles_keep_clear_of_the_list_wherever_the_scene_has_it() {
    WindowBench bench;
    bench.window.resize(1000, 650);
    LabDocument& document = bench.window.document();
    const auto frame = bench.window.view().frame();
    // Its label would lie upon the list, which stands at the left edge.
    const Probe corner{
        .name = "corner", .measure = ProbeMeasure::particle, .particles = {{frame->rows - 1, 0}}};
    for (const char* name : {"one", "two", "three", "four", "five"}) {
      const Probe low{.name = name, .measure = ProbeMeasure::lowest_point};
      if (name == std::string("one")) QCOMPARE(document.addProbe(corner), QString());
      QCOMPARE(document.addProbe(low), QString());
    }
    bench.settle();
    ClothView& view = bench.window.view();
    const QPoint beside_the_list(24, 130), from(view.width() / 2, view.height() / 2);
    const auto missing = [&] { return beside_the_list - bench.pixel_of((frame->rows - 1) * frame->columns); };
    for (int k = 0; k < 10 && missing().manhattanLength() > 4; ++k) {  // it is not as deep as what is panned
      const QPoint to = from + missing();
      QTest::mousePress(&view, Qt::MiddleButton, Qt::ShiftModifier, from);
      QMouseEvent move(QEvent::MouseMove, to, view.mapToGlobal(to), Qt::NoButton, Qt::MiddleButton,
                       Qt::ShiftModifier);
      QApplication::sendEvent(&view, &move);
      QTest::mouseRelease(&view, Qt::MiddleButton, Qt::ShiftModifier, to);
      QTest::qWait(20);
    }
    QVERIFY(missing().manhattanLength() <= 4);
    view.grabPicture();
    const auto& labels = view.probeLabels();
    QCOMPARE(labels.size(), std::size_t{7});  // the name of the mode, too
    for (std::size_t i = 0; i < labels.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) QVERIFY(!labels[i].intersects(labels[k]));
  }

  void values_are_said_in_percent_degrees_and_with_prefixes() {
    const auto text = [](ProbeMeasure measure, std::size_t k, double number) {
      return probe_value_text(cloth::facts_of(measure).values[k], number);
    };
    QCOMPARE(text(ProbeMeasure::distance, 1, 0.0123), QString("1.23 %"));
    QCOMPARE(text(ProbeMeasure::angle, 0, 1.5707963), QString("90°"));
    QCOMPARE(text(ProbeMeasure::angle, 1, 12.5), QString("12.5 1/m"));
    QCOMPARE(text(ProbeMeasure::particle, 4, 0.0213), QString("21.3 mm"));
    QCOMPARE(text(ProbeMeasure::particle, 4, NAN), QString("none"));
    QCOMPARE(text(ProbeMeasure::rest, 0, 1), QString("yes"));
    QCOMPARE(text(ProbeMeasure::shadow, 0, 0.25), QString("0.25 m²"));
  }

 private:
  static const std::vector<Probe>& probes(WindowBench& bench) {
    return bench.window.document().scene().probes;
  }

  static void click(WindowBench& bench, int particle) {
    const QPoint at = bench.pixel_of(particle);
    QTest::mouseMove(&bench.window.view(), at);
    QTest::mouseClick(&bench.window.view(), Qt::LeftButton, {}, at);
  }

  static void choose(WindowBench& bench, ProbeMeasure measure) {
    auto* combo = bench.window.findChild<QComboBox*>("probeMeasure");
    combo->setCurrentIndex(combo->findData(static_cast<int>(measure)));
  }

  /// Vertices that a click at their pixels meets, with room between them.
  static std::vector<int> apart(WindowBench& bench, std::size_t count) {
    std::vector<int> found;
    ClothView& view = bench.window.view();
    const auto size = static_cast<int>(view.frame()->positions.size() / 3);
    for (int i = 0; i < size && found.size() < count; ++i) {
      const QPoint at = bench.pixel_of(i);
      if (pick_particle(*view.frame(), view.camera(), {at.x(), at.y()}) != i) continue;
      const bool near = std::any_of(found.begin(), found.end(), [&](int other) {
        return (bench.pixel_of(other) - at).manhattanLength() < 60;
      });
      if (!near) found.push_back(i);
    }
    return found;
  }
};

const Listed listed{"probe_test", test_main<ProbeTest>};

}  // namespace clothlab::test::probe_test

#include "probe_test.moc"
