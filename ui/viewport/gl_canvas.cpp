#include "viewport/gl_canvas.h"

#include <QElapsedTimer>
#include <QOpenGLWidget>
#include <QPainter>

#include "viewport/cloth_view.h"
#include "viewport/gl/gl_probe.h"

namespace clothlab {
namespace {

/// The canvas that a graphics card draws on. It is a widget of its own, inside the view, because in Qt 6.4
/// any window that contains a QOpenGLWidget crashes on a display without OpenGL, whether that is ever painted
/// or not; so one must only be made where there is OpenGL.
class WindowCanvas : public QOpenGLWidget, public GlCanvas {
 public:
  WindowCanvas(QWidget* parent, Callbacks callbacks)
      : QOpenGLWidget(parent), callbacks_(std::move(callbacks)) {
    setFormat(ClothView::surface_format());
    setAttribute(Qt::WA_TransparentForMouseEvents);
  }

  QWidget& widget() override { return *this; }
  QOpenGLContext* context() const override { return QOpenGLWidget::context(); }
  void makeCurrent() override { QOpenGLWidget::makeCurrent(); }
  void doneCurrent() override { QOpenGLWidget::doneCurrent(); }
  void redraw() override { update(); }
  void repaintOver() override { update(); }
  QImage grab() override { return grabFramebuffer(); }

 protected:
  void initializeGL() override { callbacks_.initialise(); }
  void resizeGL(int width, int height) override { callbacks_.resized(width, height); }
  /// A graphics card is not waited for, since waiting would slow it: the time is that of handing the picture
  /// over.
  void paintGL() override {
    QElapsedTimer timer;
    timer.start();
    callbacks_.draw(false, 1);
    {
      QPainter painter(this);
      callbacks_.paint_over(painter);
    }
    callbacks_.shown(1e-6 * static_cast<double>(timer.nsecsElapsed()));
  }

 private:
  Callbacks callbacks_;
};

}  // namespace

CanvasKind suitable_canvas() {
  return gl_abilities().software ? CanvasKind::memory : CanvasKind::window;
}

std::unique_ptr<GlCanvas> make_canvas(CanvasKind kind, QWidget* parent, GlCanvas::Callbacks callbacks) {
  if (kind == CanvasKind::memory) return make_memory_canvas(parent, std::move(callbacks));
  return std::make_unique<WindowCanvas>(parent, std::move(callbacks));
}

}  // namespace clothlab
