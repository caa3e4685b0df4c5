#include "viewport/window_canvas.h"

#include <QPainter>

#include "viewport/cloth_view.h"

namespace clothlab {

WindowCanvas::WindowCanvas(QWidget* parent, Callbacks callbacks)
    : QOpenGLWidget(parent), callbacks_(std::move(callbacks)) {
  setFormat(ClothView::surface_format());
  setAttribute(Qt::WA_TransparentForMouseEvents);
}

/// A graphics card is not waited for, since waiting would slow it: the time is that of handing the picture
/// over.
void WindowCanvas::paintGL() {
  QElapsedTimer timer;
  timer.start();
  callbacks_.draw(false);
  {
    QPainter painter(this);
    callbacks_.paint_over(painter);
  }
  callbacks_.shown(1e-6 * static_cast<double>(timer.nsecsElapsed()));
}

}  // namespace clothlab
