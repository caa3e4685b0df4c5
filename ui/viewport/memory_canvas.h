// The canvas for a processor that draws: a picture in memory, shown like any widget's.
#pragma once

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QTimer>
#include <QWidget>

#include "viewport/gl_canvas.h"

namespace clothlab {

class MemoryCanvas : public QWidget, public GlCanvas {
 public:
  static constexpr int samples = 4;         ///< of the smooth picture
  static constexpr int rest_time_ms = 150;  ///< without a change, until the picture is made smooth

  MemoryCanvas(QWidget* parent, Callbacks callbacks);
  ~MemoryCanvas() override;

  QWidget& widget() override { return *this; }
  QOpenGLContext* context() const override { return initialised_ ? context_.get() : nullptr; }
  void makeCurrent() override { context_->makeCurrent(&surface_); }
  void doneCurrent() override { context_->doneCurrent(); }
  void redraw() override;
  void repaintOver() override { update(); }
  void setRestDelay(int milliseconds) override;
  QImage grab() override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  enum class Quality { quick, smooth };

  bool initialise();
  QSize pixels() const;
  /// Into `picture_`.
  void drawPicture(Quality quality);
  void readPicture();

  Callbacks callbacks_;
  QOffscreenSurface surface_;
  std::unique_ptr<QOpenGLContext> context_;
  std::unique_ptr<QOpenGLFramebufferObject> plain_, multisampled_;  // the second only once something rested
  bool initialised_ = false, failed_ = false;
  bool top_row_first_ = false;  // the driver can read pictures that way round

  QImage picture_;
  bool stale_ = true;  // the scene has changed since the picture
  QTimer rest_timer_;  // since the last change
  bool smooths_at_rest_ = true;
};

}  // namespace clothlab
