// The canvas for a processor that draws: a picture in memory, shown like any widget's. Drawing has a turn of
// its own (see DrawingTurns), its pixels are waited for in later events, and painting the window only copies:
// no number of views and no size of them holds the window's thread for more than one of these.
#pragma once

#include <QElapsedTimer>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QTimer>
#include <QWidget>

#include "viewport/drawing_turns.h"
#include "viewport/gl_canvas.h"

namespace clothlab {

class MemoryCanvas : public QWidget, public GlCanvas, private DrawingTurns::Drawer {
 public:
  static constexpr int samples = 4;            ///< of the smooth picture
  static constexpr int fence_interval_ms = 1;  ///< between two looks whether a picture is done
  static constexpr int rest_time_ms = 150;     ///< without a change, until the picture is made smooth

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
  QTimer fence_timer_;

  QImage picture_;
  bool stale_ = true;    // the scene has changed since the picture
  bool waits_to_be_shown_ = false;  // the picture has not been put into the window yet: no other is drawn
  bool rested_ = false;  // a smooth picture is wanted
  QTimer rest_timer_;    // since the last change
  bool smooth_at_rest_ = true;
};

}  // namespace clothlab
