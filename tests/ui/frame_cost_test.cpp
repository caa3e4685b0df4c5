// What a picture may cost: nothing uploaded or drawn twice, and no memory taken for one picture after
// another.
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>

#include "listed_test.h"
#include "support/count_allocations.h"
#include "view_fixture.h"
#include "viewport/gl/cloth_renderer.h"

namespace clothlab::test::frame_cost_test {

namespace {

std::shared_ptr<ClothFrame> shifted(const ClothFrame& frame, float by) {
  auto moved = std::make_shared<ClothFrame>(frame);
  for (std::size_t i = 0; i < moved->positions.size(); i += 3) moved->positions[i] += by;
  return moved;
}

/// The mean distance of two pictures' colours, at every third pixel.
double mean_distance(const QImage& a, const QImage& b) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height(); y += 3)
    for (int x = 0; x < a.width(); x += 3, ++count) sum += distance(a.pixelColor(x, y), b.pixelColor(x, y));
  return sum / count;
}

/// A current context and a framebuffer to draw into.
class Offscreen {
 public:
  explicit Offscreen(QSize size) {
    surface_.setFormat(ClothView::surface_format());
    surface_.create();
    context_.setFormat(ClothView::surface_format());
    if (!context_.create() || !context_.makeCurrent(&surface_)) qFatal("no context");
    target_ =
        std::make_unique<QOpenGLFramebufferObject>(size, QOpenGLFramebufferObject::CombinedDepthStencil);
    target_->bind();
    context_.functions()->glViewport(0, 0, size.width(), size.height());
  }
  QImage image() const { return target_->toImage().convertToFormat(QImage::Format_RGB32); }

 private:
  QOffscreenSurface surface_;
  QOpenGLContext context_;
  std::unique_ptr<QOpenGLFramebufferObject> target_;
};

Shot shot_of(const Camera& camera) {
  Shot shot;
  shot.world_to_clip = camera.projection() * camera.view();
  shot.eye = camera.eye();
  shot.right = camera.right();
  shot.up = camera.up();
  shot.forward = camera.forward();
  shot.metres_per_pixel = camera.metres_per_pixel();
  return shot;
}

}  // namespace

class FrameCostTest : public ViewFixture {
  Q_OBJECT

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }
  void init() { open(); }
  void cleanup() { view_.reset(); }

  void a_frame_is_uploaded_once() {
    view_->showFrame(shifted(*flat_cloth(), 0.1F));
    picture();
    QVERIFY(view_->lastUploadMilliseconds() > 0);
    picture();
    QCOMPARE(view_->lastUploadMilliseconds(), 0.0);
    view_->setCameraPose(head_on(2.5));
    picture();
    QCOMPARE(view_->lastUploadMilliseconds(), 0.0);
  }

  void a_kept_picture_is_not_drawn_again_for_what_lies_over_it() {
    view_ = std::make_unique<ClothView>(CanvasKind::memory, nullptr);
    view_->resize(600, 500);
    view_->show();
    QVERIFY(QTest::qWaitForWindowExposed(view_.get()));
    view_->showFrame(flat_cloth());
    view_->setTool(Tool::brush);
    QTest::mouseMove(view_.get(), {100, 100});
    const QImage without_circle = picture();
    QSignalSpy drawn(view_.get(), &ClothView::frameDrawn);
    QMouseEvent move(QEvent::MouseMove, QPointF(300, 250), view_->mapToGlobal(QPointF(300, 250)),
                     Qt::NoButton, Qt::NoButton, {});
    QApplication::sendEvent(view_.get(), &move);
    view_->repaint();
    QVERIFY(drawn.isEmpty());
    QVERIFY(mean_distance(picture(), without_circle) > 0);
  }

  void a_picture_in_memory_is_the_one_in_the_window() {
    const auto picture_on = [](CanvasKind kind) {
      ClothView view(kind, nullptr);
      view.resize(600, 500);
      view.show();
      if (!QTest::qWaitForWindowExposed(&view)) qFatal("the view was never exposed");
      view.showFrame(flat_cloth());
      view.setCameraPose({{0, 0.5, 0}, 3, 0.3, 0.2});
      return view.grabPicture().convertToFormat(QImage::Format_RGB32);
    };
    const QImage memory = picture_on(CanvasKind::memory), window = picture_on(CanvasKind::window);
    QCOMPARE(memory.size(), window.size());
    QVERIFY2(mean_distance(memory, window) < 4, qPrintable(QString::number(mean_distance(memory, window))));
    QVERIFY2(mean_distance(memory, memory.mirrored()) > 8, "upside down would be another picture");
  }

  /// A running cloth changes its look only by a breath when it comes to rest.
  void a_quick_picture_looks_like_a_smooth_one() {
    const auto cloth = flat_cloth(2, 129);
    for (const bool dark : {false, true})
      for (const ViewMode mode : {ViewMode::textured, ViewMode::wireframe, ViewMode::strain}) {
        QImage pictures[2];
        Offscreen target({600, 500});
        ClothRenderer renderer;
        QString problem;
        QVERIFY2(renderer.initialise(true, &problem), qPrintable(problem));
        renderer.set_frame(*cloth);
        Shot shot = shot_of(view_->camera());
        shot.mode = mode;
        for (const bool quick : {false, true}) {
          shot.quick = quick;
          renderer.draw(shot, dark ? dark_theme() : light_theme());
          pictures[quick] = target.image();
        }
        QVERIFY(pictures[0] != pictures[1]);  // there is a quick way
        const double apart = mean_distance(pictures[0], pictures[1]);
        QVERIFY2(apart < 4, qPrintable(QString("mode %1: %2").arg(static_cast<int>(mode)).arg(apart)));
      }
  }

  void drawing_one_frame_after_another_takes_no_memory() {
    const auto first = flat_cloth(1, 65), second = shifted(*first, 0.1F);
    Shot shot = shot_of(view_->camera());
    Offscreen target({300, 200});
    ClothRenderer renderer;
    QString problem;
    QVERIFY2(renderer.initialise(true, &problem), qPrintable(problem));
    for (const ViewMode mode : {ViewMode::textured, ViewMode::wireframe, ViewMode::strain}) {
      shot.mode = mode;
      const auto draw = [&](const ClothFrame& frame) {
        renderer.set_frame(frame);
        renderer.draw(shot, theme());
        QOpenGLContext::currentContext()->functions()->glFinish();
      };
      for (int warm_up = 0; warm_up < 3; ++warm_up) draw(*first), draw(*second);
      const Allocations made = allocations_of([&] { draw(*first), draw(*second); });
      QVERIFY2(made.calls == 0, qPrintable(QString("%1 calls, %2 bytes").arg(made.calls).arg(made.bytes)));
    }
  }

  /// Qt's own events and painters take a little, whatever the cloth's size.
  void what_the_view_takes_for_a_frame_does_not_grow_with_the_cloth() {
    const auto bytes_per_frame = [this](int n) {
      const auto first = flat_cloth(static_cast<std::uint64_t>(n), n), second = shifted(*first, 0.1F);
      const auto show = [this](const std::shared_ptr<ClothFrame>& frame) {
        view_->showFrame(frame);
        view_->repaint();
        QCoreApplication::processEvents();
      };
      for (int warm_up = 0; warm_up < 3; ++warm_up) show(first), show(second);
      return allocations_of([&] { show(first), show(second); }).bytes / 2;
    };
    const std::size_t small = bytes_per_frame(9), large = bytes_per_frame(129);
    QVERIFY2(large < small + 16 * 1024, qPrintable(QString("%1 and %2 bytes").arg(small).arg(large)));
  }
};

const Listed listed{"frame_cost_test", test_main<FrameCostTest>};

}  // namespace clothlab::test::frame_cost_test

#include "frame_cost_test.moc"
