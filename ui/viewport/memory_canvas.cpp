#include "viewport/memory_canvas.h"

#include <QElapsedTimer>
#include <QOpenGLFunctions>
#include <QPainter>

#include "viewport/cloth_view.h"

namespace clothlab {
namespace {

constexpr GLenum gl_bgra = 0x80E1;              // in OpenGL since 1.2; Qt's portable headers lack it
constexpr GLenum gl_pack_invert_mesa = 0x8758;  // of GL_MESA_pack_invert

std::unique_ptr<QOpenGLFramebufferObject> make_target(QSize size, int samples) {
  QOpenGLFramebufferObjectFormat format;
  format.setSamples(samples);
  format.setAttachment(QOpenGLFramebufferObject::CombinedDepthStencil);
  format.setInternalTextureFormat(GL_RGBA8);
  return std::make_unique<QOpenGLFramebufferObject>(size, format);
}

}  // namespace

MemoryCanvas::MemoryCanvas(QWidget* parent, Callbacks callbacks)
    : QWidget(parent), callbacks_(std::move(callbacks)), context_(std::make_unique<QOpenGLContext>()) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setAttribute(Qt::WA_OpaquePaintEvent);
  QSurfaceFormat format = ClothView::surface_format();
  format.setSamples(0);
  surface_.setFormat(format);
  context_->setFormat(format);
  rest_timer_.setSingleShot(true);
  rest_timer_.setInterval(rest_time_ms);
  QObject::connect(&rest_timer_, &QTimer::timeout, this, [this] {
    drawPicture(Quality::smooth);
    update();
  });
}

MemoryCanvas::~MemoryCanvas() {
  if (!initialised_) return;
  makeCurrent();
  plain_.reset();
  multisampled_.reset();
  doneCurrent();
}

bool MemoryCanvas::initialise() {
  if (initialised_ || failed_) return initialised_;
  surface_.create();
  initialised_ = context_->create() && context_->makeCurrent(&surface_);
  failed_ = !initialised_;
  top_row_first_ = initialised_ && context_->hasExtension("GL_MESA_pack_invert");
  callbacks_.initialise();
  return initialised_;
}

QSize MemoryCanvas::pixels() const {
  return (QSizeF(size()) * devicePixelRatioF()).toSize().expandedTo({1, 1});
}

void MemoryCanvas::redraw() {
  stale_ = true;
  rest_timer_.stop();
  update();
}

void MemoryCanvas::setRestDelay(int milliseconds) {
  smooths_at_rest_ = milliseconds >= 0;
  rest_timer_.stop();
  if (!smooths_at_rest_) return;
  rest_timer_.setInterval(milliseconds);
  rest_timer_.start();
}

void MemoryCanvas::drawPicture(Quality quality) {
  if (!initialise()) return;
  makeCurrent();
  if (!plain_ || plain_->size() != pixels()) {
    plain_ = make_target(pixels(), 0);
    multisampled_.reset();
    picture_ = QImage(pixels(), QImage::Format_RGB32);
    picture_.fill(Qt::black);
  }
  picture_.setDevicePixelRatio(devicePixelRatioF());
  const bool smooth = quality == Quality::smooth;
  if (smooth && !multisampled_) multisampled_ = make_target(pixels(), samples);
  stale_ = false;  // before drawing, which may ask for the next picture
  (smooth ? multisampled_ : plain_)->bind();
  context_->functions()->glViewport(0, 0, picture_.width(), picture_.height());
  callbacks_.draw(!smooth);
  if (smooth) {
    QOpenGLFramebufferObject::blitFramebuffer(plain_.get(), multisampled_.get());
    plain_->bind();
  }
  readPicture();
  if (!smooth && !stale_ && smooths_at_rest_) rest_timer_.start();
}

void MemoryCanvas::readPicture() {
  QOpenGLFunctions* gl = context_->functions();
  gl->glPixelStorei(GL_PACK_ALIGNMENT, 4);
  if (top_row_first_) gl->glPixelStorei(gl_pack_invert_mesa, GL_TRUE);
  gl->glReadPixels(0, 0, picture_.width(), picture_.height(), gl_bgra, GL_UNSIGNED_BYTE, picture_.bits());
  if (top_row_first_)
    gl->glPixelStorei(gl_pack_invert_mesa, GL_FALSE);
  else
    picture_ = std::move(picture_).mirrored();
}

void MemoryCanvas::paintEvent(QPaintEvent*) {
  QElapsedTimer timer;
  timer.start();
  const bool drawn = stale_;
  if (stale_) drawPicture(Quality::quick);
  {
    QPainter painter(this);
    painter.drawImage(0, 0, picture_);
    callbacks_.paint_over(painter);
  }
  if (drawn) callbacks_.shown(1e-6 * static_cast<double>(timer.nsecsElapsed()));
}

void MemoryCanvas::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  callbacks_.resized(width(), height());
  redraw();
}

QImage MemoryCanvas::grab() {
  QElapsedTimer timer;
  timer.start();
  drawPicture(Quality::smooth);
  QImage picture = picture_;
  {
    QPainter painter(&picture);
    callbacks_.paint_over(painter);
  }
  callbacks_.shown(1e-6 * static_cast<double>(timer.nsecsElapsed()));
  update();
  return picture;
}

}  // namespace clothlab
