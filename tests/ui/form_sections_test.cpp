// Which sections the parameter panel has, and what of it survives when they come and go.
#include "form_fixture.h"
#include "listed_test.h"

namespace clothlab::test::form_sections_test {
using cloth::Vec3;

class FormSectionsTest : public FormFixture {
  Q_OBJECT

 private Q_SLOTS:
  void init() { open(); }
  void cleanup() { close(); }

  void only_present_blocks_have_a_section() {
    QVERIFY(section("springs") && section("gravity") && section("cloth") && section("integrator"));
    QVERIFY(!section("air") && !section("damping") && !section("obstacles.0"));
    QVERIFY(section("springs")->findChild<QToolButton*>("remove"));
    QVERIFY(!section("cloth")->findChild<QToolButton*>("remove"));
    for (const cloth::Parameter& parameter : parameters_of(doc().scene()))
      QVERIFY2(panel().findChild<QWidget*>("param:" + QString::fromStdString(parameter.path)),
               parameter.path.c_str());
  }

  void add_menu_brings_wind_and_the_cross_takes_it_out() {
    auto* button = panel().findChild<QToolButton*>("add");
    auto* menu = panel().findChild<QMenu*>("addMenu");
    QTimer::singleShot(50, menu, [menu] {
      menu->setActiveAction(menu->findChild<QAction*>("offer:air"));
      QTest::keyClick(menu, Qt::Key_Return);
    });
    QTest::mouseClick(button, Qt::LeftButton);  // returns when the menu has closed
    QVERIFY(doc().scene().air.has_value());
    QVERIFY(section("air"));
    QVERIFY(!menu->findChild<QAction*>("offer:air"));
    auto* cross = section("air")->findChild<QToolButton*>("remove");
    panel().findChild<QScrollArea*>("scroll")->ensureWidgetVisible(cross);
    QTest::mouseClick(cross, Qt::LeftButton);
    QVERIFY(!doc().scene().air);
    QVERIFY(!section("air"));
    QVERIFY(menu->findChild<QAction*>("offer:air"));
    QCOMPARE(undo().count(), 2);
  }

  void removing_an_obstacle_does_not_hand_its_typed_text_to_the_next() {
    doc().addBlock("sphere");
    doc().addBlock("sphere");
    QLineEdit* radius = field("obstacles.0.radius");
    radius->setFocus();
    radius->selectAll();
    QTest::keyClicks(radius, "0.9");
    doc().removeBlock("obstacles.0");
    QCoreApplication::processEvents();
    QCOMPARE(doc().scene().obstacles.size(), std::size_t(1));
    QVERIFY(doc().scene().obstacles[0].radius != 0.9);
  }

  void the_form_follows_in_place_and_keeps_focus_scroll_and_collapsed_sections() {
    panel().resize(320, 400);
    QPointer<QLineEdit> focused = field("deformation.rate");
    focused->setFocus();
    QTest::mouseClick(section("springs")->findChild<QAbstractButton*>("header"), Qt::LeftButton);
    QVERIFY(!slider("springs.structural")->isVisible());
    auto* bar = panel().findChild<QScrollArea*>("scroll")->verticalScrollBar();
    QCoreApplication::processEvents();
    bar->setValue(60);
    doc().setParameter("deformation.rate", 0.2);
    doc().addBlock("air");
    doc().removeBlock("gravity");
    QVERIFY(focused && focused->hasFocus());
    QCOMPARE(focused->text(), QString("0.2"));
    QVERIFY(!slider("springs.structural")->isVisible());
    QCOMPARE(bar->value(), 60);
    doc().load(doc().scene());
    QVERIFY(!slider("springs.structural")->isVisible());
    QVERIFY(field("deformation.rate")->hasFocus());
    QCOMPARE(bar->value(), 60);
  }

  void reset_returns_the_declared_default() {
    auto* reset = part<QToolButton>("springs.structural", "reset");
    const double fallback = std::get<double>(*cloth::default_of(doc().scene(), "springs.structural"));
    doc().setParameter("springs.structural", fallback + 1);
    QVERIFY(reset->isVisible());
    QTest::mouseClick(reset, Qt::LeftButton);
    QCOMPARE(structural(), fallback);
    QVERIFY(!reset->isVisible());
  }

  void the_default_of_an_obstacle_goes_with_the_cloth() {
    doc().addBlock("sphere");
    QVERIFY(!part<QToolButton>("obstacles.0.radius", "reset")->isVisible());
    doc().setParameter("cloth.width", 2.0);
    QVERIFY(part<QToolButton>("obstacles.0.radius", "reset")->isVisible());
    doc().resetParameter("obstacles.0.radius");
    QCOMPARE(doc().scene().obstacles[0].radius, 0.5);
    QVERIFY(!part<QToolButton>("obstacles.0.radius", "reset")->isVisible());
  }

  void a_note_survives_a_new_form() {
    panel().setNote("integrator.time_step", "auto: 0.42 ms");
    QVERIFY(part<QLabel>("integrator.time_step", "note")->isVisible());
    doc().load(plain_scene());
    QCOMPARE(part<QLabel>("integrator.time_step", "note")->text(), QString("auto: 0.42 ms"));
    panel().setNote("integrator.time_step", {});
    QVERIFY(!part<QLabel>("integrator.time_step", "note")->isVisible());
  }
};

const Listed listed{"form_sections_test", test_main<FormSectionsTest>};

}  // namespace clothlab::test::form_sections_test

#include "form_sections_test.moc"
