// Materials against exact solutions in the Studies dock: chosen by clicks, run, drawn, kept, opened again.
#include <QComboBox>
#include <QFile>
#include <QLabel>
#include <QListWidget>
#include <QProcess>

#include "listed_test.h"
#include "patience.h"
#include "studies_bench.h"
#include "study/study_runs.h"

namespace clothlab::test::studies_validation_test {
namespace {

QByteArray content_of(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

class ValidationBench : public StudiesBench {
 public:
  ValidationBench() : StudiesBench("pendulum") { choose(StudyChoices::Kind::validation); }

  void measure(const QStringList& protocols, const QString& folder) {
    only(protocols, "studyProtocols");
    type("studyFolder", folder);
    push("startStudy");
    wait_for_end();
  }
  /// By the keys of the box above the diagram.
  cloth::LinePlot diagram(int which) {
    auto* box = part<QComboBox>("against");
    QTest::keyClick(box, Qt::Key_Home);
    for (int k = 0; k < which; ++k) QTest::keyClick(box, Qt::Key_Down);
    return std::get<cloth::LinePlot>(plot().diagram());
  }
  QString line() { return part<QLabel>("studyLine")->toolTip(); }
};

}  // namespace

class StudiesValidationTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    QVERIFY(folder_.isValid());
  }

  void it_asks_for_protocols_and_not_for_methods() {
    ValidationBench bench;
    auto* protocols = bench.part<QListWidget>("studyProtocols");
    QVERIFY(protocols->isVisible());
    QCOMPARE(static_cast<std::size_t>(protocols->count()), cloth::validation_protocols().size());
    QVERIFY(!bench.part<QListWidget>("studyMethods")->isVisible());
    bench.only({}, "studyProtocols");
    bench.push("startStudy");
    QVERIFY(!bench.panel().isRunning());
    QCOMPARE(bench.line(), QString("Choose at least one protocol."));
  }

  void chosen_protocols_are_measured_and_drawn_as_errors_and_curves() {
    ValidationBench bench;
    bench.measure({"catenary", "picture-frame", "astm-d1388"}, folder());
    const auto& study = std::get<cloth::ValidationStudy>(*bench.panel().table());
    QVERIFY(study.is_complete());
    QCOMPARE(study.protocols, (std::vector<std::string>{"catenary", "astm-d1388", "picture-frame"}));
    QVERIFY(!bench.part<QLabel>("studyEarlier")->isVisible());
    QTRY_VERIFY2_WITH_TIMEOUT(
        bench.line().contains("9 runs") && bench.line().contains("All that is promised holds"),
        qPrintable(bench.line()), patience);

    QCOMPARE(bench.part<QComboBox>("against")->count(), 5);    // all, catenary twice, the others' errors
    QCOMPARE(bench.diagram(0).series.size(), std::size_t(2));  // rounding is not drawn with errors of grids
    const cloth::LinePlot errors = bench.diagram(1), curves = bench.diagram(2);
    QCOMPARE(errors.series.size(), std::size_t(3));
    for (const cloth::PlotSeries& series : errors.series) QCOMPARE(series.points.size(), std::size_t(4));
    QCOMPARE(curves.series.size(), std::size_t(6));
    QCOMPARE(curves.series[1].points.size(), std::size_t(21));
    for (const cloth::PlotPoint& found : curves.series[1].points)  // beside the exact curve of the same span
      QVERIFY(std::any_of(
          curves.series[0].points.begin(), curves.series[0].points.end(),
          [&](const auto& exact) { return std::hypot(exact.x - found.x, exact.y - found.y) < 0.01; }));
  }

  void its_folder_is_the_command_lines_and_is_opened_again() {
    ValidationBench bench;
    bench.panel().openFolder(folder());
    QVERIFY(bench.panel().table());
    QVERIFY(cloth::is_complete(*bench.panel().table()));
    QCOMPARE(cloth::finished_runs(*bench.panel().table()), 9);
    QCOMPARE(bench.diagram(2).series[1].points.size(), std::size_t(21));
    QVERIFY(bench.part<QLabel>("studyEarlier")->isVisible());  // all protocols are checked now
    QProcess command;
    command.start(CLOTHLAB_CLI, {"study", folder(), "--csv"});
    QVERIFY(command.waitForFinished());
    QCOMPARE(command.readAllStandardOutput(), content_of(folder() + "/validation.csv"));

    const QString other = folder_.filePath("by-the-command-line");
    command.start(CLOTHLAB_CLI, {"validate", "--only", "catenary,picture-frame,astm-d1388", "--out", other});
    QVERIFY(command.waitForFinished(60000));
    QCOMPARE(command.exitCode(), 0);
    bench.panel().openFolder(other);
    QCOMPARE(cloth::finished_runs(*bench.panel().table()), 9);
    for (const QString ending : {".svg", ".png", ".csv"})
      QCOMPARE(bench.panel().save(folder_.filePath("saved" + ending)), QString());
    QVERIFY(content_of(folder_.filePath("saved.svg")).startsWith("<svg"));
  }

  void a_cantilever_is_opened_in_the_view_by_a_double_click() {
    ValidationBench bench;
    bench.measure({"cantilever"}, folder_.filePath("cantilever"));
    bench.diagram(1);
    QTest::qWait(50);
    const QPoint at = bench.plot().placeOf(3).center().toPoint();
    QVERIFY(bench.plot().rect().contains(at));
    QTest::mouseDClick(&bench.plot(), Qt::LeftButton, {}, at);
    bench.settle();
    QVERIFY(bench.window.document().title().contains("cantilever"));
    QVERIFY(bench.window.document().scene().material);
  }

  void what_is_finished_when_it_is_cancelled_is_kept_and_gone_on_with() {
    ValidationBench bench;
    bench.only({"cantilever", "swing"}, "studyProtocols");
    bench.type("studyFolder", folder_.filePath("cancelled"));
    bench.push("startStudy");
    QTRY_VERIFY_WITH_TIMEOUT(bench.panel().table() && cloth::finished_runs(*bench.panel().table()) > 0,
                             60000);
    bench.push("cancelStudy");
    bench.wait_for_end();
    const int finished = cloth::finished_runs(*bench.panel().table());
    QVERIFY(finished > 0 && finished < 12);
    bench.panel().openFolder(folder_.filePath("cancelled"));
    QVERIFY(!cloth::is_complete(*bench.panel().table()));
    QCOMPARE(cloth::finished_runs(*bench.panel().table()), finished);
    bench.push("startStudy");
    bench.wait_for_end();
    QVERIFY(cloth::is_complete(*bench.panel().table()));
  }

 private:
  QString folder() const { return folder_.filePath("validation"); }
  QTemporaryDir folder_;
};

const Listed listed{"studies_validation_test", test_main<StudiesValidationTest>};

}  // namespace clothlab::test::studies_validation_test

#include "studies_validation_test.moc"
