// Numbers as the window shows them: one way to write a quantity, and the locale's decimal comma.
#include "widgets/numbers.h"

#include <QLocale>

#include "compare_bench.h"
#include "listed_test.h"
#include "widgets/reading.h"
#include "window_bench.h"

namespace clothlab::test::numbers_test {

/// German numbers while it lives.
struct German {
  German() { QLocale::setDefault(QLocale(QLocale::German, QLocale::Germany)); }
  ~German() { QLocale::setDefault(QLocale::c()); }
};

class NumbersTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    QLocale::setDefault(QLocale::c());
    apply_theme(*qApp, false);
  }

  void quantities_in_a_sentence_get_prefixes_and_nothing_else_changes() {
    QCOMPARE(sentence_text("in step 31 (t = 0.0076 s) at particle 5: 2.5e-07 J, 12 m/s, 54321.5 N/m"),
             QString("in step 31 (t = 7.6 ms) at particle 5: 0.25 µJ, 12 m/s, 54.3215 kN/m"));
    for (const char* same : {"9 steps", "a/0.005 s", "cloth-0.005.obj", "0.25 of 3 springs", "0.02 s/s",
                             "0.01 seconds", "version 0.3.0", "Eq. (17)"})
      QCOMPARE(sentence_text(same), QString(same));
  }

  void a_decimal_comma_stands_where_the_locale_has_one() {
    const German german;
    QCOMPARE(quantity_text(0.000909091, "s", 3), QString("0,909 ms"));
    QCOMPARE(number_text(1.5e-7, 3), QString("1,5e-7"));
    QCOMPARE(sentence_text("0.0076 s, 1.5 %, up to 2.25."), QString("7,6 ms, 1,5 %, up to 2,25."));
    for (const char* same : {"version 0.3.0", "cloth-0.5.obj", "/tmp/1.5/a", "v1.5", "1.5x"})
      QCOMPARE(localised(same), QString(same));
  }

  void what_is_shown_can_be_typed() {
    const German german;
    for (const double value : {0.000909091, 0.25, 123.456, 5e-9}) {
      const cloth::Quantity again = typed_quantity(quantity_text(value, "s", cloth::all_digits), "s");
      QVERIFY2(again.ok() && again.value == value, again.rule.c_str());
    }
  }

  void counts_are_in_groups_of_three() {
    QCOMPARE(count_text(7), QString("7"));
    QCOMPARE(count_text(123), QString("123"));
    QCOMPARE(count_text(1234567).remove(QChar(0x202f)), QString("1234567"));
    QCOMPARE(count_text(1234567).size(), 9);
  }

  void a_reading_has_room_for_its_widest_text() {
    for (const QString text : {"0.0000 s/s", "0.000 s/s", "8.888 of 88 s", "88.88 ms"}) {
      Reading reading(text, Reading::Look::muted, nullptr);
      reading.ensurePolished();
      const int room = reading.sizeHint().width() - spacing;
      QCOMPARE(reading.fontMetrics().elidedText(text, Qt::ElideRight, room), text);
    }
  }

  void time_is_in_milliseconds_where_a_scene_lasts_some() {
    WindowBench bench("fast-ball");
    bench.action("step")->trigger();
    bench.settle();
    const QString time = reading_of(bench.window);
    QVERIFY2(time.endsWith(" ms") && !time.startsWith("0.00"), qPrintable(time));
    bench.window.openScene("flag");
    bench.settle();
    QCOMPARE(reading_of(bench.window), QString("0.000 s"));
  }

  void a_diverged_run_says_its_steps_with_prefixes() {
    const German german;
    WindowBench bench("corners-free");
    bench.window.document().setParameter("integrator.time_step", 0.0125);
    bench.action("play")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(bench.status().divergence, 60000);
    bench.settle();
    const QString text = bench.window.notice().text();
    QVERIFY2(text.contains("12,5 ms") && !text.contains("0.0125"), qPrintable(text));
  }

  void ranking_and_panes_have_prefixes_and_the_copied_table_has_points() {
    const German german;
    CompareBench bench;
    bench.action("step")->trigger();
    bench.settle();
    const RankingTable& table = bench.window.ranking();
    const QString all = table.asText();
    QVERIFY2(!all.contains(','), qPrintable(all));
    bool any = false;
    for (int row = 0; row < table.rowCount(); ++row)
      for (int column = 0; column < table.columnCount(); ++column)
        any = any || table.item(row, column)->text().endsWith("m");
    QVERIFY(any);
  }

 private:
  static QString reading_of(LabWindow& window) {
    for (const Reading* reading : window.findChild<TransportBar*>()->findChildren<Reading*>())
      if (reading->toolTip() == "Simulated time") return reading->text();
    return {};
  }
};

const Listed listed{"numbers_test", test_main<NumbersTest>};

}  // namespace clothlab::test::numbers_test

#include "numbers_test.moc"
