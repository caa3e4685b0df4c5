// The canvas that a graphics card draws on. It is a widget of its own, inside the view, because in Qt 6.4 any
// window that contains a QOpenGLWidget crashes on a display without OpenGL, whether that is ever painted or
// not; so one must only be made where there is OpenGL.
#pragma once

#include <QElapsedTimer>
#include <QOpenGLWidget>

#include "viewport/gl_canvas.h"

namespace clothlab {

class WindowCanvas : public QOpenGLWidget, public GlCanvas {
 public:
  WindowCanvas(QWidget* parent, Callbacks callbacks);

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
  void paintGL() override;

 private:
  Callbacks callbacks_;
};

}  // namespace clothlab
