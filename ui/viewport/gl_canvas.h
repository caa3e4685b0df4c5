// The widget inside the view that shows its OpenGL picture. There are two kinds, because their costs differ:
//
//   window  A graphics card draws into the window itself (QOpenGLWidget).
//   memory  For a processor that draws. A window that contains a QOpenGLWidget is slow there as a whole: with
//           any label's change all its pixels go through OpenGL again. So the picture is drawn into memory
//           and put into the window like any other widget's. It is kept, too: what lies over it changes
//           without drawing it again, and several views take turns. And as multisampling costs a third of a
//           frame there, a running cloth is drawn without and quickly, and once properly when it rests.
//           Drawings that take long give way to everything else, see DrawingPace.
//
// Either is a child of the view and shows the same picture.
#pragma once

#include <QImage>
#include <functional>
#include <memory>

class QOpenGLContext;
class QPainter;
class QWidget;

namespace clothlab {

enum class CanvasKind { window, memory };

/// The kind that suits this machine's OpenGL. Needs a QGuiApplication.
CanvasKind suitable_canvas();

class GlCanvas {
 public:
  struct Callbacks {
    std::function<void()> initialise;                    ///< with a current context, or none: it failed
    std::function<void(int width, int height)> resized;  ///< device-independent px
    /// Draws into the bound framebuffer, whose width and height are that part of the view's device pixels.
    std::function<void(bool quick, double fineness)> draw;
    std::function<void(QPainter& painter)> paint_over;  ///< what lies over the picture
    std::function<void(double milliseconds)> shown;     ///< the picture is complete; how long it took, ms
  };

  virtual ~GlCanvas() = default;

  /// Child of the view; owned by the canvas; lets the mouse through.
  virtual QWidget& widget() = 0;
  /// None before `initialise` has been called.
  virtual QOpenGLContext* context() const = 0;
  virtual void makeCurrent() = 0;
  virtual void doneCurrent() = 0;

  /// The scene has changed: draws soon. Also from within `draw`, for an animation.
  virtual void redraw() = 0;
  /// Only what lies over the picture has changed.
  virtual void repaintOver() = 0;

  /// Where the processor draws: whether the picture is made smooth a moment after the last change.
  virtual void setSmoothAtRest(bool) {}

  /// The smooth picture as it is now, with what lies over it; in device pixels.
  virtual QImage grab() = 0;
};

std::unique_ptr<GlCanvas> make_memory_canvas(QWidget* parent, GlCanvas::Callbacks callbacks);
/// `parent` is the view.
std::unique_ptr<GlCanvas> make_canvas(CanvasKind kind, QWidget* parent, GlCanvas::Callbacks callbacks);

}  // namespace clothlab
