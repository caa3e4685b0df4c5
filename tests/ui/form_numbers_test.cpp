// The number fields of the form: units, expressions, messages, and the focus.
#include "form_fixture.h"
#include "listed_test.h"
#include "params/exact_field.h"

namespace clothlab::test::form_numbers_test {

class FormNumbersTest : public FormFixture {
  Q_OBJECT

 private Q_SLOTS:
  void init() { open(); }
  void cleanup() { close(); }

  void a_field_takes_its_own_unit_others_and_expressions() {
    type(field("integrator.time_step"), "0.3 ms");
    QCOMPARE(doc().scene().integrator.time_step, std::optional<double>(0.0003));
    type(field("integrator.time_step"), "1/4000 s");
    QCOMPARE(doc().scene().integrator.time_step, std::optional<double>(1.0 / 4000));
    type(field("springs.structural"), "5 cN/mm");
    QCOMPARE(structural(), 50.0);
    type(field("springs.structural"), "1e1*2");
    QCOMPARE(structural(), 20.0);
    type(field("springs.structural"), "2*pi");
    QCOMPARE(structural(), 2 * M_PI);
    type(field("deformation.rate"), "15 %");
    QCOMPARE(doc().scene().deformation->rate, 0.15);
    type(field("deformation.max_sweeps"), "1e1*2");
    QCOMPARE(doc().scene().deformation->max_sweeps, std::int64_t{20});
    type(part<QLineEdit>("gravity", "field_y"), "-162 cm/s²");
    QCOMPARE(doc().scene().gravity->y(), -1.62);
  }

  void a_quantity_of_another_kind_is_refused_with_both_units() {
    type(field("springs.structural"), "5 kg");
    QCOMPARE(part<QLabel>("springs.structural", "rule")->text(),
             QString("Must be in N/m, not in kg. Still 500 N/m."));
    QCOMPARE(structural(), 500.0);
    QCOMPARE(field("springs.structural")->text(), QString("5 kg"));
  }

  void values_are_shown_with_a_prefix_and_edited_in_the_unit() {
    QLineEdit* step = field("integrator.time_step");
    panel().setAutoValue("integrator.time_step", 0.000909091);
    QCOMPARE(step->placeholderText(), QString("0.909 ms"));
    type(step, "0.3 ms", Qt::Key_Tab);
    QCOMPARE(step->text(), QString("0.3"));
    step->setFocus();
    QCOMPARE(step->text(), QString("3e-4"));
    type(field("springs.structural"), "-1");
    QVERIFY(part<QLabel>("springs.structural", "rule")->text().endsWith("Still 500 N/m."));
    doc().setParameter("springs.structural", 54321.5);
    type(field("springs.structural"), "-1");
    QVERIFY(part<QLabel>("springs.structural", "rule")->text().endsWith("Still 54.3215 kN/m."));
  }

  void a_message_moves_no_row_and_lets_the_mouse_through() {
    auto* content = panel().findChild<QScrollArea*>("scroll")->widget();
    const auto top_of = [&](const char* path) { return slider(path)->mapTo(content, QPoint(0, 0)).y(); };
    const int above = top_of("springs.structural"), below = top_of("springs.shear"), tall = content->height();
    field("springs.structural")->setFocus();
    field("springs.structural")->selectAll();
    QTest::keyClicks(field("springs.structural"), "-3");
    QTest::mouseClick(slider("springs.shear"), Qt::LeftButton, {}, at(slider("springs.shear"), 0.99));
    auto* message = part<QLabel>("springs.structural", "rule");
    QVERIFY(message->isVisible() && message->text().startsWith(QStringLiteral("Must be ≥ 0")));
    QCOMPARE(doc().scene().springs->shear, 1e5);
    QCoreApplication::processEvents();
    QCOMPARE(top_of("springs.structural"), above);
    QCOMPARE(top_of("springs.shear"), below);
    QCOMPARE(content->height(), tall);
    const QRect field_place(field("springs.structural")->mapTo(content, QPoint(0, 0)),
                            field("springs.structural")->size());
    QVERIFY(!message->geometry().intersects(field_place));
    QWidget* under = content->childAt(message->geometry().center());
    QVERIFY2(under != message, "the mouse goes through");
    field("springs.flexion")->setFocus();
    QVERIFY2(!message->isVisible(), "away with the second step of the focus");
    field("springs.structural")->setFocus();
    QVERIFY2(message->isVisible(), "and back with it");
    QTest::keyClick(field("springs.structural"), Qt::Key_Escape);
    QVERIFY(!message->isVisible());
  }

  void values_beyond_all_sense_are_taken_with_a_warning_and_its_reason() {
    type(field("integrator.time_step"), "100 s");
    QCOMPARE(doc().scene().integrator.time_step, std::optional<double>(100));
    auto* message = part<QLabel>("integrator.time_step", "rule");
    QVERIFY(message->isVisible());
    QVERIFY2(message->text().startsWith("100 s: Longer than a cloth takes"), qPrintable(message->text()));
    QCOMPARE(message->property("state").toString(), QString("warning"));
    QVERIFY(part<QLabel>("integrator.time_step", "doubt")->isVisible());
    type(field("integrator.time_step"), "1 ms");
    QVERIFY(!message->isVisible());
    QVERIFY(!part<QLabel>("integrator.time_step", "doubt")->isVisible());
    type(field("springs.structural"), "1e12 N/m");
    QCOMPARE(structural(), 1e12);
    QVERIFY(part<QLabel>("springs.structural", "rule")->text().contains("stiffer than any cloth"));
    type(field("springs.structural"), "1e99 N/m");
    QCOMPARE(structural(), 1e12);
    QVERIFY(part<QLabel>("springs.structural", "rule")->text().contains("could overflow"));
  }

  void from_right_to_left_nothing_overlaps_and_numbers_stay_as_they_are() {
    const char* const path = "springs.structural";
    panel().resize(280, 700);
    QCoreApplication::processEvents();
    QCOMPARE(QApplication::layoutDirection(), Qt::LeftToRight);
    const QImage field_before = field(path)->grab().toImage(), slider_before = slider(path)->grab().toImage();
    QApplication::setLayoutDirection(Qt::RightToLeft);
    const auto back = qScopeGuard([] { QApplication::setLayoutDirection(Qt::LeftToRight); });
    QCoreApplication::processEvents();
    QCOMPARE(field(path)->grab().toImage(), field_before);
    QCOMPARE(slider(path)->grab().toImage(), slider_before);
    for (QWidget* row : panel().findChildren<QWidget*>()) {
      if (!row->layout() || !row->isVisible()) continue;
      const QList<QWidget*> parts = row->findChildren<QWidget*>(Qt::FindDirectChildrenOnly);
      for (qsizetype i = 0; i < parts.size(); ++i) {
        if (!parts[i]->isVisible() || parts[i]->property("bubble").toBool()) continue;
        QVERIFY2(row->rect().contains(parts[i]->geometry()), qPrintable(parts[i]->objectName()));
        for (qsizetype j = 0; j < i; ++j)
          QVERIFY2(!parts[j]->isVisible() || !parts[i]->geometry().intersects(parts[j]->geometry()),
                   qPrintable(row->objectName() + ": " + parts[i]->objectName() + " over " +
                              parts[j]->objectName()));
      }
    }
  }

  void enter_keeps_the_focus() {
    QLineEdit* f = field("springs.structural");
    type(f, "700");
    QCOMPARE(structural(), 700.0);
    QVERIFY(f->hasFocus());
    QTest::keyClicks(f, "7e2*2");  // what was there is selected
    QTest::keyClick(f, Qt::Key_Enter);
    QCOMPARE(structural(), 1400.0);
    QVERIFY(f->hasFocus());
  }
};

const Listed listed{"form_numbers_test", test_main<FormNumbersTest>};

}  // namespace clothlab::test::form_numbers_test

#include "form_numbers_test.moc"
