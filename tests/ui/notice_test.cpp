// Messages over the views, and what they offer when a run has diverged, by real clicks, keys and drags.
#include <QComboBox>
#include <QFile>
#include <QPushButton>
#include <cmath>

#include "compare_bench.h"
#include "listed_test.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_json.h"
#include "window_bench.h"

namespace clothlab::test::notice_test {
namespace {

QWidget* notice_in(const QWidget& place, const char* kind) {
  return place.findChild<QWidget*>("notice:" + QLatin1String(kind));
}

/// What the buttons of a message say.
QStringList offers(const QWidget& place, const char* kind) {
  QStringList texts;
  if (const QWidget* notice = notice_in(place, kind))
    for (const QPushButton* button : notice->findChildren<QPushButton*>())
      if (button->isVisible()) texts << button->text();
  return texts;
}

void click_offer(const QWidget& place, const char* kind, const QString& text) {
  const QWidget* notice = notice_in(place, kind);
  QVERIFY2(notice, kind);
  for (QPushButton* button : notice->findChildren<QPushButton*>())
    if (button->text() == text) return QTest::mouseClick(button, Qt::LeftButton);
  QVERIFY2(false, qPrintable(text + " is not among: " + offers(place, kind).join(", ")));
}

void close_notice(const QWidget& place, const char* kind) {
  const QWidget* notice = notice_in(place, kind);
  QVERIFY2(notice, kind);
  QTest::mouseClick(notice->findChild<QToolButton*>("noticeClose"), Qt::LeftButton);
}

void type(QWidget* field, const QString& text) {
  field->setFocus();
  QTest::keyClick(field, Qt::Key_A, Qt::ControlModifier);
  QTest::keyClicks(field, text);
  QTest::keyClick(field, Qt::Key_Return);
}

/// So that a run diverges between two looks of the window at its worker.
void go_as_fast_as_possible(QWidget& window) {
  QTest::keyClick(window.findChild<QComboBox*>("speed"), Qt::Key_End);
}

void play_until_it_diverges(WindowBench& bench) {
  bench.click("playButton");
  bench.settle();
  QTRY_VERIFY_WITH_TIMEOUT(bench.status().divergence && !bench.status().playing, 60000);
  bench.settle();
}

/// A cloth whose step was typed and is too long for it.
struct TooLongStep : WindowBench {
  TooLongStep() : WindowBench("corners-free") {
    go_as_fast_as_possible(window);
    type(editor("integrator.time_step", "field"), "0.005");
    settle();
  }
};

cloth::Comparison with_a_pane_that_diverges(const std::vector<std::string>& methods, double step) {
  cloth::Comparison comparison = small_comparison(methods);
  comparison.scene.deformation.reset();  // a limited cloth cannot diverge
  for (std::size_t pane = 1; pane < methods.size(); ++pane)
    cloth::set_own(comparison.panes[pane], "integrator.time_step", step);
  return comparison;
}

}  // namespace

class NoticeTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void a_message_leaves_those_of_other_kinds_and_is_closed_alone() {
    TooLongStep bench;
    QVERIFY(notice_in(bench.window, "stability"));
    bench.click("toolBrushButton");
    const QPoint middle = bench.window.view().rect().center();
    drag(&bench.window.view(), middle, middle + QPoint(60, 0));
    QVERIFY(notice_in(bench.window, "brush"));
    QVERIFY2(notice_in(bench.window, "stability"), "another message took its place");
    close_notice(bench.window, "brush");
    QVERIFY(!notice_in(bench.window, "brush"));
    QVERIFY(notice_in(bench.window, "stability")->isVisible());
    click_offer(bench.window, "stability", "Use auto");
    QVERIFY(!bench.window.document().scene().integrator.time_step);
    QVERIFY(bench.window.notice().text().isEmpty());
  }

  void messages_lie_over_the_view_and_do_not_move_it_data() {
    QTest::addColumn<QSize>("size");
    QTest::addRow("small") << QSize(1000, 650);
    QTest::addRow("usual") << QSize(1400, 850);
  }
  void messages_lie_over_the_view_and_do_not_move_it() {
    QFETCH(const QSize, size);
    WindowBench bench("corners-free");
    bench.window.resize(size);
    QTest::qWait(50);
    const ClothView& view = bench.window.view();
    const auto place = [](const QWidget& w) { return QRect(w.mapToGlobal(QPoint()), w.size()); };
    const QRect before = place(view);
    type(bench.editor("integrator.time_step", "field"), "0.005");
    bench.click("toolBrushButton");
    drag(&bench.window.view(), view.rect().center(), view.rect().center() + QPoint(60, 0));
    QTest::qWait(50);
    QCOMPARE(place(view), before);
    const QRect first = place(*notice_in(bench.window, "stability"));
    const QRect second = place(*notice_in(bench.window, "brush"));
    QVERIFY(before.contains(first) && before.contains(second) && !first.intersects(second));
    for (const char* kind : {"stability", "brush"})
      for (const QWidget* button : notice_in(bench.window, kind)->findChildren<QPushButton*>()) {
        QVERIFY(place(*notice_in(bench.window, kind)).contains(place(*button)));
        QVERIFY(button->width() >= button->sizeHint().width());
      }
  }

  void a_second_divergence_is_said_again() {
    TooLongStep bench;
    for (int time = 0; time < 3; ++time) {
      play_until_it_diverges(bench);
      QVERIFY2(notice_in(bench.window, "divergence"), "nothing says that it diverged");
      QVERIFY(!notice_in(bench.window, "stability"));
      close_notice(bench.window, "divergence");
      QVERIFY(!notice_in(bench.window, "divergence"));
    }
  }

  void a_slider_dragged_after_a_divergence_leaves_the_message_and_what_it_offers() {
    TooLongStep bench;
    play_until_it_diverges(bench);
    QWidget* slider = bench.editor("integrator.time_step", "slider");
    const int y = slider->height() / 2, x = slider->width() * 3 / 4;
    drag(slider, {x, y}, {x + 12, y});
    bench.settle();
    QVERIFY2(notice_in(bench.window, "divergence"), qPrintable(bench.window.notice().text()));
    QVERIFY2(!notice_in(bench.window, "stability"), "a weaker message about the same");
    click_offer(bench.window, "divergence", "Use auto and restart");
    bench.settle();
    QVERIFY(!bench.window.document().scene().integrator.time_step);
    QCOMPARE(bench.status().step, 0);
    QVERIFY(bench.window.notice().text().isEmpty());
    bench.play_until(0.3);
    bench.pause();
    QVERIFY(!bench.status().divergence);
  }

  void a_divergence_is_over_with_a_restart_and_on_the_way_back() {
    TooLongStep bench;
    play_until_it_diverges(bench);
    bench.click("resetButton");
    bench.settle();
    QVERIFY(!notice_in(bench.window, "divergence"));
    QVERIFY2(notice_in(bench.window, "stability"), "the step is still too long");
    play_until_it_diverges(bench);
    QVERIFY(!notice_in(bench.window, "stability"));
    bench.window.timeline().track().setFocus();
    QTest::keyClick(&bench.window.timeline().track(), Qt::Key_Home);
    bench.settle();
    QVERIFY(!notice_in(bench.window, "divergence"));
    QVERIFY(notice_in(bench.window, "stability"));
  }

  void a_run_that_gets_past_the_place_after_an_edit_has_no_message_any_more() {
    TooLongStep bench;
    play_until_it_diverges(bench);
    type(bench.editor("integrator.time_step", "field"), "0.0005");
    bench.settle();
    QVERIFY(notice_in(bench.window, "divergence"));
    QCOMPARE(offers(bench.window, "divergence").front(), QString("Restart with the shorter step"));
    bench.play_until(bench.status().time + 0.2);
    bench.pause();
    QVERIFY(!notice_in(bench.window, "divergence"));
  }

  /// The midpoint rule is stable at any step, but not for a cloth as stiff as this one.
  void where_auto_diverged_it_is_not_offered_but_what_helps() {
    cloth::Scene scene = cloth::builtin_scene("flag");
    scene.integrator = {.method = "implicit-midpoint"};
    scene.cloth.rows = 9;
    scene.cloth.columns = 13;
    scene.springs->structural = 1e6;
    QTemporaryDir folder;
    const QString path = folder.filePath("stiff.scene.json");
    QFile file(path);
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write(QByteArray::fromStdString(cloth::write_scene(scene)));
    file.close();
    WindowBench bench(path);
    go_as_fast_as_possible(bench.window);
    const double step = bench.status().time_step;
    const QStringList expected{"Halve the time step and restart", "Use implicit Euler and restart"};
    play_until_it_diverges(bench);
    QCOMPARE(offers(bench.window, "divergence"), expected);
    click_offer(bench.window, "divergence", expected[0]);
    bench.settle();
    QCOMPARE(bench.status().time_step, 0.5 * step);
    QCOMPARE(bench.status().step, 0);
    QVERIFY(bench.window.notice().text().isEmpty());
    bench.action("undo")->trigger();
    bench.settle();
    play_until_it_diverges(bench);
    click_offer(bench.window, "divergence", expected[1]);
    bench.settle();
    QCOMPARE(bench.window.document().scene().integrator.method, std::string("implicit-euler"));
    QVERIFY(!bench.window.document().scene().integrator.time_step);
    bench.play_until(0.4);
    bench.pause();
    QVERIFY(!bench.status().divergence && !notice_in(bench.window, "divergence"));
  }

  void a_stopped_pane_says_over_its_view_what_would_help_and_does_it() {
    CompareBench bench(with_a_pane_that_diverges({"verlet", "rk4"}, 0.01));
    const QRect view = bench.window.panes().pane(1).view().geometry();
    bench.play_to_the_end();
    QVERIFY(bench.status().panes[1].divergence);
    PaneView& pane = bench.window.panes().pane(1);
    QVERIFY(!notice_in(bench.window.panes().pane(0), "divergence"));
    QVERIFY2(notice_in(pane, "divergence"), "no message over the pane that stopped");
    QCOMPARE(pane.view().geometry(), view);
    QCOMPARE(offers(pane, "divergence").front(), QString("Use auto and restart"));
    click_offer(pane, "divergence", "Use auto and restart");
    bench.settle();
    QVERIFY(!scene_of(bench.comparison(), 1).integrator.time_step);
    QCOMPARE(bench.status().time, 0.0);
    QVERIFY(!notice_in(pane, "divergence"));
    bench.play_to_the_end();
    QVERIFY(!bench.status().panes[1].divergence && !notice_in(pane, "divergence"));
    bench.action("undo")->trigger();
    QCOMPARE(*scene_of(bench.comparison(), 1).integrator.time_step, 0.01);
  }

  void in_a_narrow_pane_all_buttons_of_a_message_can_be_reached() {
    CompareBench bench(with_a_pane_that_diverges({"verlet", "rk4", "rk4", "rk4"}, 0.01));
    bench.window.resize(1000, 650);
    bench.play_to_the_end();
    PaneView& pane = bench.window.panes().pane(1);
    const QWidget* notice = notice_in(pane, "divergence");
    QVERIFY(notice);
    QTest::qWait(50);
    const QRect view(pane.view().mapTo(&pane, QPoint()), pane.view().size());
    for (const QAbstractButton* button : notice->findChildren<QAbstractButton*>()) {
      const QRect at(button->mapTo(&pane, QPoint()), button->size());
      QVERIFY2(at.left() >= view.left() && at.right() <= view.right(), qPrintable(button->text()));
      QVERIFY2(at.width() >= button->sizeHint().width(), qPrintable(button->text()));
    }
  }

  void buttons_of_a_message_stand_side_by_side() {
    TooLongStep bench;
    play_until_it_diverges(bench);
    const QWidget* notice = notice_in(bench.window, "divergence");
    QVERIFY(notice);
    QTest::qWait(50);
    const auto buttons = notice->findChildren<QPushButton*>();
    QCOMPARE(buttons.size(), 2);
    QCOMPARE(buttons[0]->y(), buttons[1]->y());
    QVERIFY(buttons[1]->x() - buttons[0]->geometry().right() <= 2 * spacing);
  }

  void a_pane_that_stops_again_says_so_again() {
    CompareBench bench(with_a_pane_that_diverges({"verlet", "rk4"}, 0.01));
    PaneView& pane = bench.window.panes().pane(1);
    for (int time = 0; time < 2; ++time) {
      bench.play_to_the_end();
      QVERIFY2(notice_in(pane, "divergence"), "nothing says that it stopped");
      close_notice(pane, "divergence");
      QVERIFY(!notice_in(pane, "divergence"));
      QTest::mouseClick(bench.window.findChild<QToolButton*>("resetButton"), Qt::LeftButton);
      bench.settle();
    }
  }

  void play_is_the_primary_button() {
    for (const bool dark : {false, true}) {
      apply_theme(*qApp, dark);
      WindowBench bench;
      for (const bool playing : {false, true}) {
        if (playing) bench.click("playButton");
        bench.settle();
        auto* button = bench.window.findChild<QToolButton*>("playButton");
        QTest::mouseMove(&bench.window.view());  // not over the button
        QTest::qWait(50);
        const QImage image = button->grab().toImage();
        QCOMPARE(image.pixelColor(4, button->height() / 2), theme().accent);
        int of_icon = 0;
        for (int y = 0; y < image.height(); ++y)
          for (int x = 0; x < image.width(); ++x) of_icon += image.pixelColor(x, y) == theme().accent_text;
        QVERIFY2(of_icon > 20, "its icon stands out from the accent");
      }
      bench.pause();
    }
    apply_theme(*qApp, false);
  }
};

const Listed listed{"notice_test", test_main<NoticeTest>};

}  // namespace clothlab::test::notice_test

#include "notice_test.moc"
