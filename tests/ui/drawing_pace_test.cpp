// Where drawing takes long it gives way: fewer pictures, of fewer pixels, and all of them again at rest.
#include "viewport/drawing_pace.h"

#include <QElapsedTimer>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QTest>
#include <QThread>
#include <array>
#include <limits>

#include "bridge/worker_status.h"
#include "listed_test.h"
#include "patience.h"
#include "theme/theme.h"
#include "viewport/drawing_turns.h"
#include "viewport/gl/gl_probe.h"
#include "viewport/gl_canvas.h"

namespace clothlab::test::drawing_pace_test {
namespace {

constexpr double long_ms = DrawingPace::long_ms;

/// A canvas whose drawings take as long as they are told to, and what each of them was like.
class SlowCanvas {
 public:
  struct Drawing {
    bool quick;
    double fineness;
    QSize viewport;
    qint64 begun;  // ms
  };

  explicit SlowCanvas(int milliseconds) : milliseconds_(milliseconds) {
    clock_.start();
    canvas_ =
        make_memory_canvas(&window_, {.initialise = [] {},
                                      .resized = [](int, int) {},
                                      .draw = [this](bool quick, double fineness) { draw(quick, fineness); },
                                      .paint_over = [](QPainter&) {},
                                      .shown = [this](double) { moving_ ? canvas_->redraw() : void(); }});
    window_.resize(200, 100);
    canvas_->widget().setGeometry(window_.rect());
    window_.show();
  }
  ~SlowCanvas() { canvas_.reset(); }

  void setMoving(bool on) {
    moving_ = on;
    if (on) canvas_->redraw();
  }
  const std::vector<Drawing>& drawings() const { return drawings_; }
  QImage grab() { return canvas_->grab(); }

 private:
  void draw(bool quick, double fineness) {
    std::array<int, 4> area{};
    QOpenGLFunctions* gl = QOpenGLContext::currentContext()->functions();
    gl->glGetIntegerv(GL_VIEWPORT, area.data());
    drawings_.push_back({quick, fineness, {area[2], area[3]}, clock_.elapsed()});
    gl->glClearColor(0.2F, 0.4F, 0.6F, 1);
    gl->glClear(GL_COLOR_BUFFER_BIT);
    QThread::msleep(static_cast<unsigned long>(milliseconds_));
  }

  int milliseconds_;
  QElapsedTimer clock_;
  bool moving_ = false;
  QWidget window_;
  std::unique_ptr<GlCanvas> canvas_;
  std::vector<Drawing> drawings_;
};

}  // namespace

class DrawingPaceTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }

  void long_drawings_leave_two_thirds_of_the_time_free() {
    DrawingPace pace;
    pace.drew(0.9 * long_ms);
    QCOMPARE(pace.pause(false), 0.0);
    pace.drew(2 * long_ms);
    QCOMPARE(pace.pause(false), 4 * long_ms);
    pace.drew(100 * long_ms);
    QVERIFY2(pace.pause(false) <= 200, "what held up one drawing does not hold up the next for long");
    pace.drew(0.9 * long_ms);
    QCOMPARE(pace.pause(false), 0.0);
  }

  void a_run_that_is_behind_the_clock_has_two_thirds_of_the_time_beside_short_drawings_too() {
    DrawingPace pace;
    pace.drew(0.3 * long_ms);
    QCOMPARE(pace.pause(false), 0.0);
    QCOMPARE(pace.pause(true), 0.6 * long_ms);
    WorkerStatus status;
    status.playing = true, status.speed = 1, status.real_time_factor = 0.12;
    QVERIFY(status.is_behind());
    status.speed = 0.1;
    QVERIFY2(!status.is_behind(), "slow motion that is kept");
    status.speed = std::numeric_limits<double>::infinity();
    QVERIFY(status.is_behind());
    status.real_time_factor = 3;
    QVERIFY2(!status.is_behind(), "as fast as possible, and faster than life");
    status.real_time_factor = 0;
    QVERIFY2(!status.is_behind(), "not measured yet");
    status.real_time_factor = 0.12, status.playing = false;
    QVERIFY(!status.is_behind());
  }

  void drawings_of_a_run_that_is_behind_lie_apart() {
    if (!gl_abilities().usable || !gl_abilities().software) QSKIP("the processor does not draw here");
    constexpr int taken = 8;  // ms
    DrawingTurns::ofTheApplication().setRunIsBehind(true);
    SlowCanvas canvas(taken);
    canvas.setMoving(true);
    QTRY_VERIFY_WITH_TIMEOUT(canvas.drawings().size() > 5, patience);
    canvas.setMoving(false);
    DrawingTurns::ofTheApplication().setRunIsBehind(false);
    for (std::size_t k = 1; k < 5; ++k)
      QVERIFY(canvas.drawings()[k].begun - canvas.drawings()[k - 1].begun >= 3 * taken - 2);  // whole ms
  }

  void several_long_drawings_make_the_picture_coarser_and_short_ones_finer() {
    DrawingPace pace;
    for (const double taken : {3.0, 3.0, 0.5, 3.0, 3.0}) pace.drew(taken * long_ms);
    QCOMPARE(pace.fineness(), 1.0);  // not one after another
    pace.drew(3 * long_ms);
    QVERIFY(pace.fineness() > 0.7 && pace.fineness() < 0.72);
    for (int drawing = 0; drawing < 20; ++drawing) pace.drew(3 * long_ms);
    QCOMPARE(pace.fineness(), 0.5);
    for (int drawing = 0; drawing < 20; ++drawing) pace.drew(0.7 * long_ms);
    QVERIFY2(pace.fineness() == 0.5, "twice the pixels would take too long again");
    for (int drawing = 0; drawing < 20; ++drawing) pace.drew(0.1 * long_ms);
    QCOMPARE(pace.fineness(), 1.0);
  }

  void a_slow_picture_is_coarse_while_it_moves_and_whole_at_rest() {
    if (!gl_abilities().usable || !gl_abilities().software) QSKIP("the processor does not draw here");
    SlowCanvas canvas(static_cast<int>(1.5 * long_ms));
    canvas.setMoving(true);
    QTRY_VERIFY_WITH_TIMEOUT(!canvas.drawings().empty() && canvas.drawings().back().fineness == 0.5,
                             patience);
    QVERIFY(canvas.drawings().front().fineness == 1);
    const QSize coarse = canvas.drawings().back().viewport, whole = canvas.drawings().front().viewport;
    QCOMPARE(coarse, whole / 2);
    QCOMPARE(canvas.grab().size(), whole);
    canvas.setMoving(false);
    QTRY_VERIFY_WITH_TIMEOUT(!canvas.drawings().back().quick, patience);
    QTest::qWait(400);  // nothing comes after it
    QVERIFY(!canvas.drawings().back().quick);
    QCOMPARE(canvas.drawings().back().viewport, whole);
  }
};

const Listed listed{"drawing_pace_test", test_main<DrawingPaceTest>};

}  // namespace clothlab::test::drawing_pace_test

#include "drawing_pace_test.moc"
