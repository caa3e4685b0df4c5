// Fits in the window: a table of measured values dropped on a chart, its columns, the parameters to find, the
// values with their standard errors; and what is said of tables that are none.
#include <QComboBox>
#include <QDesktopServices>
#include <QDir>
#include <QDropEvent>
#include <QLabel>
#include <QMenu>
#include <QMimeData>
#include <QProcess>
#include <QUrl>
#include <fstream>

#include "charts/chart_panel.h"
#include "charts/live_chart.h"
#include "document/varied_ranges.h"
#include "listed_test.h"
#include "simulation/recorder.h"
#include "studies/fit_choices.h"
#include "studies/study_library.h"
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

/// In place of the desktop's browser and file manager.
class Opened : public QObject {
  Q_OBJECT
 public:
  QStringList paths;
 public Q_SLOTS:
  void open(const QUrl& url) { paths << url.toLocalFile(); }
};

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
    const auto* count = bench.panel().choices().fit().findChild<QSpinBox*>("rangeCount");
    QVERIFY(count && !count->isVisible());  // a range is bounds here
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning() && bench.panel().fitted(), 120000);
    const cloth::FitResult& result = bench.panel().fitted()->result;
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

  void a_fit_leaves_the_folder_that_the_command_line_makes() {
    const QString here = folder_.filePath("fitted"), there = folder_.filePath("fitted-by-command");
    fitInto(here);
    QVERIFY(recent_studies.list().contains(here));
    QProcess cli;
    cli.start(
        CLOTHLAB_CLI,
        {"identify", scene_, "--set", "springs.structural=50", "--vary",
         QStringLiteral("springs.structural:%1:%2").arg(range_.from, 0, 'g', 17).arg(range_.to, 0, 'g', 17),
         "--measured", folder_.filePath("swing.csv"), "--out", there});
    QVERIFY(cli.waitForFinished(120000));
    QVERIFY2(cli.exitCode() == 0, cli.readAllStandardError());
    const QStringList files{"fit-kinetic_J.svg", "fitted.scene.json", "identified.json", "parameters.csv",
                            "report.html",       "runs.jsonl",        "targets.csv"};
    for (const QString& folder : {here, there})
      QCOMPARE(QDir(folder).entryList(QDir::Files, QDir::Name), files);
    for (const char* file : {"parameters.csv", "targets.csv", "fit-kinetic_J.svg", "fitted.scene.json"})
      QVERIFY2(content(here, file) == content(there, file), file);
  }

  void a_folder_of_a_fit_opens_with_its_values_its_diagram_and_its_report() {
    StudiesBench bench(scene_);
    bench.panel().openFolder(folder_.filePath("fitted-by-command"));
    const cloth::FitAccount* fitted = bench.panel().fitted();
    QVERIFY(fitted);
    QVERIFY(bench.part<QLabel>("fitValues")->text().contains("identified"));
    const auto* curve = std::get_if<cloth::LinePlot>(&bench.plot().diagram());
    QVERIFY(curve && curve->series.size() == 2 && curve->series[1].points.size() > 10);
    bench.push("useFit");
    QCOMPARE(bench.window.document().scene().springs->structural, fitted->result.parameters[0].value);
    Opened opened;
    QDesktopServices::setUrlHandler("file", &opened, "open");
    choose_shown(bench, "openReport");
    choose_shown(bench, "showFolder");
    QDesktopServices::unsetUrlHandler("file");
    QCOMPARE(opened.paths, (QStringList{folder_.filePath("fitted-by-command/report.html"),
                                        folder_.filePath("fitted-by-command")}));
  }

  void a_fit_of_the_same_model_takes_the_runs_that_its_folder_has() {
    const QString folder = folder_.filePath("fitted");
    const auto runs = [&] {
      QList<QByteArray> lines = content(folder, "runs.jsonl").split('\n');
      std::sort(lines.begin(), lines.end());
      return lines;
    };
    const QList<QByteArray> before = runs();
    QVERIFY(before.size() > 5);
    fitInto(folder);
    QCOMPARE(runs(), before);
  }

  void a_folder_that_cannot_be_had_is_said_before_anything_is_run() {
    const QString folder = folder_.filePath("taken");
    QVERIFY(QDir().mkpath(folder));
    std::ofstream(QDir(folder).filePath("report.html").toStdString()) << "somebody's";
    StudiesBench bench(scene_);
    QVERIFY(drop(bench.window.charts(), folder_.filePath("swing.csv")));
    bench.window.document().varied().add("springs.structural");
    QTest::qWait(100);
    bench.type("studyFolder", folder);
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning(), patience);
    QTRY_VERIFY_WITH_TIMEOUT(bench.part<QLabel>("studyLine")->toolTip().contains("report.html"), patience);
    QVERIFY(!bench.panel().fitted());
    QCOMPARE(content(folder, "report.html"), QByteArray("somebody's"));
    QCOMPARE(QDir(folder).entryList(QDir::Files | QDir::Hidden).size(), 1);
  }

  void a_broken_index_of_a_fit_is_answered_with_place_and_rule_data() {
    QTest::addColumn<QByteArray>("from");
    QTest::addColumn<QByteArray>("to");
    QTest::addColumn<QString>("says");
    QTest::newRow("a verdict") << QByteArray("\"verdict\": \"identified\"")
                               << QByteArray("\"verdict\": \"sure\"") << "parameters.0.verdict";
    QTest::newRow("no targets") << QByteArray("\"targets\"") << QByteArray("\"others\"") << "targets";
    QTest::newRow("a format") << QByteArray("clothlab/fit/1") << QByteArray("clothlab/fit/7") << "format";
    QTest::newRow("cut off") << QByteArray("\"targets\": [") << QByteArray("\"targets\": [,")
                             << "is not JSON";
  }
  void a_broken_index_of_a_fit_is_answered_with_place_and_rule() {
    QFETCH(const QByteArray, from);
    QFETCH(const QByteArray, to);
    QFETCH(const QString, says);
    const QString folder = folder_.filePath("broken");
    QVERIFY(QDir().mkpath(folder));
    QByteArray text = content(folder_.filePath("fitted"), "identified.json");
    QVERIFY(text.contains(from));
    text.replace(text.indexOf(from), from.size(), to);
    std::ofstream(QDir(folder).filePath("identified.json").toStdString()) << text.toStdString();
    StudiesBench bench(scene_);
    bench.panel().openFolder(folder);
    QVERIFY(!bench.panel().fitted());
    const QString line = bench.part<QLabel>("studyLine")->toolTip();
    QVERIFY2(line.contains("identified.json") && line.contains(says), qPrintable(line));
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
    bench.type("studyFolder", folder_.filePath("friction"));
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning() && bench.panel().fitted(), 120000);
    QVERIFY(!bench.panel().fitted()->result.all_identified());
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
    QVERIFY(!bench.window.studies().findChild<QComboBox*>("fitTime")->isEnabled());  // of what table?
  }

 private:
  static QByteArray content(const QString& folder, const char* file) {
    QFile read(QDir(folder).filePath(file));
    return read.open(QIODevice::ReadOnly) ? read.readAll() : QByteArray("no ") + file;
  }
  /// The stiffness, from 50 N/m, to swing.csv.
  void fitInto(const QString& folder) {
    StudiesBench bench(scene_);
    bench.window.document().setParameter("springs.structural", 50.0);
    QVERIFY(drop(bench.window.charts(), folder_.filePath("swing.csv")));
    bench.window.document().varied().add("springs.structural");
    QTest::qWait(100);
    range_ = *bench.window.document().varied().find("springs.structural");
    bench.type("studyFolder", folder);
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(!bench.panel().isRunning() && bench.panel().fitted(), 120000);
    QTRY_VERIFY_WITH_TIMEOUT(bench.part<QLabel>("studyLine")->toolTip().contains(shown_path(folder)),
                             patience);
  }
  /// In the menu of the button with the folder.
  static void choose_shown(StudiesBench& bench, const char* entry) {
    QTimer::singleShot(200, [entry] {
      auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
      QVERIFY(menu);
      auto* action = menu->findChild<QAction*>(QLatin1String(entry));
      QVERIFY2(action && action->isEnabled(), entry);
      QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
    });
    QTest::mouseClick(bench.part<QToolButton>("openStudy"), Qt::LeftButton);
    QTest::qWait(50);
  }

  QTemporaryDir folder_;
  VariedRange range_;
  QString scene_;
};

const Listed listed{"fit_window_test", test_main<FitWindowTest>};

}  // namespace clothlab::test::fit_window_test

#include "fit_window_test.moc"
