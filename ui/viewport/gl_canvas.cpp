#include "viewport/gl_canvas.h"

#include "viewport/gl/gl_probe.h"
#include "viewport/memory_canvas.h"
#include "viewport/window_canvas.h"

namespace clothlab {

CanvasKind suitable_canvas() {
  return gl_abilities().software ? CanvasKind::memory : CanvasKind::window;
}

std::unique_ptr<GlCanvas> make_canvas(CanvasKind kind, QWidget* parent, GlCanvas::Callbacks callbacks) {
  if (kind == CanvasKind::memory) return std::make_unique<MemoryCanvas>(parent, std::move(callbacks));
  return std::make_unique<WindowCanvas>(parent, std::move(callbacks));
}

}  // namespace clothlab
