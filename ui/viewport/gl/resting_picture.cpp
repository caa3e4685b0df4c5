#include "viewport/gl/resting_picture.h"

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>

namespace clothlab {

void RestingPicture::begin(QSize size) {
  complete_ = false;
  if (!target_ || target_->size() != size) {
    QOpenGLFramebufferObjectFormat format;
    format.setSamples(samples);
    format.setAttachment(QOpenGLFramebufferObject::CombinedDepthStencil);
    format.setInternalTextureFormat(GL_RGBA8);
    target_ = std::make_unique<QOpenGLFramebufferObject>(size, format);
  }
  target_->bind();
}

void RestingPicture::show(GLuint framebuffer) {
  QOpenGLExtraFunctions* gl = QOpenGLContext::currentContext()->extraFunctions();
  const QSize size = target_->size();
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->handle());
  gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  gl->glBlitFramebuffer(0, 0, size.width(), size.height(), 0, 0, size.width(), size.height(),
                        GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl->glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

}  // namespace clothlab
