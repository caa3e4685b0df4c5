// A user's story with studies: choose, start, watch, read, cancel, reopen, save, open a run.
#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTimer>
#include <QToolButton>

#include "listed_test.h"
#include "patience.h"
#include "studies_bench.h"
#include "study/study_runs.h"

namespace clothlab::test::studies_test {
namespace {

QByteArray content_of(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

QAction* action_named(const QMenu& menu, const QString& text) {
  for (QAction* action : menu.actions())
    if (action->text() == text) return action;
  return nullptr;
}

void click(QMenu& menu, QAction* action) {
  QTest::mouseClick(&menu, Qt::LeftButton, {}, menu.actionGeometry(action).center());
}

}  // namespace

class StudiesTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    QVERIFY(folder_.isValid());
  }

  void the_dock_is_hidden_until_it_is_asked_for_and_says_what_it_is_good_for() {
    WindowBench bench("pendulum");
    QVERIFY(!bench.window.studies().isVisible());
    bench.action("studies")->trigger();
    QVERIFY(bench.window.studies().isVisible());
    QVERIFY(bench.window.studies().findChild<QLabel*>("studyEmpty")->isVisible());
  }

  void a_stability_map_runs_fills_and_is_kept() {
    StudiesBench bench("pendulum");
    const QString folder = folder_.filePath("map");
    bench.prepare_small_map(folder);
    bench.push("startStudy");
    QVERIFY(!bench.part<QPushButton>("startStudy")->isEnabled() || !bench.panel().isRunning());
    bench.wait_for_end();
    QVERIFY(bench.panel().table());
    QCOMPARE(cloth::finished_runs(*bench.panel().table()), 2 * 3 * 2);
    QVERIFY(cloth::is_complete(*bench.panel().table()));
    QVERIFY(QFile::exists(folder + "/stability.csv"));
    QVERIFY(cloth::read_study(folder.toStdString()).study);
  }

  void resting_the_pointer_on_a_cell_names_it_and_a_double_click_opens_it() {
    StudiesBench bench("pendulum");
    bench.panel().openFolder(folder_.filePath("map"));
    QVERIFY(bench.panel().table());
    QTest::qWait(50);
    const QPoint at = bench.plot().placeOf(7).center().toPoint();  // the second cell of the second method
    QVERIFY(bench.plot().rect().contains(at));
    QSignalSpy hovered(&bench.plot(), &StudyPlot::runHovered);
    QTest::mouseMove(&bench.plot(), {1, 1});  // the pointer may rest there already: then it would not move
    QTest::mouseMove(&bench.plot(), at);
    QTRY_VERIFY_WITH_TIMEOUT(!hovered.isEmpty(), patience);
    const QString said = hovered.back().front().toString();
    QVERIFY2(said.contains("Runge-Kutta") && said.contains("Time step") && said.contains("steps"),
             qPrintable(said));

    const auto run = cloth::run_of(*bench.panel().table(), 7);
    QTest::mouseDClick(&bench.plot(), Qt::LeftButton, {}, at);
    bench.settle();
    QCOMPARE(bench.window.document().scene().integrator.method, std::string("rk4"));
    QCOMPARE(bench.window.document().scene().integrator.time_step, run->scene.integrator.time_step);
    QVERIFY(bench.window.document().scene() == run->scene);
  }

  void work_precision_runs_beside_the_simulation_and_its_points_can_be_opened() {
    StudiesBench bench("pendulum");
    bench.choose(StudyChoices::Kind::work_precision);
    bench.only({"verlet", "rk4"});
    bench.type("horizon", "0.2");
    bench.type("studyFolder", folder_.filePath("precision"));
    bench.play_until(0.01);
    bench.push("startStudy");
    bench.wait_for_end();
    QVERIFY(bench.status().playing);
    const double time = bench.status().time;
    bench.play_until(time + 0.05);
    const auto& study = std::get<cloth::WorkPrecision>(*bench.panel().table());
    QCOMPARE(study.methods.size(), 2u);
    QVERIFY(!study.stopped);
    const auto& runs = study.methods.front().runs;
    int run = 0;
    while (!runs[static_cast<std::size_t>(run)].reached_horizon()) ++run;
    QTest::qWait(50);
    const QPoint at = bench.plot().placeOf(run).center().toPoint();
    QTest::mouseDClick(&bench.plot(), Qt::LeftButton, {}, at);
    bench.settle();
    QCOMPARE(bench.window.document().scene().integrator.method, study.methods.front().ladder.facts.name);
    QVERIFY(bench.window.document().title().contains("Verlet"));
  }

  void cancelling_keeps_what_is_finished_and_the_folder_opens_again() {
    StudiesBench bench("corners-free");
    const QString folder = folder_.filePath("cancelled");
    bench.prepare_small_map(folder);
    bench.part<QWidget>("xAxis")->findChild<QSpinBox*>("count")->setValue(40);
    bench.part<QWidget>("yAxis")->findChild<QSpinBox*>("count")->setValue(20);
    bench.part<QSpinBox>("periods")->setValue(1000);
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(bench.panel().table() && cloth::finished_runs(*bench.panel().table()) > 0,
                             120000);
    QVERIFY(bench.part<QProgressBar>("studyProgress")->isVisible());
    bench.push("cancelStudy");
    bench.wait_for_end();
    const int finished = cloth::finished_runs(*bench.panel().table());
    QVERIFY(finished > 0 && finished < 2 * 40 * 20);
    const QByteArray csv = content_of(folder + "/stability.csv");
    bench.panel().openFolder(folder);
    QCOMPARE(cloth::finished_runs(*bench.panel().table()), finished);
    QCOMPARE(QByteArray::fromStdString(cloth::study_csv(*bench.panel().table())), csv);
  }

  void extremes_of_the_scene_are_a_table_of_methods_over_cases() {
    StudiesBench bench("pendulum");
    bench.choose(StudyChoices::Kind::extremes);
    bench.only({"verlet"});
    bench.type("studyFolder", folder_.filePath("extremes"));
    bench.push("startStudy");
    bench.wait_for_end();
    const auto& table = std::get<cloth::ExtremesTable>(*bench.panel().table());
    QVERIFY(table.is_complete());
    QTest::qWait(50);
    QVERIFY(!bench.plot().placeOf(0).isEmpty());
  }

  void outputs_of_a_convergence_study_are_chosen_in_a_menu() {
    StudiesBench bench("corners-free");
    bench.choose(StudyChoices::Kind::convergence);
    auto* line = bench.part<QLineEdit>("outputNames");
    QCOMPARE(line->placeholderText(), QString("lowest_point, elastic_J"));
    auto* button = bench.part<QToolButton>("addOutput");
    bool was_open = false;
    QTimer::singleShot(300, button, [&] {
      auto* menu = bench.part<QMenu>("outputMenu");
      QAction* kinetic = action_named(*menu, "kinetic (J)");
      was_open = menu->isVisible() && kinetic && kinetic->menu();
      if (!was_open) return;
      click(*menu, kinetic);
      if (QTest::qWaitFor([&] { return kinetic->menu()->isVisible(); }))
        click(*kinetic->menu(), action_named(*kinetic->menu(), "Largest"));
    });
    QTest::mouseClick(button, Qt::LeftButton);
    QTRY_COMPARE_WITH_TIMEOUT(line->text(), QString("kinetic_J:max"), patience);
    QVERIFY(was_open);
  }

  void grid_convergence_shows_values_and_errors_and_opens_a_grid() {
    StudiesBench bench("corners-free");
    bench.choose(StudyChoices::Kind::convergence);
    QVERIFY(!bench.part<QListWidget>("studyMethods")->isVisible());
    bench.type("cells", "4, 8, 16");
    bench.type("outputNames", "max_strain:max, elastic_J");
    bench.type("studyTime", "0.1");
    bench.type("studyFolder", folder_.filePath("convergence"));
    bench.push("startStudy");
    bench.wait_for_end();
    const auto& study = std::get<cloth::GridConvergence>(*bench.panel().table());
    QVERIFY(study.is_complete());
    QCOMPARE(study.cells, (std::vector<int>{4, 8, 16}));
    QVERIFY(!bench.part<QLabel>("studyEarlier")->isVisible());
    QVERIFY(cloth::read_study(folder_.filePath("convergence").toStdString()).study);

    const QString said = bench.part<QLabel>("studyLine")->toolTip();
    QVERIFY2(said.contains("3 runs") && said.contains("elastic (J): "), qPrintable(said));

    auto* which = bench.part<QComboBox>("against");
    QVERIFY(which->isVisible());
    QCOMPARE(which->count(), 2);
    const auto title = [&] { return std::get<cloth::LinePlot>(bench.plot().diagram()).title; };
    QCOMPARE(title(), std::string("Value against cell size"));
    QTest::qWait(50);
    const QPoint at = bench.plot().placeOf(1).center().toPoint();
    QTest::keyClick(which, Qt::Key_Down);
    QCOMPARE(title(), std::string("Error against cell size"));
    QTest::keyClick(which, Qt::Key_Up);
    QTest::mouseDClick(&bench.plot(), Qt::LeftButton, {}, at);
    bench.settle();
    QCOMPARE(bench.window.document().scene().cloth.columns, 9);
    QCOMPARE(bench.window.document().scene().integrator.time_step, study.runs[1].time_step);
  }

  void a_convergence_study_that_cannot_be_made_says_why() {
    StudiesBench bench("corners-free");
    bench.choose(StudyChoices::Kind::convergence);
    auto* line = bench.part<QLabel>("studyLine");
    const auto says = [&](const char* field, const QString& text, const QString& rule) {
      bench.type(field, text);
      bench.push("startStudy");
      const bool is_said = !bench.panel().isRunning() && line->toolTip().contains(rule);
      bench.part<QLineEdit>(field)->clear();
      return is_said;
    };
    QVERIFY(says("cells", "8, x", "Cells: \"8, x\" must be whole numbers"));
    QVERIFY(says("cells", "16, 8", "Cells: 8: must be more than 16"));
    QVERIFY(says("outputNames", "speed", "Outputs: speed: must be one of"));
    QVERIFY(says("studyTime", "soon", "Time: \"soon\" must be a time in s"));
  }

  void iterations_of_a_step_are_drawn_against_their_number_and_their_time() {
    StudiesBench bench("corners-free");
    bench.window.document().setParameter("cloth.columns", std::int64_t{7});
    bench.window.document().setParameter("cloth.rows", std::int64_t{7});
    bench.choose(StudyChoices::Kind::iterations);
    auto* methods = bench.part<QListWidget>("studyMethods");
    QStringList offered;
    for (int row = 0; row < methods->count(); ++row)
      if (!methods->item(row)->isHidden()) offered << methods->item(row)->data(Qt::UserRole).toString();
    offered.sort();
    QCOMPARE(offered, (QStringList{"implicit-euler", "projective", "vbd", "xpbd"}));
    bench.only({"implicit-euler", "vbd"});
    bench.type("iteratedStep", "5 ms");
    bench.type("iteratedTime", "0.05");
    bench.part<QSpinBox>("mostIterations")->setValue(8);
    const QString folder = folder_.filePath("iterations");
    bench.type("studyFolder", folder);
    bench.push("startStudy");
    bench.wait_for_end();
    const auto& study = std::get<cloth::IterationsStudy>(*bench.panel().table());
    QVERIFY(study.is_complete());
    QCOMPARE(study.asked, (std::vector<std::string>{"implicit-euler", "vbd"}));
    QCOMPARE(study.step, 0.005);
    QVERIFY(!bench.part<QLabel>("studyEarlier")->isVisible());
    QVERIFY(cloth::read_study(folder.toStdString()).study);
    for (const char* file : {"iterations.csv", "iterations.svg", "iterations_time.svg", "report.html"})
      QVERIFY2(QFileInfo::exists(QDir(folder).filePath(file)), file);
    auto* which = bench.part<QComboBox>("against");
    const auto label = [&] { return std::get<cloth::LinePlot>(bench.plot().diagram()).x.label; };
    QCOMPARE(label(), std::string("iterations"));
    QTest::keyClick(which, Qt::Key_Down);
    QCOMPARE(label(), std::string("time of the step"));
    QTest::qWait(50);
    const int run = static_cast<int>(study.methods[0].steps.size()) + 2;  // of VBD, the third
    QTest::mouseDClick(&bench.plot(), Qt::LeftButton, {}, bench.plot().placeOf(run).center().toPoint());
    bench.settle();
    const cloth::IntegratorChoice& opened = bench.window.document().scene().integrator;
    QCOMPARE(opened.method, std::string("vbd"));
    QCOMPARE(opened.vbd_iterations, study.methods[1].steps[2].iterations);
    QCOMPARE(opened.time_step, 0.005);
  }

  void iterations_that_cannot_be_studied_say_why() {
    StudiesBench bench("corners-free");
    bench.choose(StudyChoices::Kind::iterations);
    auto* line = bench.part<QLabel>("studyLine");
    bench.type("iteratedStep", "soon");
    bench.push("startStudy");
    QVERIFY(!bench.panel().isRunning() && line->toolTip().contains("Step: \"soon\" must be a time in s"));
    bench.part<QLineEdit>("iteratedStep")->clear();
    bench.only({});
    bench.push("startStudy");
    QVERIFY(!bench.panel().isRunning() && line->toolTip().contains("at least one method"));
  }

  void every_format_is_saved() {
    StudiesBench bench("pendulum");
    for (const QString name : {"map", "precision", "extremes", "convergence", "iterations"}) {
      bench.panel().openFolder(folder_.filePath(name));
      const QString base = folder_.filePath("saved-" + name);
      for (const QString ending : {".svg", ".png", ".pdf", ".csv"})
        QCOMPARE(bench.panel().save(base + ending), QString());
      QVERIFY(content_of(base + ".svg").startsWith("<svg"));
      QVERIFY(content_of(base + ".pdf").startsWith("%PDF"));
      QVERIFY(QImage(base + ".png").width() >= 960);
      QCOMPARE(content_of(base + ".csv"),
               QByteArray::fromStdString(cloth::study_csv(*bench.panel().table())));
      QVERIFY(!bench.panel().save("/nowhere/at/all.svg").isEmpty());
    }
  }

  void what_cannot_be_run_or_opened_is_said() {
    StudiesBench bench("pendulum");
    auto* line = bench.part<QLabel>("studyLine");
    bench.panel().openFolder(folder_.filePath("not-there"));
    QVERIFY(line->toolTip().contains("study.json"));
    bench.choose(StudyChoices::Kind::stability);
    auto* low = bench.part<QWidget>("xAxis")->findChild<QLineEdit*>("low");
    low->setText("-1");
    bench.push("startStudy");
    QVERIFY(!bench.panel().isRunning());
    QVERIFY2(line->toolTip().contains("integrator.time_step"), qPrintable(line->toolTip()));
  }

  void closing_the_window_asks_once_and_loses_nothing_finished() {
    const QString folder = folder_.filePath("closed");
    {
      StudiesBench bench("corners-free");
      bench.prepare_small_map(folder);
      bench.part<QWidget>("xAxis")->findChild<QSpinBox*>("count")->setValue(40);
      bench.part<QWidget>("yAxis")->findChild<QSpinBox*>("count")->setValue(20);
      bench.part<QSpinBox>("periods")->setValue(1000);
      bench.push("startStudy");
      QTRY_VERIFY_WITH_TIMEOUT(bench.panel().table() && cloth::finished_runs(*bench.panel().table()) > 0,
                               120000);
      int asked = 0;
      const auto answer = [&](QMessageBox::StandardButton button) {
        QTimer::singleShot(200, &bench.window, [&asked, button] {
          auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
          if (!box) return;
          ++asked;
          QTest::mouseClick(box->button(button), Qt::LeftButton);
        });
      };
      answer(QMessageBox::Cancel);
      QVERIFY(!bench.window.close());
      QVERIFY(bench.panel().isRunning());
      answer(QMessageBox::Close);
      QVERIFY(bench.window.close());
      QCOMPARE(asked, 2);
      QVERIFY(!bench.panel().isRunning());
    }
    const cloth::StudyReading reading = cloth::read_study(folder.toStdString());
    QVERIFY2(reading.study, reading.problem.c_str());
    QVERIFY(cloth::finished_runs(reading.study->table) > 0);
  }

 private:
  QTemporaryDir folder_;
};

const Listed listed{"studies_test", test_main<StudiesTest>};

}  // namespace clothlab::test::studies_test

#include "studies_test.moc"
