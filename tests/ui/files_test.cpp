// Opening, saving and quitting, as a user does it: every type of file, in both windows.
#include <QDir>
#include <QDropEvent>
#include <QFile>
#include <QLabel>
#include <QMimeData>

#include "compare/comparison_json.h"
#include "compare_bench.h"
#include "dialogs.h"
#include "listed_test.h"
#include "main_window/lab_files.h"
#include "patience.h"
#include "scene/builtin_scenes.h"
#include "studies/studies_panel.h"
#include "study/study_recorder.h"
#include "study/study_runs.h"
#include "support/small_studies.h"
#include "window_bench.h"

namespace clothlab::test::files_test {
namespace {

const char* const two_triangles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";
const char* const with_errors =
    "{\"scene\":\n {\"cloth\": {\"rows\": 1}},\n \"panes\": [{}, {\"own\": {\"springs.shear\": -1}}]}";
const char* const of_a_mesh =
    "{\"scene\": {\"cloth\": {\"mesh\": \"sheet.obj\"}, \"duration\": 0.1},\n"
    " \"panes\": [{}, {\"own\": {\"integrator.method\": \"rk4\"}}], \"reference\": \"A\"}";

QByteArray content_of(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

void write(const QString& path, const QByteArray& content) {
  QDir().mkpath(QFileInfo(path).path());
  QFile file(path);
  if (!file.open(QIODevice::WriteOnly) || file.write(content) != content.size()) qFatal("not written");
}

void write_small_study(const QString& folder) {
  cloth::Scene scene = cloth::builtin_scene("corners-free");
  scene.cloth.rows = scene.cloth.columns = 5;
  const cloth::StabilityMap map = cloth::run_stability_map(scene, cloth::test::small_map(scene));
  if (cloth::StudyRecorder::write(folder.toStdString(), map, "a command", 1)) qFatal("not written");
}

void drop(QWidget& on, const QString& path) {
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(path)});
  const QPoint at = on.rect().center();
  QDragEnterEvent enter(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&on, &enter);
  if (!enter.isAccepted()) return;
  QDropEvent drop(at, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&on, &drop);
}

/// To the window, which a dialog may just have covered.
void press(QWidget& window, Qt::Key key, Qt::KeyboardModifiers modifiers) {
  window.activateWindow();
  if (!QTest::qWaitForWindowActive(&window, patience)) qFatal("the window was never active");
  QTest::keyClick(&window, key, modifiers);
}

/// The shown windows but for one.
std::vector<LabWindow*> others(const LabWindow* known = nullptr) {
  std::vector<LabWindow*> windows = LabWindow::all();
  std::erase_if(windows, [known](LabWindow* window) { return window == known || !window->isVisible(); });
  return windows;
}

/// The only one.
LabWindow* other(const LabWindow* known = nullptr) {
  const auto windows = others(known);
  return windows.size() == 1 ? windows.front() : nullptr;
}

}  // namespace

class FilesTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    QApplication::setQuitOnLastWindowClosed(false);
    apply_theme(*qApp, false);
  }

  void init() { folder_ = std::make_unique<QTemporaryDir>(); }

  /// Windows that a test opened.
  void cleanup() {
    for (LabWindow* window : LabWindow::all()) delete window;
  }

  void a_comparison_with_errors_is_one_message_and_loses_nothing() {
    write(path("bad.compare.json"), with_errors);
    WindowBench bench("corners-free");
    bench.window.document().setParameter("springs.structural", 123.0);
    const auto is_said = [](LabWindow& window) {
      const QString text = window.notice().text();
      return text.contains("bad.compare.json:2:") && text.contains("scene.cloth.rows = 1: must be >= 2") &&
             text.count("was not opened") == 1;
    };
    Answers answers;
    answers.type(path("bad.compare.json"));
    press(bench.window, Qt::Key_O, Qt::ControlModifier);
    QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    QVERIFY2(is_said(bench.window), qPrintable(bench.window.notice().text()));
    QVERIFY(others(&bench.window).empty());
    QVERIFY(bench.window.document().isModified());
    QCOMPARE(bench.window.document().scene().springs->structural, 123.0);

    open_first_window(path("bad.compare.json"));  // as the program does
    auto* first = other(&bench.window);
    QVERIFY(first);
    QVERIFY(is_said(*first));
    QCOMPARE(first->document().scene(), cloth::builtin_scene(cloth::default_scene_name));
  }

  void a_comparison_stays_where_another_has_errors() {
    write(path("bad.compare.json"), with_errors);
    CompareBench bench;
    const cloth::Comparison before = bench.comparison();
    drop(bench.window, path("bad.compare.json"));
    QVERIFY2(bench.window.notice().text().contains("scene.cloth.rows = 1"),
             qPrintable(bench.window.notice().text()));
    QCOMPARE(bench.comparison(), before);
    bench.choose(0, "duplicate");
    QCOMPARE(bench.window.panes().paneCount(), std::size_t{3});
  }

  void every_file_is_asked_about_by_its_final_name_data() {
    QTest::addColumn<int>("key");
    QTest::addColumn<int>("modifiers");
    QTest::addColumn<QString>("ending");
    QTest::newRow("scene") << int(Qt::Key_S) << int(Qt::ControlModifier | Qt::ShiftModifier) << ".scene.json";
    QTest::newRow("session") << int(Qt::Key_S) << int(Qt::ControlModifier | Qt::AltModifier)
                             << ".session.json";
    QTest::newRow("picture") << int(Qt::Key_P) << int(Qt::ControlModifier) << ".png";
    QTest::newRow("cloth") << int(Qt::Key_O) << int(Qt::ControlModifier | Qt::ShiftModifier) << ".obj";
    QTest::newRow("charts") << int(Qt::Key_P) << int(Qt::ControlModifier | Qt::ShiftModifier) << ".png";
  }

  void every_file_is_asked_about_by_its_final_name() {
    QFETCH(int, key);
    QFETCH(int, modifiers);
    QFETCH(QString, ending);
    WindowBench bench("corners-free");
    bench.play_until(0.02);
    bench.pause();
    const auto save = [&] {
      press(bench.window, Qt::Key(key), Qt::KeyboardModifiers(modifiers));
      bench.settle();
    };
    check_saving(bench.window, ending, save, [&] { return bench.window.notice().text(); });
  }

  void so_are_comparisons_and_their_charts() {
    CompareBench bench;
    const auto text = [&] { return bench.window.notice().text(); };
    check_saving(
        bench.window, ".compare.json",
        [&] { press(bench.window, Qt::Key_S, Qt::ControlModifier | Qt::ShiftModifier); }, text);
    check_saving(
        bench.window, ".png",
        [&] { press(bench.window, Qt::Key_P, Qt::ControlModifier | Qt::ShiftModifier); }, text);
  }

  void so_are_studies() {
    write_small_study(path("study"));
    WindowBench bench("corners-free");
    drop(bench.window, path("study"));
    auto* save = bench.window.studies().findChild<QToolButton*>("saveStudy");
    QVERIFY(save && save->isVisible() && save->isEnabled());
    check_saving(
        bench.window, ".svg", [&] { QTest::mouseClick(save, Qt::LeftButton); },
        [&] { return bench.window.studies().findChild<QLabel*>("studyLine")->toolTip(); });
  }

  void a_number_with_a_point_is_no_ending() {
    WindowBench bench("corners-free");
    Answers answers;
    answers.type(path("wind 0.5"));
    press(bench.window, Qt::Key_S, Qt::ControlModifier | Qt::ShiftModifier);
    QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    QVERIFY(QFile::exists(path("wind 0.5.scene.json")));
  }

  void a_comparison_saved_elsewhere_keeps_its_meshes() {
    write(path("in/sheet.obj"), two_triangles);
    write(path("in/x.compare.json"), of_a_mesh);
    QDir().mkpath(path("out/deep"));
    CompareBench bench;
    bench.window.open(path("in/x.compare.json"));
    bench.settle();
    QCOMPARE(bench.window.notice().text(), QString());
    Answers answers;
    answers.type(path("out/deep/y.compare.json"));
    press(bench.window, Qt::Key_S, Qt::ControlModifier | Qt::ShiftModifier);
    QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    CompareBench again;
    again.window.open(path("out/deep/y.compare.json"));
    again.settle();
    QVERIFY2(again.window.notice().text().isEmpty(), qPrintable(again.window.notice().text()));
    const cloth::MeshChoice& mesh = again.comparison().scene.cloth.mesh;
    QCOMPARE(mesh.file, std::string("../../in/sheet.obj"));
    QCOMPARE(mesh.loaded->hash, bench.comparison().scene.cloth.mesh.loaded->hash);
    QVERIFY(again.status().refusal.empty());
  }

  void a_scene_gives_way_to_every_type() {
    write(path("sheet.obj"), two_triangles);
    write(path("x.compare.json"), of_a_mesh);
    write(path("results/comparison.json"),
          QByteArray::fromStdString(cloth::write_comparison(small_comparison())));
    write_small_study(path("study"));
    WindowBench bench("corners-free");
    const auto open = [&](const QString& name) {
      Answers answers;
      answers.type(name);
      press(bench.window, Qt::Key_O, Qt::ControlModifier);
      bench.settle();
      return answers.came_true();
    };
    QVERIFY(open(path("sheet.obj")));
    QCOMPARE(int(bench.window.document().scene().cloth.mesh.loaded->surface.vertices.size()), 4);
    QCOMPARE(bench.window.document().undoStack().count(), 1);
    QVERIFY(open(path("study/study.json")));
    QVERIFY(bench.window.studies().isVisible() && bench.window.studies().table());
    QVERIFY(bench.window.document().isModified());  // nothing of it was lost
    for (const char* name : {"x.compare.json", "results/comparison.json"}) {
      QVERIFY(open(path(name)));
      QCOMPARE(bench.window.document().paneCount(), std::size_t{2});
      QCOMPARE(bench.window.panes().paneCount(), std::size_t{2});
      QVERIFY(bench.window.ranking().isVisible() && bench.window.paneCharts().isVisible());
    }
    QVERIFY(others(&bench.window).empty());
  }

  void a_comparison_gives_way_to_every_type() {
    write(path("sheet.obj"), two_triangles);
    write(path("x.scene.json"), "{\"cloth\": {\"rows\": 7, \"columns\": 5}}");
    write_small_study(path("study"));
    CompareBench bench;
    const cloth::Comparison before = bench.comparison();
    drop(bench.window, path("study"));
    QVERIFY(bench.window.studies().isVisible() && bench.window.studies().table());
    QCOMPARE(bench.comparison(), before);
    bench.scope(2);
    drop(bench.window, path("sheet.obj"));
    QVERIFY2(bench.comparison().scene.cloth.is_mesh(), qPrintable(bench.window.notice().text()));
    bench.settle();
    QVERIFY(bench.status().refusal.empty());
    bench.action("undo")->trigger();
    QCOMPARE(bench.comparison(), before);
    drop(bench.window, path("x.scene.json"));
    bench.settle();
    QCOMPARE(bench.window.document().paneCount(), std::size_t{1});
    QCOMPARE(bench.window.document().scene().cloth.rows, 7);
    QCOMPARE(bench.window.view().frame()->rows, 7);
    QVERIFY(bench.window.charts().isVisible() && !bench.window.ranking().isVisible());
    QVERIFY(others(&bench.window).empty());
  }

  void a_session_opens_from_a_comparison() {
    WindowBench bench("corners-free");
    bench.play_until(0.02);
    bench.pause();
    bench.window.saveSession(path("run.session.json"));
    bench.settle();
    CompareBench compare;
    drop(compare.window, path("run.session.json"));
    QTRY_VERIFY_WITH_TIMEOUT(compare.window.notice().text().contains("to the bit"), 20000);
  }

  void the_program_begins_with_every_type() {
    write(path("sheet.obj"), two_triangles);
    write(path("x.compare.json"), of_a_mesh);
    write_small_study(path("study"));
    open_first_window(path("sheet.obj"));
    LabWindow* window = other();
    QVERIFY(window && window->document().scene().cloth.is_mesh());
    window->setAsksToSave(false);
    window->close();
    open_first_window(path("study"));
    window = other();
    QVERIFY(window && window->studies().table());
    window->close();
    for (const QString& name : {path("x.compare.json"), QString("report-methods")}) {
      open_first_window(name);
      window = other();
      QVERIFY(window && window->document().isComparison());
      window->close();
    }
    open_first_window("no-such-thing");
    window = other();
    QVERIFY(window && window->notice().text().contains("no-such-thing"));
    QCOMPARE(window->document().scene(), cloth::builtin_scene(cloth::default_scene_name));
  }

  void quit_asks_every_window_and_cancel_keeps_all() {
    open_first_window("corners-free");
    LabWindow* main = other();
    QVERIFY(main && QTest::qWaitForWindowActive(main, patience));
    press(*main, Qt::Key_M, Qt::ControlModifier);  // compare methods: in no file yet
    LabWindow* compare = other(main);
    QVERIFY(compare && QTest::qWaitForWindowActive(compare, patience));
    main->document().setParameter("springs.structural", 123.0);
    {
      Answers answers;
      answers.press("Discard").press("Cancel");
      press(*compare, Qt::Key_Q, Qt::ControlModifier);
      QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    }
    QVERIFY(main->isVisible() && compare->isVisible());
    QVERIFY(main->document().isModified() && compare->document().isModified());
    QCOMPARE(main->document().scene().springs->structural, 123.0);
    Answers answers;
    answers.press("Discard").press("Discard");
    main->activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(main, patience));
    press(*main, Qt::Key_Q, Qt::ControlModifier);
    QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    QTRY_VERIFY_WITH_TIMEOUT(LabWindow::all().empty(), patience);
  }

 private:
  QString path(const QString& name) const { return folder_->filePath(name); }

  /// `foo` typed where there is a file `foo` with this ending; then an ending that is not offered.
  void check_saving(LabWindow& window, const QString& ending, const std::function<void()>& save,
                    const std::function<QString()>& said) {
    const QString there = path("foo" + ending);
    write(there, "old");
    {
      Answers answers;
      answers.type(path("foo")).press("Cancel").leave();
      save();
      QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
      QVERIFY2(answers.last_text().contains("foo" + ending), qPrintable(answers.last_text()));
      QCOMPARE(content_of(there), QByteArray("old"));
    }
    {
      Answers answers;
      answers.type(path("foo")).press("Replace");
      save();
      QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
      QTRY_VERIFY_WITH_TIMEOUT(content_of(there) != "old", patience);
      QTRY_VERIFY2_WITH_TIMEOUT(said().contains(there), qPrintable(said()), patience);
    }
    Answers answers;
    answers.type(path("cmp.xyz")).press("OK").leave();
    save();
    QVERIFY2(answers.came_true(), qPrintable(answers.what_went_wrong()));
    QVERIFY2(answers.last_text().contains(".xyz") && answers.last_text().contains(ending),
             qPrintable(answers.last_text()));
    QVERIFY(QDir(path("")).entryList({"cmp*"}).isEmpty());
    QVERIFY(window.isVisible());
  }

  std::unique_ptr<QTemporaryDir> folder_;
};

const Listed listed{"files_test", test_main<FilesTest>};

}  // namespace clothlab::test::files_test

#include "files_test.moc"
