// The parameter panel's editors, driven by real keys and mouse events.
#include <QAbstractItemView>
#include <QScrollBar>

#include "form_fixture.h"
#include "listed_test.h"

namespace clothlab::test::form_test {
using cloth::Vec3;

class FormTest : public FormFixture {
  Q_OBJECT

 private Q_SLOTS:
  void init() { open(); }
  void cleanup() { close(); }

  void one_slider_drag_is_one_undo_step() {
    int live_edits = 0;
    connect(&doc(), &LabDocument::sceneChanged, this, [&] { ++live_edits; });
    drag(slider("springs.structural"), 0.5, 0.9);
    QVERIFY2(live_edits >= 10, "moving the slider acts at once");
    QVERIFY(structural() > 5000);
    QCOMPARE(undo().count(), 1);
    undo().undo();
    QCOMPARE(structural(), 500.0);
  }

  void two_drags_are_two() {
    drag(slider("springs.structural"), 0.5, 0.7);
    const double between = structural();
    drag(slider("springs.structural"), 0.7, 0.9);
    QCOMPARE(undo().count(), 2);
    undo().undo();
    QCOMPARE(structural(), between);
  }

  void taking_the_handle_without_moving_it_changes_nothing() {
    doc().setParameter("springs.structural", 512.3456789);
    QSlider* s = slider("springs.structural");
    SliderScale scale(find_parameter(doc().scene(), "springs.structural")->info);
    const int x = static_cast<int>(7 + scale.position_of(structural()) * (s->width() - 14));
    QTest::mouseClick(s, Qt::LeftButton, {}, {x, s->height() / 2});
    QCOMPARE(structural(), 512.3456789);
  }

  void a_click_on_the_groove_is_one_step_to_that_place() {
    QTest::mouseClick(slider("springs.structural"), Qt::LeftButton, {},
                      at(slider("springs.structural"), 0.99));
    QCOMPARE(structural(), 1e5);
    QCOMPARE(undo().count(), 1);
  }

  void the_left_end_of_a_log_slider_from_zero_is_zero() {
    drag(slider("springs.structural"), 0.5, 0.0);
    QCOMPARE(structural(), 0.0);
  }

  void an_arrow_key_on_a_slider_is_one_step() {
    slider("springs.structural")->setFocus();
    QTest::keyClick(slider("springs.structural"), Qt::Key_Right);
    QCOMPARE(structural(), 510.0);
    QTest::keyClick(slider("springs.structural"), Qt::Key_Left);
    QCOMPARE(structural(), 500.0);
    QCOMPARE(undo().count(), 2);
  }

  void undo_then_redo_gives_the_same_scene_and_the_same_form() {
    drag(slider("springs.structural"), 0.5, 0.8);
    const cloth::Scene after = doc().scene();
    const QString text = field("springs.structural")->text();
    undo().undo();
    QCOMPARE(field("springs.structural")->text(), QString("500"));
    undo().redo();
    QVERIFY(doc().scene() == after);
    QCOMPARE(field("springs.structural")->text(), QString(text));
  }

  void exact_field_accepts_scientific_notation() {
    type(field("deformation.tolerance"), "2.5e-3");
    QCOMPARE(doc().scene().deformation->tolerance, 2.5e-3);
    type(field("springs.structural"), "1E3 N/m");
    QCOMPARE(structural(), 1000.0);
    type(field("deformation.max_sweeps"), "1e2");
    QCOMPARE(doc().scene().deformation->max_sweeps, std::int64_t{100});
  }

  void seventeen_digits_are_stored_and_showing_fewer_changes_nothing() {
    type(field("springs.structural"), "123.45678901234567", Qt::Key_Tab);
    QCOMPARE(structural(), 123.45678901234567);
    QCOMPARE(field("springs.structural")->text(), QString("123.457"));
    field("springs.structural")->setFocus();
    QCOMPARE(field("springs.structural")->text(), QString("123.45678901234567"));
    QTest::keyClick(field("springs.structural"), Qt::Key_Tab);
    QCOMPARE(structural(), 123.45678901234567);
    QCOMPARE(undo().count(), 1);
  }

  void a_refused_value_changes_nothing_and_says_the_rule() {
    auto* rule = part<QLabel>("springs.structural", "rule");
    QVERIFY(!rule->isVisible());
    for (const char* text : {"-3", "abc", "1e999", "nan", "1,5", "3 m", "0x10"}) {
      type(field("springs.structural"), text);
      QVERIFY2(rule->isVisible() && !rule->text().isEmpty(), text);
      QCOMPARE(structural(), 500.0);
      QCOMPARE(field("springs.structural")->text(), QString(text));
    }
    type(field("springs.structural"), "-3");
    QVERIFY(rule->text().startsWith(QStringLiteral("Must be ≥ 0")));
    type(field("deformation.max_sweeps"), "2.5");
    QVERIFY(part<QLabel>("deformation.max_sweeps", "rule")->text().startsWith("Must be a whole number"));
    QCOMPARE(undo().count(), 0);
    type(field("springs.structural"), "7");
    QVERIFY(!rule->isVisible());
    QCOMPARE(structural(), 7.0);
  }

  void escape_brings_the_value_back() {
    type(field("springs.structural"), "-3");
    QTest::keyClick(field("springs.structural"), Qt::Key_Escape);
    QCOMPARE(field("springs.structural")->text(), QString("500"));
    QVERIFY(!part<QLabel>("springs.structural", "rule")->isVisible());
  }

  void a_decimal_comma_is_shown_and_taken_where_the_locale_has_one_and_a_point_is_taken_everywhere() {
    const QLocale before;
    QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany));
    doc().load(plain_scene());
    type(field("deformation.rate"), "0.25", Qt::Key_Tab);
    QCOMPARE(doc().scene().deformation->rate, 0.25);
    QCOMPARE(field("deformation.rate")->text(), QString("0,25"));
    doc().setParameter("springs.structural", 54321.5);
    QCOMPARE(field("springs.structural")->text(), QString("54,3215"));  // kN/m
    type(field("deformation.rate"), "0,5");
    QCOMPARE(doc().scene().deformation->rate, 0.5);
    QLocale::setDefault(before);
  }

  void the_up_and_down_keys_step_a_field_as_one_step_each() {
    QLineEdit* f = field("springs.structural");
    f->setFocus();
    QTest::keyClick(f, Qt::Key_Up);
    QCOMPARE(structural(), 510.0);
    QTest::keyClick(f, Qt::Key_Down);
    QCOMPARE(structural(), 500.0);
    QCOMPARE(undo().count(), 2);
  }

  void a_vector_is_edited_by_its_parts() {
    type(part<QLineEdit>("gravity", "field_y"), "-1.62");
    QCOMPARE(doc().scene().gravity->y(), -1.62);
    QCOMPARE(undo().count(), 1);
  }

  void a_slider_of_a_vector_moves_its_own_part_in_one_undo_step() {
    drag(part<QSlider>("gravity", "slider_y"), 0.25, 0.75);
    QVERIFY(doc().scene().gravity->y() > 0);
    QCOMPARE(doc().scene().gravity->x(), 0.0);
    QCOMPARE(doc().scene().gravity->z(), 0.0);
    QCOMPARE(undo().count(), 1);
    undo().undo();
    QCOMPARE(doc().scene().gravity->y(), -9.81);
  }

  void a_direction_may_pass_through_zero_while_it_is_typed() {
    type(part<QLineEdit>("cloth.down", "field_y"), "0", Qt::Key_Tab);
    QVERIFY(part<QLabel>("cloth.down", "rule")->isVisible());
    QCOMPARE(doc().scene().cloth.down, Vec3(0, -1, 0));
    type(part<QLineEdit>("cloth.down", "field_z"), "1");
    QCOMPARE(doc().scene().cloth.down, Vec3(0, 0, 1));
    QVERIFY(!part<QLabel>("cloth.down", "rule")->isVisible());
    QCOMPARE(undo().count(), 1);
  }

  void the_list_of_methods_shows_every_one_of_them() {
    auto* combo = part<QComboBox>("integrator.method", "combo");
    combo->showPopup();
    QTest::qWait(100);
    QVERIFY(combo->view()->isVisible());
    QVERIFY(!combo->view()->verticalScrollBar()->isVisible());
    const QModelIndex last = combo->model()->index(combo->count() - 1, 0);
    QVERIFY(combo->view()->viewport()->rect().contains(combo->view()->visualRect(last).center()));
    combo->hidePopup();
  }

  void a_choice_is_shown_in_words_and_set_by_key() {
    auto* combo = part<QComboBox>("integrator.method", "combo");
    QCOMPARE(combo->currentText(), QString("Verlet"));
    combo->setFocus();
    QTest::keyClick(combo, Qt::Key_Up);
    QCOMPARE(doc().scene().integrator.method, std::string("semi-implicit-euler"));
    undo().undo();
    QCOMPARE(combo->currentText(), QString("Verlet"));
  }

  void a_method_brings_its_own_settings_and_takes_them_along_when_it_goes() {
    QVERIFY(!field("integrator.tolerance") && !field("integrator.iterations"));
    auto* combo = part<QComboBox>("integrator.method", "combo");
    combo->setFocus();
    const int steps = combo->findText("Implicit Euler") - combo->currentIndex();
    QVERIFY(steps > 0);
    for (int n = 0; n < steps; ++n)  // the form may be a new one after every key
      QTest::keyClick(part<QComboBox>("integrator.method", "combo"), Qt::Key_Down);
    QCOMPARE(doc().scene().integrator.method, std::string("implicit-euler"));
    QVERIFY(field("integrator.tolerance") && field("integrator.iterations"));
    type(field("integrator.tolerance"), "1e-9");
    QCOMPARE(doc().scene().integrator.tolerance, 1e-9);
    while (undo().canUndo()) undo().undo();
    QCOMPARE(doc().scene().integrator.method, std::string("verlet"));
    QVERIFY(!field("integrator.tolerance") && !field("integrator.iterations"));
  }

  void auto_gives_way_to_a_number_and_back() {
    panel().setAutoValue("integrator.time_step", 0.00042);
    auto* toggle = part<QCheckBox>("integrator.time_step", "auto");
    QVERIFY(toggle->isChecked());
    QTest::mouseClick(toggle, Qt::LeftButton, {}, {8, toggle->height() / 2});
    QCOMPARE(doc().scene().integrator.time_step, std::optional<double>(0.00042));
    type(field("integrator.time_step"), "auto");
    QVERIFY(!doc().scene().integrator.time_step);
    QVERIFY(toggle->isChecked());
    type(field("integrator.time_step"), "1e-3");
    QCOMPARE(doc().scene().integrator.time_step, std::optional<double>(1e-3));
    QVERIFY(!toggle->isChecked());
  }

  void wheel_without_focus_changes_nothing() {
    panel().resize(320, 400);
    const cloth::Scene before = doc().scene();
    auto* bar = panel().findChild<QScrollArea*>("scroll")->verticalScrollBar();
    QCoreApplication::processEvents();
    QVERIFY(bar->maximum() > 0);
    for (QWidget* over :
         std::initializer_list<QWidget*>{slider("springs.structural"), field("springs.structural"),
                                         part<QComboBox>("deformation.springs", "combo")}) {
      bar->setValue(0);
      wheel(over, -120);
      QVERIFY2(bar->value() > 0, qPrintable(over->objectName()));
    }
    QVERIFY(doc().scene() == before);
  }

  void tab_visits_the_form_from_top_to_bottom() {
    doc().addBlock("air");
    slider("springs.structural")->setFocus();
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
    QCOMPARE(QApplication::focusWidget(), field("springs.structural"));
    int last_y = 0;
    for (int i = 0; i < 40; ++i) {
      QWidget* now = QApplication::focusWidget();
      auto* content = panel().findChild<QScrollArea*>("scroll")->widget();
      const int y = now->mapTo(content, now->rect().center()).y();
      QVERIFY2(y >= last_y - 16, qPrintable(now->accessibleName()));
      last_y = y;
      QTest::keyClick(now, Qt::Key_Tab);
      if (!content->isAncestorOf(QApplication::focusWidget())) return;
    }
  }

  void every_control_has_an_accessible_name() {
    for (const char* offer : {"air", "air.gust", "damping", "sphere", "box", "plane", "mesh"})
      doc().addBlock(offer);
    for (const QWidget* widget : panel().findChildren<QWidget*>())
      if (widget->focusPolicy() & Qt::TabFocus) {
        QAccessibleInterface* face = QAccessible::queryAccessibleInterface(const_cast<QWidget*>(widget));
        QVERIFY2(face && !face->text(QAccessible::Name).isEmpty(),
                 qPrintable(QString("%1 %2").arg(widget->metaObject()->className(), widget->objectName())));
      }
  }

  void nothing_is_wider_than_280_pixels() {
    for (const char* offer : {"air", "air.gust", "damping", "sphere", "box", "plane", "mesh"})
      doc().addBlock(offer);
    panel().resize(280, 700);
    QCoreApplication::processEvents();
    QCOMPARE(panel().width(), 280);
    auto* area = panel().findChild<QScrollArea*>("scroll");
    QVERIFY(area->widget()->width() <= area->viewport()->width());
  }

  void undo_keys_reach_the_document_from_a_field_that_is_not_being_typed_in() {
    std::unique_ptr<QAction> action(undo().createUndoAction(&panel()));
    action->setShortcut(QKeySequence::Undo);
    panel().addAction(action.get());
    type(field("springs.structural"), "700");
    QTest::keyClick(field("springs.structural"), Qt::Key_Z, Qt::ControlModifier);
    QCOMPARE(structural(), 500.0);
    QCOMPARE(field("springs.structural")->text(), QString("500"));
  }

  void a_window_takes_document_and_form_down_in_any_order_while_one_types() {
    for (const bool document_first : {true, false}) {
      auto window = std::make_unique<QWidget>();
      auto* document = new LabDocument;
      document->load(plain_scene());
      auto* form = new ParameterPanel(*document);
      if (document_first) document->setParent(window.get());
      form->setParent(window.get());
      document->setParent(window.get());
      window->show();
      QVERIFY(QTest::qWaitForWindowExposed(window.get()));
      window->activateWindow();
      QVERIFY(QTest::qWaitForWindowActive(window.get(), patience));
      auto* field = form->findChild<QWidget*>("param:springs.structural")->findChild<QLineEdit*>("field");
      field->setFocus();
      QTest::keyClicks(field, "9");
      window.reset();
    }
  }

  void a_block_that_goes_while_its_slider_is_held_ends_the_drag() {
    QSlider* held = slider("springs.structural");
    QTest::mousePress(held, Qt::LeftButton, {}, at(held, 0.9));
    QVERIFY(doc().removeBlock("springs"));
    QCoreApplication::processEvents();
    doc().setParameter("deformation.rate", 0.2);
    doc().setParameter("deformation.rate", 0.3);
    QCOMPARE(undo().count(), 4);
  }
};

const Listed listed{"form_test", test_main<FormTest>};

}  // namespace clothlab::test::form_test

#include "form_test.moc"
#include "patience.h"
