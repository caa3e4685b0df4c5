// Meshes chosen in the form by real clicks and in the file dialog: for an obstacle, for the cloth and back.
#include <QDialogButtonBox>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPointer>
#include <QPushButton>
#include <QTimer>
#include <fstream>

#include "listed_test.h"
#include "params/mesh_button.h"
#include "patience.h"
#include "window_bench.h"

namespace clothlab::test::mesh_form_test {
namespace {

/// A tetrahedron, the same without a face, the same with a face turned round and one of no area, and no mesh.
const char* const closed_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const char* const open_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
const char* const odd_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 2 5\n";
const char* const bad_obj = "v 0 0 0\nv 1 nan 0\nf 1 2 3\n";

void type(QLineEdit& into, const QString& text) {
  into.setFocus();
  into.selectAll();
  QTest::keyClicks(&into, text);
  QTest::keyClick(&into, Qt::Key_Return);
}

/// Whether the field's frame has the colour of errors, as it is painted.
bool is_framed(QLineEdit& field) {
  const QImage picture = field.grab().toImage();
  return picture.pixelColor(picture.width() / 2, 0) == theme().error;
}

class Bench {
 public:
  Bench() {
    write("closed.obj", closed_obj);
    write("open.obj", open_obj);
    write("odd.obj", odd_obj);
    write("bad.obj", bad_obj);
    write("two.scene.json", R"({
  "format": "clothlab/scene/1", "title": "A mesh under a cloth",
  "cloth": { "columns": 9, "rows": 9, "width": 0.5, "height": 0.5, "mass": 0.05,
             "origin": [-0.25, 0.8, -0.25], "across": [1, 0, 0], "down": [0, 0, 1], "pins": ["top-left"] },
  "springs": { "structural": 60, "flexion": 3, "damping": 0.01 }, "gravity": [0, -9.81, 0],
  "obstacles": [ { "shape": "mesh", "file": "closed.obj", "scale": 0.3 } ],
  "integrator": { "method": "semi-implicit-euler", "time_step": "auto" }, "duration": 1 })");
    bench_ = std::make_unique<WindowBench>(path("two.scene.json"));
  }

  QString path(const char* name) const { return folder_.filePath(name); }
  WindowBench& bench() { return *bench_; }
  LabDocument& document() { return bench_->window.document(); }
  const cloth::Scene& scene() { return document().scene(); }
  QLabel* obstacle_report() {
    return qobject_cast<QLabel*>(bench_->editor("obstacles.0.file", "meshReport"));
  }
  QLabel* obstacle_rule() { return qobject_cast<QLabel*>(bench_->editor("obstacles.0.file", "rule")); }
  QLabel* cloth_rule() {
    auto* row = bench_->window.findChild<QWidget*>("clothShape");
    return row ? row->findChild<QLabel*>("rule") : nullptr;
  }

  MeshButton* obstacle_button() {
    bench_->window.parameters().reveal("obstacles.0.file");
    return qobject_cast<MeshButton*>(bench_->editor("obstacles.0.file", "meshButton"));
  }
  MeshButton* cloth_button() {
    bench_->window.parameters().reveal("cloth.mass");
    auto* section = bench_->window.findChild<QWidget*>("section:cloth");
    return section ? section->findChild<MeshButton*>("meshButton") : nullptr;
  }

  /// Opens the button's menu and clicks on an entry of it.
  void choose(MeshButton* button, const QString& entry) {
    QVERIFY(button && button->isVisible());
    const QPointer<QMenu> menu = button->menu();  // another form may take its place
    QTimer watch;
    bool clicked = false;
    QObject::connect(&watch, &QTimer::timeout, [&] {
      if (!menu || !menu->isVisible() || std::exchange(clicked, true)) return;
      for (QAction* action : menu->actions())
        if (action->objectName() == entry)
          return QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
      menu->close();
      QFAIL(qPrintable(entry + ": no such entry"));
    });
    watch.start(50);
    QTest::mouseClick(button, Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(clicked && (!menu || !menu->isVisible()), patience);
    QTest::qWait(20);  // what the menu's entry does comes after the menu
    bench_->settle();
  }

  /// The same by the file dialog, typing the file's name.
  void choose_file(MeshButton* button, const QString& file) {
    QTimer watch;
    bool typed = false;
    QObject::connect(&watch, &QTimer::timeout, [&] {
      auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
      if (!dialog || std::exchange(typed, true)) return;
      auto* name = dialog->findChild<QLineEdit*>("fileNameEdit");
      auto* buttons = dialog->findChild<QDialogButtonBox*>();
      QVERIFY(name && buttons);
      name->setText(file);
      QTest::mouseClick(buttons->button(QDialogButtonBox::Open), Qt::LeftButton);
    });
    watch.start(50);
    choose(button, "mesh:file");
    QTRY_VERIFY_WITH_TIMEOUT(typed && !QApplication::activeModalWidget(), patience);
    bench_->settle();
  }

 private:
  void write(const char* name, const char* text) { std::ofstream(path(name).toStdString()) << text; }

  QTemporaryDir folder_;
  std::unique_ptr<WindowBench> bench_;
};

}  // namespace

class MeshFormTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    apply_theme(*qApp, false);
  }

  void an_obstacles_mesh_is_chosen_in_a_dialog_as_one_undo_step() {
    Bench b;
    QVERIFY2(b.obstacle_report()->text().contains("4 vertices, 4 triangles, closed"),
             qPrintable(b.obstacle_report()->text()));
    b.choose_file(b.obstacle_button(), b.path("open.obj"));
    QCOMPARE(b.scene().obstacles[0].mesh.file, std::string("open.obj"));  // as seen from the scene's folder
    QCOMPARE(b.bench().window.view().frame()->obstacles[0].mesh.loaded->surface.triangles.size(), 3U);
    QVERIFY2(b.obstacle_report()->text().contains("3 open edges"), qPrintable(b.obstacle_report()->text()));
    QCOMPARE(b.document().undoStack().count(), 1);
    b.document().undoStack().undo();
    QCOMPARE(b.scene().obstacles[0].mesh.file, std::string("closed.obj"));
    QVERIFY(b.obstacle_report()->text().contains("closed"));
  }

  void a_built_in_mesh_is_a_click_in_the_menu() {
    Bench b;
    b.choose(b.obstacle_button(), "mesh:cone-bed.obj");
    QCOMPARE(b.scene().obstacles[0].mesh.file, std::string("cone-bed.obj"));
    QVERIFY(b.obstacle_report()->text().contains(QStringLiteral("5\u202f184 triangles")));
  }

  void what_is_unusual_about_a_mesh_is_said_below_it() {
    Bench b;
    b.choose_file(b.obstacle_button(), b.path("odd.obj"));
    const QString report = b.obstacle_report()->text();
    QVERIFY2(report.contains("same way") || report.contains("opposite") || report.contains("inconsistent"),
             qPrintable(report));
    QVERIFY2(report.contains("degenerate") || report.contains("area"), qPrintable(report));
  }

  void what_is_said_about_a_mesh_comes_into_sight() {
    Bench b;
    b.bench().window.resize(1000, 650);
    auto* bar = b.bench().window.parameters().findChild<QScrollArea*>("scroll")->verticalScrollBar();
    const auto is_in_sight = [](QWidget* what) {
      return what->isVisible() && what->visibleRegion().boundingRect() == what->rect();
    };
    for (const char* file : {"odd.obj", "bad.obj"}) {
      MeshButton* button = b.obstacle_button();
      bar->setValue(bar->value() - 40);  // so that the button is at the lower edge
      b.choose_file(button, b.path(file));
      QCoreApplication::processEvents();
      QWidget* said = file == QLatin1String("bad.obj") ? b.obstacle_rule() : b.obstacle_report();
      QTRY_VERIFY2_WITH_TIMEOUT(is_in_sight(said), file, patience);
    }
    b.choose_file(b.cloth_button(), b.path("bad.obj"));
    QTRY_VERIFY_WITH_TIMEOUT(is_in_sight(b.cloth_rule()), patience);
  }

  void a_bad_file_is_answered_with_place_value_and_rule_and_nothing_is_lost() {
    Bench b;
    const cloth::Scene before = b.scene();
    b.choose_file(b.obstacle_button(), b.path("bad.obj"));
    QVERIFY(b.obstacle_rule()->isVisibleTo(&b.bench().window));
    const QString rule = b.obstacle_rule()->text();
    for (const char* part : {"bad.obj:2", "nan", "finite number", "Still closed.obj"})
      QVERIFY2(rule.contains(part), qPrintable(rule));
    QVERIFY(b.scene() == before);
    QCOMPARE(b.document().undoStack().count(), 0);
    b.choose_file(b.cloth_button(), b.path("bad.obj"));
    QVERIFY(b.cloth_rule()->isVisibleTo(&b.bench().window));
    QVERIFY2(b.cloth_rule()->text().contains("bad.obj:2"), qPrintable(b.cloth_rule()->text()));
    QVERIFY(b.scene() == before);
    b.choose_file(b.obstacle_button(), b.path("open.obj"));
    QVERIFY2(!b.obstacle_rule()->isVisibleTo(&b.bench().window), "a good one takes the message away");
  }

  void a_refused_typed_name_is_framed_until_it_is_typed_anew_or_given_up() {
    Bench b;
    b.choose(b.cloth_button(), "mesh:disc.obj");
    for (const char* path : {"obstacles.0.file", "cloth.mesh"}) {
      b.bench().window.parameters().reveal(path);
      auto* field = qobject_cast<QLineEdit*>(b.bench().editor(path, "field"));
      auto* rule = qobject_cast<QLabel*>(b.bench().editor(path, "rule"));
      QVERIFY(field && rule);
      const QString before = field->text();
      QVERIFY2(!is_framed(*field), path);
      type(*field, "none.obj");
      QVERIFY2(rule->isVisibleTo(&b.bench().window), path);
      QCOMPARE(field->text(), QString("none.obj"));
      QVERIFY2(is_framed(*field), path);
      QTest::keyClick(field, Qt::Key_End);
      QTest::keyClick(field, Qt::Key_X);
      QVERIFY2(!is_framed(*field), "what is being typed is not refused yet");
      QTest::keyClick(field, Qt::Key_Return);
      QVERIFY2(is_framed(*field), path);
      QTest::keyClick(field, Qt::Key_Escape);
      QCOMPARE(field->text(), before);
      QVERIFY2(!is_framed(*field) && !rule->isVisibleTo(&b.bench().window), path);
    }
    QCOMPARE(b.document().undoStack().count(), 1);  // the disc
  }

  void a_file_refused_by_the_dialog_leaves_the_field_alone() {
    Bench b;
    b.choose_file(b.obstacle_button(), b.path("bad.obj"));
    auto* field = qobject_cast<QLineEdit*>(b.bench().editor("obstacles.0.file", "field"));
    QVERIFY(b.obstacle_rule()->isVisibleTo(&b.bench().window));
    QCOMPARE(field->text(), QString("closed.obj"));
    QVERIFY2(!is_framed(*field), "the name in the field is the one in force");
  }

  void a_grid_becomes_a_mesh_and_a_grid_again() {
    Bench b;
    const cloth::Scene grid = b.scene();
    b.choose(b.cloth_button(), "mesh:disc.obj");
    QCOMPARE(b.scene().cloth.mesh.file, std::string("disc.obj"));
    QVERIFY(b.scene().cloth.pins.empty());
    QVERIFY2(b.bench().status().refusal.empty(), b.bench().status().refusal.c_str());
    QVERIFY(b.bench().window.view().frame()->mesh);
    QVERIFY(!b.bench().window.findChild<QWidget*>("param:cloth.columns"));
    const auto mesh = b.scene().cloth;
    const cloth::Vec3 middle = mesh.origin + mesh.mesh.loaded->bounds.center();
    QVERIFY2((middle - cloth::Vec3(0, 0.8, 0)).norm() < 1e-9, "where the grid was");
    b.bench().play_until(0.05);
    b.bench().pause();
    QVERIFY(!b.bench().status().divergence);

    b.choose(b.cloth_button(), "mesh:grid");
    QVERIFY(!b.scene().cloth.is_mesh());
    QCOMPARE(b.scene().cloth.mass, grid.cloth.mass);
    QVERIFY(!b.bench().window.view().frame()->mesh);
    QVERIFY(b.bench().window.findChild<QWidget*>("param:cloth.columns"));
    QVERIFY(b.bench().status().refusal.empty());
    QCOMPARE(b.document().undoStack().count(), 2);
    b.document().undoStack().undo();
    QCOMPARE(b.scene().cloth.mesh.file, std::string("disc.obj"));
    b.document().undoStack().undo();
    QVERIFY(b.scene() == grid);
  }
};

const Listed listed{"mesh_form_test", test_main<MeshFormTest>};

}  // namespace clothlab::test::mesh_form_test

#include "mesh_form_test.moc"
