// The canvas for a processor that draws: a picture in memory, shown like any widget's. Drawing has a turn of
// its own (see DrawingTurns), its pixels are waited for in later events, and painting the window only copies:
// no number of views and no size of them holds the window's thread for more than one of these.
#include <QElapsedTimer>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <QPainter>
#include <QTimer>
#include <QWidget>
#include <utility>

#include "theme/theme.h"
#include "viewport/cloth_view.h"
#include "viewport/drawing_pace.h"
#include "viewport/drawing_turns.h"
#include "viewport/gl_canvas.h"

namespace clothlab {
namespace {

constexpr int smooth_samples = 4;               // of the smooth picture
constexpr int fence_interval_ms = 1;            // between two looks whether a picture is done
constexpr int rest_time_ms = 150;               // without a change, until the picture is made smooth
constexpr GLenum gl_bgra = 0x80E1;              // in OpenGL since 1.2; Qt's portable headers lack it
constexpr GLenum gl_pack_invert_mesa = 0x8758;  // of GL_MESA_pack_invert

std::unique_ptr<QOpenGLFramebufferObject> make_target(QSize size, int samples) {
  QOpenGLFramebufferObjectFormat format;
  format.setSamples(samples);
  format.setAttachment(QOpenGLFramebufferObject::CombinedDepthStencil);
  format.setInternalTextureFormat(GL_RGBA8);
  return std::make_unique<QOpenGLFramebufferObject>(size, format);
}

class MemoryCanvas : public QWidget, public GlCanvas, private DrawingTurns::Drawer {
 public:
  MemoryCanvas(QWidget* parent, Callbacks callbacks);
  ~MemoryCanvas() override;

  QWidget& widget() override { return *this; }
  QOpenGLContext* context() const override { return initialised_ ? &shared_->context : nullptr; }
  void makeCurrent() override { shared_->context.makeCurrent(&shared_->surface); }
  void doneCurrent() override { shared_->context.doneCurrent(); }
  void redraw() override;
  void repaintOver() override { update(); }
  void setSmoothAtRest(bool on) override;
  QImage grab() override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  enum class Quality { quick, smooth };

  /// One for all canvases: the driver translates each program once.
  struct SharedContext {
    QOffscreenSurface surface;
    QOpenGLContext context;

    static std::shared_ptr<SharedContext> of_the_application();
    bool ensure();
  };

  bool initialise();
  QSize pixels() const;
  void askForTurn();
  void takeTurn() override;
  void submit(Quality quality);
  void fetchPicture();
  void dropFence();
  void readPicture();

  Callbacks callbacks_;
  std::shared_ptr<SharedContext> shared_;
  std::unique_ptr<QOpenGLFramebufferObject> plain_, multisampled_;  // the second only once something rested
  bool initialised_ = false, failed_ = false;
  bool top_row_first_ = false;  // the driver can read pictures that way round

  GLsync fence_ = nullptr;  // of a picture that is being drawn
  Quality drawing_ = Quality::quick;
  QElapsedTimer drawing_time_;
  DrawingPace pace_;  // of the quick drawings
  QSize drawn_;       // the part of the target that the picture fills, px
  QTimer fence_timer_;

  QImage picture_;
  bool stale_ = true;               // the scene has changed since the picture
  bool waits_to_be_shown_ = false;  // the picture has not been put into the window yet: no other is drawn
  bool rested_ = false;             // a smooth picture is wanted
  QTimer rest_timer_;               // since the last change
  bool smooth_at_rest_ = true;
};

std::shared_ptr<MemoryCanvas::SharedContext> MemoryCanvas::SharedContext::of_the_application() {
  static std::weak_ptr<SharedContext> known;
  auto shared = known.lock();
  if (!shared) known = shared = std::make_shared<SharedContext>();
  return shared;
}

bool MemoryCanvas::SharedContext::ensure() {
  if (context.isValid()) return true;
  QSurfaceFormat format = ClothView::surface_format();
  format.setSamples(0);
  surface.setFormat(format);
  context.setFormat(format);
  surface.create();
  return context.create();
}

MemoryCanvas::MemoryCanvas(QWidget* parent, Callbacks callbacks)
    : QWidget(parent), callbacks_(std::move(callbacks)), shared_(SharedContext::of_the_application()) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setAttribute(Qt::WA_OpaquePaintEvent);
  fence_timer_.setSingleShot(true);
  fence_timer_.setInterval(fence_interval_ms);
  fence_timer_.setTimerType(Qt::PreciseTimer);
  QObject::connect(&fence_timer_, &QTimer::timeout, this, &MemoryCanvas::fetchPicture);
  rest_timer_.setSingleShot(true);
  rest_timer_.setInterval(rest_time_ms);
  QObject::connect(&rest_timer_, &QTimer::timeout, this, [this] {
    rested_ = true;
    askForTurn();
  });
}

MemoryCanvas::~MemoryCanvas() {
  DrawingTurns::ofTheApplication().leave(this);
  if (!initialised_) return;
  makeCurrent();
  dropFence();
  plain_.reset();
  multisampled_.reset();
  doneCurrent();
}

bool MemoryCanvas::initialise() {
  if (initialised_ || failed_) return initialised_;
  initialised_ = shared_->ensure() && shared_->context.makeCurrent(&shared_->surface);
  failed_ = !initialised_;
  top_row_first_ = initialised_ && shared_->context.hasExtension("GL_MESA_pack_invert");
  callbacks_.initialise();
  return initialised_;
}

QSize MemoryCanvas::pixels() const {
  return (QSizeF(size()) * devicePixelRatioF()).toSize().expandedTo({1, 1});
}

void MemoryCanvas::redraw() {
  stale_ = true;
  rested_ = false;
  rest_timer_.stop();
  askForTurn();
}

/// A hidden picture is drawn once it is painted.
void MemoryCanvas::askForTurn() {
  if (!waits_to_be_shown_ && !fence_ && isVisible()) DrawingTurns::ofTheApplication().ask(this);
}

/// Hands the drawing over. OpenGL's own threads fill the pixels; waiting for them here would hold the window.
void MemoryCanvas::takeTurn() {
  if ((!stale_ && !rested_) || fence_ || failed_) return;
  if (!initialised_) {  // which takes long enough for a turn
    initialise();
    return askForTurn();
  }
  drawing_time_.start();
  drawing_ = stale_ ? Quality::quick : Quality::smooth;
  rested_ = false;
  makeCurrent();
  submit(drawing_);
  fence_ = shared_->context.extraFunctions()->glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  shared_->context.functions()->glFlush();
  fence_timer_.start();
}

void MemoryCanvas::fetchPicture() {
  makeCurrent();
  QOpenGLExtraFunctions* gl = shared_->context.extraFunctions();
  if (gl->glClientWaitSync(fence_, 0, 0) == GL_TIMEOUT_EXPIRED) {
    fence_timer_.start();
    return;
  }
  dropFence();
  readPicture();
  waits_to_be_shown_ = true;
  update();
  if (drawing_ == Quality::smooth) return;
  if (!stale_ && smooth_at_rest_) rest_timer_.start();
  const double taken = 1e-6 * static_cast<double>(drawing_time_.nsecsElapsed());
  pace_.drew(taken);
  DrawingTurns& turns = DrawingTurns::ofTheApplication();
  turns.leaveFree(pace_.pause(turns.runIsBehind()));
  callbacks_.shown(taken);
}

void MemoryCanvas::dropFence() {
  fence_timer_.stop();
  if (fence_) shared_->context.extraFunctions()->glDeleteSync(std::exchange(fence_, nullptr));
}

void MemoryCanvas::setSmoothAtRest(bool on) {
  if (on == smooth_at_rest_) return;
  smooth_at_rest_ = on;
  rested_ = false;
  rest_timer_.stop();
  if (on && !stale_) rest_timer_.start();
}

/// Leaves the picture in `plain_`. With a current context.
void MemoryCanvas::submit(Quality quality) {
  if (!plain_ || plain_->size() != pixels()) {
    plain_ = make_target(pixels(), 0);
    multisampled_.reset();
  }
  const bool smooth = quality == Quality::smooth;
  if (smooth && !multisampled_) multisampled_ = make_target(pixels(), smooth_samples);
  stale_ = false;  // before drawing, which may ask for the next picture
  (smooth ? multisampled_ : plain_)->bind();
  const double fineness = smooth ? 1 : pace_.fineness();
  drawn_ = (QSizeF(plain_->size()) * fineness).toSize().expandedTo({1, 1});
  shared_->context.functions()->glViewport(0, 0, drawn_.width(), drawn_.height());
  callbacks_.draw(!smooth, fineness);
  if (smooth) QOpenGLFramebufferObject::blitFramebuffer(plain_.get(), multisampled_.get());
}

/// Another canvas may have drawn meanwhile, and have left its framebuffer bound.
void MemoryCanvas::readPicture() {
  plain_->bind();
  if (picture_.size() != drawn_) picture_ = QImage(drawn_, QImage::Format_RGB32);
  QOpenGLFunctions* gl = shared_->context.functions();
  gl->glPixelStorei(GL_PACK_ALIGNMENT, 4);
  if (top_row_first_) gl->glPixelStorei(gl_pack_invert_mesa, GL_TRUE);
  gl->glReadPixels(0, 0, picture_.width(), picture_.height(), gl_bgra, GL_UNSIGNED_BYTE, picture_.bits());
  if (top_row_first_)
    gl->glPixelStorei(gl_pack_invert_mesa, GL_FALSE);
  else
    picture_ = std::move(picture_).mirrored();
}

void MemoryCanvas::paintEvent(QPaintEvent*) {
  waits_to_be_shown_ = false;
  QPainter painter(this);
  if (picture_.isNull()) {
    QLinearGradient empty(0, 0, 0, height());
    empty.setColorAt(0, theme().view_top);
    empty.setColorAt(1, theme().view_bottom);
    painter.fillRect(rect(), empty);
  } else {
    painter.setRenderHint(QPainter::SmoothPixmapTransform, picture_.size() != pixels());
    painter.drawImage(QRectF(rect()), picture_);  // of another size until its turn comes
    callbacks_.paint_over(painter);
  }
  if (stale_) askForTurn();
}

void MemoryCanvas::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  callbacks_.resized(width(), height());
  redraw();
}

QImage MemoryCanvas::grab() {
  QElapsedTimer timer;
  timer.start();
  if (initialise()) {
    makeCurrent();
    dropFence();
    submit(Quality::smooth);
    readPicture();
  }
  QImage picture = picture_;
  picture.setDevicePixelRatio(devicePixelRatioF());
  {
    QPainter painter(&picture);
    callbacks_.paint_over(painter);
  }
  callbacks_.shown(1e-6 * static_cast<double>(timer.nsecsElapsed()));
  update();
  return picture;
}

}  // namespace

std::unique_ptr<GlCanvas> make_memory_canvas(QWidget* parent, GlCanvas::Callbacks callbacks) {
  return std::make_unique<MemoryCanvas>(parent, std::move(callbacks));
}

}  // namespace clothlab
