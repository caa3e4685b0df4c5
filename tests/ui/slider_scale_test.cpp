// Sliders as mathematics: from a position to a value and back.
#include "params/slider_scale.h"

#include <QTest>
#include <algorithm>
#include <cmath>

#include "listed_test.h"
#include "scene/scene_parameters.h"
#include "widgets/numbers.h"

namespace clothlab::test::slider_scale_test {

namespace {

cloth::ParameterInfo scaled(cloth::Scale scale, double from, double to) {
  cloth::ParameterInfo info;
  info.scale = scale;
  info.slider_minimum = from;
  info.slider_maximum = to;
  return info;
}

bool close(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * std::max(std::abs(a), std::abs(b));
}

cloth::Scene full_scene() {
  cloth::Scene scene;
  scene.springs.emplace();
  scene.damping = 0;
  scene.air.emplace().gust.emplace();
  scene.deformation.emplace();
  scene.obstacles.emplace_back();
  return scene;
}

}  // namespace

class SliderScaleTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void log_slider_round_trips() {
    for (const auto& [from, to] : {std::pair(0.0, 1e5), std::pair(1e-6, 0.1), std::pair(0.01, 10.0)}) {
      const SliderScale scale(scaled(cloth::Scale::logarithmic, from, to));
      QCOMPARE(scale.value_at(0), from);
      QCOMPARE(scale.value_at(1), to);
      double last = -1;
      for (int i = 0; i <= 1000; ++i) {
        const double value = scale.value_at(i / 1000.0);
        QVERIFY(value >= last);
        last = value;
        const double again = scale.value_at(scale.position_of(value));
        QVERIFY2(close(value, again, 1e-12), qPrintable(quantity_text(value, {}, cloth::all_digits) + " " +
                                                        quantity_text(again, {}, cloth::all_digits)));
      }
    }
    const SliderScale from_zero(scaled(cloth::Scale::logarithmic, 0, 1));
    QCOMPARE(from_zero.position_of(0), 0.0);
    QVERIFY(from_zero.position_of(1e-9) > from_zero.position_of(0));
  }

  void linear_slider_round_trips() {
    const SliderScale scale(scaled(cloth::Scale::linear, -20, 20));
    for (int i = 0; i <= 1000; ++i) {
      const double value = scale.value_at(i / 1000.0);
      QCOMPARE(scale.value_at(scale.position_of(value)), value);
    }
    QCOMPARE(scale.value_at(0.5), 0.0);
  }

  void a_slider_never_leaves_the_accepted_values() {
    for (const cloth::Parameter& parameter : parameters_of(full_scene())) {
      if (parameter.info.kind != cloth::Kind::number && parameter.info.kind != cloth::Kind::integer) continue;
      const SliderScale scale(parameter.info);
      for (const double position : {0.0, 0.001, 0.02, 0.5, 1.0})
        QVERIFY2(!broken_rule(parameter.info, scale.value_at(position)), parameter.path.c_str());
    }
  }

  void a_step_up_and_a_step_down_cancel() {
    const SliderScale log(scaled(cloth::Scale::logarithmic, 0, 1e5));
    const SliderScale linear(scaled(cloth::Scale::linear, 0, 1));
    for (const double value : {0.0, 12.0, 100.0, 500.0, 9900.0, 1e5})
      QCOMPARE(log.stepped(log.stepped(value, 1), -1), value);
    for (const double value : {0.0, 0.1, 0.3, 0.99})
      QCOMPARE(linear.stepped(linear.stepped(value, 1), -1), value);
    QCOMPARE(linear.stepped(0.1, 2), 0.12);
  }
};

const Listed listed{"slider_scale_test", test_main<SliderScaleTest>};

}  // namespace clothlab::test::slider_scale_test

#include "slider_scale_test.moc"
