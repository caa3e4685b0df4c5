// The colours of strain and the range they span.
#include "viewport/strain_scale.h"

#include <QTest>
#include <algorithm>
#include <cmath>

#include "listed_test.h"

namespace clothlab::test::strain_scale_test {

class StrainScaleTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void strain_colours_grow_lighter_in_even_steps() {
    double last = -1;
    for (const QColor& c : strain_colours()) {
      const double luminance = 0.2126 * std::pow(c.redF(), 2.2) + 0.7152 * std::pow(c.greenF(), 2.2) +
                               0.0722 * std::pow(c.blueF(), 2.2);
      QVERIFY(luminance > last - 0.002);
      last = std::max(last, luminance);
    }
    QCOMPARE(strain_colour(-1), strain_colours().front());
    QCOMPARE(strain_colour(2), strain_colours().back());
  }

  void the_strain_range_is_round_steady_and_shows_the_rate() {
    QCOMPARE(round_maximum(0.11), 0.12);
    QCOMPARE(round_maximum(0.2), 0.2);
    StrainRange range;
    range.follow(0.19, -1, 0.02);
    QCOMPARE(range.maximum(), 0.2);
    for (int i = 0; i < 20; ++i) range.follow(0.12 + 0.06 * (i % 2), -1, 0.02);
    QCOMPARE(range.maximum(), 0.2);
    range.follow(0.45, -1, 0.02);
    QVERIFY(range.maximum() > 0.2 && range.maximum() < 0.5);  // glides
    for (int i = 0; i < 100; ++i) range.follow(0.45, -1, 0.02);
    QCOMPARE(range.maximum(), 0.5);
    for (int i = 0; i < 50; ++i) range.follow(0.05, -1, 0.02);
    QCOMPARE(range.maximum(), 0.5);  // a second of calm is not enough
    for (int i = 0; i < 200; ++i) range.follow(0.05, -1, 0.02);
    QCOMPARE(range.maximum(), 0.05);
    StrainRange with_rate;
    with_rate.follow(0.04, 0.1, 0.02);
    QVERIFY(with_rate.maximum() > 0.1);
  }
};

const Listed listed{"strain_scale_test", test_main<StrainScaleTest>};

}  // namespace clothlab::test::strain_scale_test

#include "strain_scale_test.moc"
