// Fits in the window: a table of measured values dropped on a chart, its columns, the parameters to find, the
// values with their standard errors; and what is said of tables that are none.
#include <QComboBox>
#include <QDropEvent>
#include <QLabel>
#include <QMimeData>
#include <fstream>

#include "charts/chart_panel.h"
#include "charts/live_chart.h"
#include "document/varied_ranges.h"
#include "listed_test.h"
#include "simulation/recorder.h"
#include "studies/fit_choices.h"
#include "studies_bench.h"

namespace clothlab::test::fit_window_test {
namespace {

/// As a hand drops a file there.
bool drop(QWidget& on, const QString& file) {
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(file)});
  const QPoint at = on.rect().center();
  QDragEnterEvent enter(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&on, &enter);
  if (!enter.isAccepted()) return false;
  QDropEvent dropped(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&on, &dropped);
  return true;
}

/// The kinetic energy of a run, with noise of one hundredth of a joule whose standard deviation is known.
void write_measured(const cloth::Scene& scene, const QString& file) {
  std::ofstream table(file.toStdString());
  table << "time_s,kinetic_J,kinetic_J_sigma\n";
  int row = 0;
  const double noise[] = {0.4, -1.1, 0.2, 0.9, -0.3, -0.8, 1.2, 0.1, -0.5, 0.6};
  cloth::RunOptions options;
  options.row = [&](const cloth::Simulation&, const cloth::Measurement& measured) {
    if (++row % 3 != 0) return;
    table << measured.time << ',' << measured.energy.kinetic + 0.002 * noise[row % 10] << ",0.002\n";
  };
  run_scene(scene, options);
}

}  // namespace

class FitWindowTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    QVERIFY(folder_.isValid());
    scene_ = folder_.filePath("swing.scene.json");
    std::ofstream(scene_.toStdString()) << R"({"format": "clothlab/scene/1", "title": "A swinging sheet",
 "cloth": {"columns": 5, "rows": 5, "width": 1, "height": 1, "mass": 0.25, "origin": [-0.5, 1, 0],
           "across": [1, 0, 0], "down": [0, -0.3, 0.95], "pins": ["top-left", "top-right"]},
 "springs": {"structural": 80, "shear": 20, "flexion": 5}, "damping": 0.01, "gravity": [0, -9.81, 0],
 "integrator": {"method": "verlet", "time_step": 0.0005}, "duration": 0.6, "record": {"interval": 0.01}})";
  }

  void a_table_dropped_on_a_chart_gives_the_parameter_back() {
    const QString table = folder_.filePath("swing.csv");
    StudiesBench bench(scene_);
    write_measured(bench.window.document().scene(), table);
    // The scene on the screen has another stiffness than the one that was measured.
    bench.window.document().setParameter("springs.structural", 50.0);
    bench.settle();
    QVERIFY(drop(bench.window.charts(), table));
    QCOMPARE(bench.panel().choices().kind(), StudyChoices::Kind::fit);
    QCOMPARE(bench.part<QComboBox>("fitTime")->currentText(), QString("time_s"));
    QCOMPARE(bench.part<QComboBox>("fitValue")->currentText(), QString("kinetic_J"));
    QCOMPARE(bench.part<QComboBox>("fitQuantity")->currentData().toString(), QString("kinetic_J"));
    QCOMPARE(bench.part<QComboBox>("fitSigma")->currentText(), QString("kinetic_J_sigma"));
    QVERIFY(bench.window.charts().record().measured);
    bench.window.document().varied().add("springs.structural");
    QTest::qWait(100);
    QCOMPARE(bench.panel().choices().kind(), StudyChoices::Kind::fit);
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning() && bench.panel().fitted(), 120000);
    const cloth::FitResult& result = bench.panel().fitted()->account.result;
    QCOMPARE(result.parameters.size(), 1u);
    QCOMPARE(result.parameters[0].verdict, cloth::FitVerdict::identified);
    QVERIFY2(std::abs(result.parameters[0].value - 80) < 3 * result.parameters[0].standard_error,
             qPrintable(QString::number(result.parameters[0].value)));
    QTRY_VERIFY_WITH_TIMEOUT(bench.part<QLabel>("fitValues")->text().contains("identified"), patience);
    QVERIFY(std::holds_alternative<cloth::LinePlot>(bench.plot().diagram()));
    bench.play_until(0.55);
    bench.pause();
    bench.write_picture("fit-window");
    bench.push("useFit");
    QCOMPARE(bench.window.document().scene().springs->structural, result.parameters[0].value);
    bench.window.document().undoStack().undo();
    QCOMPARE(bench.window.document().scene().springs->structural, 50.0);
  }

  void measured_points_lie_over_the_curve_of_their_quantity() {
    const QString table = folder_.filePath("swing.csv");
    StudiesBench bench(scene_);
    QVERIFY(drop(bench.window.charts(), table));
    bench.play_until(0.55);
    bench.pause();
    QTest::qWait(200);
    auto* energy = bench.window.charts().findChild<LiveChart*>("energy");
    auto* strain = bench.window.charts().findChild<LiveChart*>("strain");
    QVERIFY(energy->scene().curves().measured().size() > 10);
    QVERIFY(strain->scene().curves().measured().isEmpty());
    bench.panel().choices().choose(StudyChoices::Kind::sweep);
    QTest::qWait(200);
    QVERIFY(energy->scene().curves().measured().isEmpty());
  }

  void a_fit_without_a_parameter_says_what_is_missing() {
    StudiesBench bench(scene_);
    QVERIFY(drop(bench.window.charts(), folder_.filePath("swing.csv")));
    bench.push("startStudy");
    QVERIFY(!bench.panel().isRunning());
    QVERIFY(bench.part<QLabel>("studyLine")->text().contains("at least one parameter"));
  }

  /// The friction of a ball that the cloth never touches.
  void what_the_data_do_not_see_is_not_called_identified() {
    StudiesBench bench(scene_);
    LabDocument& document = bench.window.document();
    QVERIFY(document.addBlock("sphere"));
    QCOMPARE(document.setParameter("obstacles.0.center", cloth::Vec3(0, -50, 0)), QString());
    QVERIFY(drop(bench.window.charts(), folder_.filePath("swing.csv")));
    document.varied().add("obstacles.0.friction");
    QTest::qWait(100);
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning() && bench.panel().fitted(), 120000);
    QVERIFY(!bench.panel().fitted()->account.result.all_identified());
    QTRY_VERIFY_WITH_TIMEOUT(bench.part<QLabel>("fitValues")->text().contains("not seen"), patience);
  }

  void a_bad_table_gives_one_clear_message_data() {
    QTest::addColumn<QByteArray>("text");
    QTest::addColumn<QString>("says");
    QTest::newRow("a word") << QByteArray("time_s,kinetic_J\n0.1,2\n0.2,high\n")
                            << "row 2, column kinetic_J: “high” is not a number";
    QTest::newRow("a short row") << QByteArray("time_s,kinetic_J\n0.1,2\n0.2\n") << "row 2 has 1 fields";
    QTest::newRow("no header") << QByteArray("0.1,2\n0.2,3\n") << "must name the columns";
    QTest::newRow("one column") << QByteArray("time_s\n0.1\n") << "at least two columns";
    QTest::newRow("empty") << QByteArray() << "at least two columns";
    QTest::newRow("one row") << QByteArray("time_s,kinetic_J\n0.1,2\n") << "at least two rows";
  }
  void a_bad_table_gives_one_clear_message() {
    QFETCH(const QByteArray, text);
    QFETCH(const QString, says);
    const QString file = folder_.filePath("bad.csv");
    std::ofstream(file.toStdString()) << text.toStdString();
    StudiesBench bench(scene_);
    QVERIFY(drop(bench.window.charts(), file));
    auto* problem = bench.part<QLabel>("fitProblem");
    QVERIFY(problem->isVisible());
    QVERIFY2(problem->text().startsWith("bad.csv") && problem->text().contains(says),
             qPrintable(problem->text()));
    QVERIFY(!bench.panel().choices().fit().hasTable());
  }

  void semicolons_and_decimal_commas_are_read() {
    const QString file = folder_.filePath("comma.csv");
    std::ofstream(file.toStdString()) << "# from the lab\nZeit;time s;W\n1;0,1;2,5\n2;0,2;3,5\n";
    const auto read = read_measured_table(file);
    const auto* table = std::get_if<MeasuredTable>(&read);
    QVERIFY(table);
    QCOMPARE(table->columns[2][1], 3.5);
    QCOMPARE(likely_time_column(*table), 1u);
  }

  void the_menu_opens_the_form_for_those_without_a_mouse() {
    WindowBench bench(scene_);
    bench.action("fitTo")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(bench.window.studies().isVisible(), patience);
    QCOMPARE(bench.window.studies().choices().kind(), StudyChoices::Kind::fit);
    QVERIFY(bench.window.studies().findChild<QPushButton*>("fitChoose")->hasFocus());
  }

 private:
  QTemporaryDir folder_;
  QString scene_;
};

const Listed listed{"fit_window_test", test_main<FitWindowTest>};

}  // namespace clothlab::test::fit_window_test

#include "fit_window_test.moc"
