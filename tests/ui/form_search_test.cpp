// The search field of the form.
#include <QDockWidget>

#include "form_fixture.h"
#include "listed_test.h"
#include "patience.h"
#include "window_bench.h"

namespace clothlab::test::form_search_test {

class FormSearchTest : public FormFixture {
  Q_OBJECT

  QLineEdit* search() { return panel().findChild<QLineEdit*>("search"); }
  void look_for(const QString& text) {
    search()->setFocus();
    search()->selectAll();
    QTest::keyClicks(search(), text);
  }
  bool is_shown(const char* path) {
    auto* row = panel().findChild<QWidget*>(QString("param:") + path);
    return row && row->isVisible();
  }

 private Q_SLOTS:
  void init() { open(); }
  void cleanup() { close(); }

  void shows_what_has_every_word_in_title_path_or_help() {
    look_for("stiffness");  // titles
    QVERIFY(is_shown("springs.structural") && is_shown("springs.flexion"));
    QVERIFY(!is_shown("springs.damping") && !is_shown("integrator.method") &&
            !section("gravity")->isVisible());
    look_for("max_sweeps");  // a path
    QVERIFY(is_shown("deformation.max_sweeps") && !is_shown("deformation.rate"));
    look_for("diagonals SHEARING");  // help text
    QVERIFY(is_shown("springs.shear") && !is_shown("springs.structural"));
    look_for("gravity");
    QVERIFY(is_shown("gravity"));
    QTest::keyClick(search(), Qt::Key_Escape);
    QCOMPARE(search()->text(), QString());
    QVERIFY(is_shown("springs.structural") && is_shown("integrator.method") && is_shown("deformation.rate"));
  }

  void says_when_nothing_matches() {
    auto* nothing = panel().findChild<QLabel*>("nothing");
    QVERIFY(!nothing->isVisible());
    look_for("xyzzy");
    QVERIFY(nothing->isVisible() && nothing->text().contains("xyzzy"));
    QTest::keyClick(search(), Qt::Key_Escape);
    QVERIFY(!nothing->isVisible());
  }

  void opens_collapsed_sections_while_it_lasts() {
    auto* header = section("springs")->findChild<QAbstractButton*>("header");
    QTest::mouseClick(header, Qt::LeftButton);
    QVERIFY(!is_shown("springs.shear"));
    look_for("shear stiffness");
    QVERIFY(is_shown("springs.shear"));
    QTest::keyClick(search(), Qt::Key_Escape);
    QVERIFY(!is_shown("springs.shear"));
  }

  void enter_goes_to_the_first_match() {
    look_for("flexion stiffness");
    QTest::keyClick(search(), Qt::Key_Return);
    QCOMPARE(QApplication::focusWidget(), static_cast<QWidget*>(slider("springs.flexion")));
  }

  void an_edit_that_changes_the_blocks_keeps_the_search() {
    look_for("stiffness");
    doc().addBlock("air");
    QVERIFY(is_shown("springs.shear") && !is_shown("air.drag") && !is_shown("integrator.method"));
  }

  void reveal_and_add_end_a_search() {
    look_for("stiffness");
    QVERIFY(panel().reveal("integrator.method"));
    QVERIFY(is_shown("integrator.method"));
    QCOMPARE(search()->text(), QString());
  }

  void ctrl_f_finds_it_from_anywhere_in_the_window() {
    WindowBench bench;
    bench.window.findChild<QDockWidget*>("parametersDock")->hide();
    QTest::keyClick(&bench.window, Qt::Key_F, Qt::ControlModifier);
    auto* field = bench.window.parameters().findChild<QLineEdit*>("search");
    QTRY_VERIFY_WITH_TIMEOUT(field->isVisible() && field->hasFocus(), patience);
  }
};

const Listed listed{"form_search_test", test_main<FormSearchTest>};

}  // namespace clothlab::test::form_search_test

#include "form_search_test.moc"
