// The OpenGL surface inside the view: lends its three callbacks out. It is a widget of its own because in
// Qt 6.4 any window that contains a QOpenGLWidget crashes on a display without OpenGL, whether that is ever
// painted or not; so one must only be made where there is OpenGL.
#pragma once

#include <QOpenGLWidget>
#include <functional>

namespace clothlab {

class GlCanvas : public QOpenGLWidget {
 public:
  struct Callbacks {
    std::function<void()> initialise;
    std::function<void(int width, int height)> resize;
    std::function<void()> paint;
  };

  GlCanvas(QWidget* parent, Callbacks callbacks) : QOpenGLWidget(parent), callbacks_(std::move(callbacks)) {
    setAttribute(Qt::WA_TransparentForMouseEvents);  // the view takes the mouse
  }

 protected:
  void initializeGL() override { callbacks_.initialise(); }
  void resizeGL(int width, int height) override { callbacks_.resize(width, height); }
  void paintGL() override { callbacks_.paint(); }

 private:
  Callbacks callbacks_;
};

}  // namespace clothlab
