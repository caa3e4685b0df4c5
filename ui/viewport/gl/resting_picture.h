// A smooth picture kept for as long as nothing in it moves. Where the processor draws, multisampling costs a
// third of a frame: a running cloth is drawn without, and as soon as it rests, once with.
#pragma once

#include <QOpenGLFramebufferObject>
#include <QSize>
#include <memory>

namespace clothlab {

/// The same context must be current whenever a member is called, the destructor included.
class RestingPicture {
 public:
  static constexpr int samples = 4;

  bool holds(QSize size) const { return complete_ && target_->size() == size; }
  void forget() { complete_ = false; }

  /// What is drawn between `begin` and `end` becomes the picture. `size` in device pixels.
  void begin(QSize size);
  void end() { complete_ = true; }

  /// Copies the picture into `framebuffer` and leaves that bound.
  void show(GLuint framebuffer);

 private:
  std::unique_ptr<QOpenGLFramebufferObject> target_;
  bool complete_ = false;
};

}  // namespace clothlab
