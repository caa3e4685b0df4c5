// What four large panes do to the window's thread.
#include <QAction>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <map>

#include "compare_bench.h"
#include "listed_test.h"
#include "patience.h"
#include "support/timed_application.h"
#include "theme/theme.h"
#include "viewport/drawing_turns.h"
#include "viewport/gl/gl_probe.h"
#include "viewport/gl_canvas.h"

namespace clothlab::test::compare_drawing_test {
namespace {

TimedApplication& application() {
  return *static_cast<TimedApplication*>(qApp);
}

cloth::Comparison four_panes(int side) {
  cloth::Comparison comparison = small_comparison({"verlet", "semi-implicit-euler", "rk4", "verlet"});
  comparison.scene = cloth::builtin_scene("corners-free");
  comparison.scene.cloth.rows = comparison.scene.cloth.columns = side;
  return comparison;
}

/// How many pictures each event of the window's thread finished.
class Drawings {
 public:
  explicit Drawings(CompareBench& bench) {
    for (std::size_t i = 0; i < bench.window.panes().paneCount(); ++i)
      QObject::connect(&bench.window.panes().pane(i).view(), &ClothView::frameDrawn, &bench.window,
                       [this, i] {
                         ++in_event_[application().event_number()];
                         ++of_pane_[i];
                       });
  }

  int max_in_an_event() const {
    int most = 0;
    for (const auto& [event, count] : in_event_) most = std::max(most, count);
    return most;
  }
  int of_pane(std::size_t pane) const {
    const auto found = of_pane_.find(pane);
    return found == of_pane_.end() ? 0 : found->second;
  }

 private:
  std::map<std::int64_t, int> in_event_;
  std::map<std::size_t, int> of_pane_;
};

/// Asks for `turns` turns, one after the other, and notes the event of each.
class Patient : public DrawingTurns::Drawer {
 public:
  Patient(int turns, std::vector<std::int64_t>& events) : left_(turns), events_(events) {
    DrawingTurns::ofTheApplication().ask(this);
  }
  ~Patient() { DrawingTurns::ofTheApplication().leave(this); }

  void takeTurn() override {
    events_.push_back(application().event_number());
    if (--left_ > 0) DrawingTurns::ofTheApplication().ask(this);
  }

 private:
  int left_;
  std::vector<std::int64_t>& events_;
};

/// A canvas in a window of its own that shows one colour.
class OneColour {
 public:
  explicit OneColour(QColor colour) : colour_(colour) {
    canvas_ = make_memory_canvas(&window_, {.initialise = [] {},
                                            .resized = [](int, int) {},
                                            .draw = [this](bool, double) { clear(); },
                                            .paint_over = [](QPainter&) {},
                                            .shown = [this](double) { ++shown_; }});
    window_.resize(60, 40);
    canvas_->widget().setGeometry(window_.rect());
    canvas_->setSmoothAtRest(false);
    window_.show();
  }
  ~OneColour() { canvas_.reset(); }

  void redraw() { canvas_->redraw(); }
  int shown() const { return shown_; }
  bool shows_its_colour() { return window_.grab().toImage().pixelColor(30, 20) == colour_; }

 private:
  void clear() {
    QOpenGLFunctions* gl = QOpenGLContext::currentContext()->functions();
    gl->glClearColor(colour_.redF(), colour_.greenF(), colour_.blueF(), 1);
    gl->glClear(GL_COLOR_BUFFER_BIT);
  }

  QColor colour_;
  QWidget window_;
  std::unique_ptr<GlCanvas> canvas_;
  int shown_ = 0;
};

}  // namespace

class CompareDrawingTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() {
    apply_theme(*qApp, false);
    if (!gl_abilities().usable || !gl_abilities().software) QSKIP("the processor does not draw here");
  }

  void each_turn_is_an_event_of_its_own_and_nobody_waits_for_two() {
    std::vector<std::int64_t> events[3];
    Patient first(4, events[0]), second(4, events[1]), gone_early(4, events[2]);
    DrawingTurns::ofTheApplication().leave(&gone_early);
    QTRY_COMPARE_WITH_TIMEOUT(events[1].size(), std::size_t{4}, patience);
    QCOMPARE(events[0].size(), std::size_t{4});
    QVERIFY(events[2].empty());
    for (std::size_t turn = 0; turn < 4; ++turn) {
      QVERIFY(events[0][turn] < events[1][turn]);
      if (turn > 0) QVERIFY(events[1][turn - 1] < events[0][turn]);
    }
  }

  /// All pictures are handed over before the pixels of the first are fetched.
  void each_canvas_shows_its_own_picture() {
    OneColour canvases[] = {OneColour(Qt::red), OneColour(Qt::green), OneColour(Qt::blue)};
    for (int round = 1; round <= 5; ++round) {
      for (OneColour& canvas : canvases) canvas.redraw();
      for (OneColour& canvas : canvases) QTRY_VERIFY_WITH_TIMEOUT(canvas.shown() >= round, patience);
      QTest::qWait(50);
      for (OneColour& canvas : canvases) QVERIFY(canvas.shows_its_colour());
    }
  }

  /// Frames, the camera, a new range of colours, a resize: each asks all panes for a picture at once.
  void no_event_draws_more_than_one_pane() {
    CompareBench bench(four_panes(17));
    QTest::qWait(300);
    Drawings drawings(bench);
    bench.action("modeStrain")->trigger();
    bench.action("play")->trigger();
    QTest::qWait(500);
    drag(&bench.window.panes().pane(0).view(), {20, 60}, {90, 80}, Qt::RightButton);
    bench.window.panes().frameAll();
    bench.window.resize(bench.window.size() - QSize(40, 30));
    QTest::qWait(500);
    bench.action("play")->trigger();
    QTest::qWait(500);
    QCOMPARE(drawings.max_in_an_event(), 1);
    for (std::size_t i = 0; i < 4; ++i) QVERIFY2(drawings.of_pane(i) > 2, "every pane has its turns");
  }

  void what_is_shown_at_rest_is_of_one_time() {
    CompareBench bench(four_panes(17));
    bench.action("play")->trigger();
    QTest::qWait(300);
    bench.action("play")->trigger();
    bench.settle();
    Drawings drawings(bench);
    QTest::qWait(600);
    for (std::size_t i = 0; i < 4; ++i)
      QCOMPARE(bench.window.panes().pane(i).view().frame()->time,
               bench.window.panes().pane(0).view().frame()->time);
    QCOMPARE(bench.window.panes().pane(0).view().frame()->time, bench.status().time);
  }

  /// Prints; how fast the machine is is no law.
  void the_windows_thread_stays_free_with_four_large_panes() {
    CompareBench bench(four_panes(128));
    for (const char* mode : {"modeTextured", "modeStrain"}) {
      bench.action(mode)->trigger();
      bench.action("play")->trigger();
      QTest::qWait(500);
      application().watch();
      QTest::qWait(3000);
      application().stop_watching();
      bench.action("play")->trigger();
      bench.settle();
      const EventTime &longest = application().longest(), &busiest = application().busiest();
      qInfo(
          "four panes of 128 x 128, %s: longest event %.0f ms (%.0f ms of them its own work: %s, type %d); "
          "busiest event %.0f ms of work (%s, type %d)",
          mode, longest.wall, longest.processor, longest.kind.first.c_str(), longest.kind.second,
          busiest.processor, busiest.kind.first.c_str(), busiest.kind.second);
    }
    QVERIFY(bench.status().refusal.empty());
  }
};

const Listed listed{"compare_drawing_test", test_main<CompareDrawingTest, TimedApplication>};

}  // namespace clothlab::test::compare_drawing_test

#include "compare_drawing_test.moc"
