// Materials in the form by real clicks: presets, files, springs turned into a material and back.
#include <QAbstractItemView>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QTimer>
#include <fstream>

#include "dialogs.h"
#include "listed_test.h"
#include "patience.h"
#include "scene/material_file.h"
#include "window_bench.h"

namespace clothlab::test::material_form_test {
namespace {

class Bench {
 public:
  explicit Bench(const char* material = R"("gray-interlock")") {
    std::ofstream(path("hung.scene.json").toStdString()) << R"({
  "title": "Hung", "cloth": { "columns": 9, "rows": 9, "pins": ["top-edge"] }, "material": )"
                                                         << material << R"(, "gravity": [0, -9.81, 0] })";
    std::ofstream(path("springs.scene.json").toStdString()) << R"({
  "title": "Hung", "cloth": { "columns": 9, "rows": 9, "mass": 0.2, "pins": ["top-edge"] },
  "springs": { "structural": 200, "shear": 100, "flexion": 10, "damping": 0.001 }, "gravity": [0, -9.81, 0] })";
  }

  Bench& open(const char* scene = "hung.scene.json") {
    bench_ = std::make_unique<WindowBench>(path(scene));
    bench_->window.parameters().reveal(material() ? "material.areal_density" : "springs.structural");
    return *this;
  }

  QString path(const char* name) const { return folder_.filePath(name); }
  WindowBench& bench() { return *bench_; }
  LabDocument& document() { return bench_->window.document(); }
  const cloth::Scene& scene() { return document().scene(); }
  const std::optional<cloth::Material>& material() { return scene().material; }
  QWidget* row() { return bench_->window.findChild<QWidget*>("materialRow"); }
  QComboBox* presets() { return row()->findChild<QComboBox*>("materialPreset"); }
  QToolButton* button() { return row()->findChild<QToolButton*>("materialButton"); }
  QLabel* source() { return row()->findChild<QLabel*>("materialSource"); }
  QLabel* rule() { return row()->findChild<QLabel*>("rule"); }

  void enter(const char* parameter, const char* text) {
    auto* field = qobject_cast<QLineEdit*>(bench().editor(parameter, "field"));
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, text);
    QTest::keyClick(field, Qt::Key_Return);
    bench().settle();
  }

  /// Opens the list of presets and clicks on the one of this name.
  void choose(const char* name) {
    const QString title = QString::fromStdString(cloth::builtin_material(name).title).section(':', 0, 0);
    const int index = presets()->findText(title);
    QVERIFY(index > 0);
    QTest::mouseClick(presets(), Qt::LeftButton);
    QAbstractItemView* list = presets()->view();
    QTRY_VERIFY_WITH_TIMEOUT(list->isVisible(), patience);
    const QModelIndex entry = presets()->model()->index(index, 0);
    QTest::qWait(QApplication::doubleClickInterval() + 50);  // a quick click would only open the list
    QPoint at;
    const auto is_in_sight = [&] {
      list->scrollTo(entry);
      at = list->visualRect(entry).center();
      at.setX(20);
      return list->viewport()->rect().contains(at);
    };
    QTRY_VERIFY2_WITH_TIMEOUT(is_in_sight(), name, patience);
    QTest::mouseMove(list->viewport(), at);
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, at);
    QTRY_VERIFY2_WITH_TIMEOUT(!list->isVisible(), name, patience);
    bench_->settle();
  }

  /// Opens the button's menu and clicks on an entry of it.
  void act(const char* entry) {
    QTimer::singleShot(50, [this, entry] {
      QMenu* menu = button()->menu();
      for (QAction* action : menu->actions())
        if (action->objectName() == entry)
          return QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
      menu->close();
      QFAIL(entry);
    });
    QTest::mouseClick(button(), Qt::LeftButton);
    QTest::qWait(20);
    bench_->settle();
  }

 private:
  QTemporaryDir folder_;
  std::unique_ptr<WindowBench> bench_;
};

cloth::Material preset(const char* name) {
  return cloth::builtin_material(name).material;
}

}  // namespace

class MaterialFormTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    apply_theme(*qApp, false);
  }

  void a_preset_is_a_click_in_the_list_and_one_undo_step() {
    Bench b;
    b.open();
    QCOMPARE(b.source()->text(), QString("Wang, O'Brien, Ramamoorthi 2011"));
    b.choose("cotton-broad");
    QVERIFY(b.material() == preset("cotton-broad"));
    QCOMPARE(b.source()->text(), QString("Matsudaira et al. 2015"));
    QVERIFY(b.presets()->toolTip().contains("KES-FB2"));
    QCOMPARE(b.document().undoStack().count(), 1);
    b.document().undoStack().undo();
    QVERIFY(b.material() == preset("gray-interlock"));
    QCOMPARE(b.source()->text(), QString("Wang, O'Brien, Ramamoorthi 2011"));
  }

  void a_preset_that_does_not_fit_the_grid_is_refused_with_the_rule() {
    Bench b;
    b.open();
    b.choose("navy-sparkle-sweat");
    QVERIFY2(b.rule()->isVisible() && b.rule()->text().contains("6.5 N/m"), qPrintable(b.rule()->text()));
    QVERIFY(b.material() == preset("gray-interlock"));
    QCOMPARE(b.presets()->currentText().left(14), QString("Gray interlock"));
    QCOMPARE(b.document().undoStack().count(), 0);
    b.choose("paper");
    QVERIFY2(!b.rule()->isVisible(), "a good one takes the message away");
  }

  void a_changed_value_makes_it_a_material_of_its_own_and_one_that_does_not_fit_is_refused() {
    Bench b;
    b.open();
    b.enter("material.shear", "0.4 gf/(cm deg)");
    QVERIFY(std::abs(b.material()->shear - 0.4 * 56.188) < 0.001);
    QCOMPARE(b.presets()->currentIndex(), 0);
    QVERIFY(!b.source()->isVisible());
    b.enter("material.shear", "34");
    QVERIFY(std::abs(b.material()->shear - 0.4 * 56.188) < 0.001);
    b.document().undoStack().undo();
    QVERIFY(b.presets()->currentIndex() > 0);
  }

  void a_material_is_saved_and_opened_again() {
    Bench b(R"({"preset": "gray-interlock", "shear": 12})");
    b.open();
    const cloth::Material saved = *b.material();
    {
      Answers answers;
      answers.type(b.path("mine.material.json"));
      b.act("material:save");
      QTRY_VERIFY2_WITH_TIMEOUT(answers.came_true(), qPrintable(answers.what_went_wrong()), patience);
    }
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(b.path("mine.material.json")), patience);
    b.choose("royal-target");
    {
      Answers answers;
      answers.type(b.path("mine.material.json"));
      b.act("material:open");
      QTRY_VERIFY2_WITH_TIMEOUT(answers.came_true(), qPrintable(answers.what_went_wrong()), patience);
    }
    QTRY_VERIFY_WITH_TIMEOUT(b.material() == saved, patience);
  }

  void a_bad_file_is_answered_with_its_place_and_rule() {
    Bench b;
    b.open();
    std::ofstream(b.path("bad.material.json").toStdString()) << R"({"material": {"areal_density": -1}})";
    Answers answers;
    answers.type(b.path("bad.material.json"));
    b.act("material:open");
    QTRY_VERIFY_WITH_TIMEOUT(b.rule()->isVisible(), patience);
    QVERIFY2(b.rule()->text().contains("bad.material.json:1:32"), qPrintable(b.rule()->text()));
    QVERIFY(b.material() == preset("gray-interlock"));
  }

  void springs_turn_into_a_material_after_a_question_that_says_what_is_lost() {
    Bench b;
    b.open("springs.scene.json");
    const cloth::Scene before = b.scene();
    {
      Answers answers;
      answers.press("Cancel");
      QTest::mouseClick(b.button(), Qt::LeftButton);
      QTRY_VERIFY2_WITH_TIMEOUT(answers.came_true(), qPrintable(answers.what_went_wrong()), patience);
    }
    QVERIFY(b.scene() == before);
    {
      Answers answers;
      answers.press("Turn springs into a material");
      QTest::mouseClick(b.button(), Qt::LeftButton);
      QTRY_VERIFY2_WITH_TIMEOUT(answers.came_true(), qPrintable(answers.what_went_wrong()), patience);
    }
    QTRY_VERIFY_WITH_TIMEOUT(b.material(), patience);
    b.bench().settle();
    QVERIFY(!b.scene().springs);
    QVERIFY(std::abs(b.material()->stretch_warp - 340) < 1e-9);
    QVERIFY(b.presets() && b.presets()->isVisible());
    b.bench().play_until(0.02);
    b.bench().pause();
    {
      Answers answers;
      answers.press("Turn the material into springs");
      b.act("material:springs");
      QTRY_VERIFY2_WITH_TIMEOUT(answers.came_true(), qPrintable(answers.what_went_wrong()), patience);
    }
    QTRY_VERIFY_WITH_TIMEOUT(b.scene().springs, patience);
    QVERIFY(std::abs(b.scene().springs->structural - 240) < 1e-9);
    b.document().undoStack().undo();
    b.document().undoStack().undo();
    QVERIFY(b.scene() == before);
  }

  void the_question_lists_the_losses() {
    Bench b;
    b.open("springs.scene.json");
    QString said;
    QTimer watch;
    connect(&watch, &QTimer::timeout, [&] {
      auto* message = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (!message) return;
      said = message->informativeText();
      message->reject();
    });
    watch.start(50);
    QTest::mouseClick(b.button(), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(!said.isEmpty(), patience);
    QVERIFY2(said.contains("cube of the curvature") && said.contains("half the springs"), qPrintable(said));
  }
};

const Listed listed{"material_form_test", test_main<MaterialFormTest>};

}  // namespace clothlab::test::material_form_test

#include "material_form_test.moc"
