#include "viewport/gl/contact_layer.h"

#include <QMatrix4x4>
#include <QOpenGLShaderProgram>
#include <QVector2D>
#include <algorithm>
#include <array>

#include "theme/theme.h"
#include "viewport/gl/renderer_kit.h"
#include "viewport/gl/shader_program.h"

namespace clothlab {
namespace {

constexpr GLsizei floats_of_mark = 7, floats_of_box = 6;

void* offset(std::size_t floats) {
  return reinterpret_cast<void*>(floats * sizeof(float));
}

/// Away from the cloth's cream and red and from all colours of strain.
QColor touch_colour(const Theme& theme) {
  return theme.dark ? QColor(0xFF, 0x6E, 0xC7) : QColor(0xC2, 0x18, 0x7A);
}
QColor cloth_box_colour(const Theme& theme) {
  return theme.dark ? QColor(0x4F, 0xD1, 0xC5) : QColor(0x00, 0x7A, 0x70);
}
QColor obstacle_box_colour(const Theme& theme) {
  return theme.dark ? QColor(0xFF, 0xB9, 0x57) : QColor(0xA8, 0x5A, 0x00);
}

QVector2D viewport(QOpenGLFunctions_3_3_Core& gl) {
  std::array<GLint, 4> area{};
  gl.glGetIntegerv(GL_VIEWPORT, area.data());
  return {static_cast<float>(area[2]), static_cast<float>(area[3])};
}

}  // namespace

ContactLayer::ContactLayer(QOpenGLFunctions_3_3_Core& gl) : gl_(gl) {
  for (GLuint* array : {&dot_array_, &line_array_, &box_array_}) gl_.glGenVertexArrays(1, array);
  gl_.glGenBuffers(1, &marks_);
  gl_.glGenBuffers(1, &boxes_);
  constexpr GLsizei stride = floats_of_mark * static_cast<GLsizei>(sizeof(float));
  gl_.glBindBuffer(GL_ARRAY_BUFFER, marks_);
  gl_.glBindVertexArray(dot_array_);
  gl_.glEnableVertexAttribArray(0);
  gl_.glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, nullptr);
  gl_.glBindVertexArray(line_array_);
  const std::array<GLint, 3> components{3, 3, 1};
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    gl_.glEnableVertexAttribArray(attribute);
    gl_.glVertexAttribPointer(attribute, components[attribute], GL_FLOAT, GL_FALSE, stride,
                              offset(3 * attribute));
    gl_.glVertexAttribDivisor(attribute, 1);
  }
  gl_.glBindVertexArray(0);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
}

ContactLayer::~ContactLayer() {
  for (GLuint* array : {&dot_array_, &line_array_, &box_array_}) gl_.glDeleteVertexArrays(1, array);
  gl_.glDeleteBuffers(1, &marks_);
  gl_.glDeleteBuffers(1, &boxes_);
}

void ContactLayer::upload(const ClothFrame& frame) {
  const ContactPicture& picture = frame.contact;
  mark_count_ = static_cast<GLsizei>(picture.marks.size()) / floats_of_mark;
  groups_ = picture.groups;
  if (!groups_.empty()) poses_ = frame.poses;
  const auto give = [this](GLuint buffer, const std::vector<float>& values) {
    if (values.empty()) return;
    gl_.glBindBuffer(GL_ARRAY_BUFFER, buffer);
    gl_.glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data(),
                     GL_STREAM_DRAW);
    gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
  };
  give(marks_, picture.marks);
  give(boxes_, picture.boxes);
}

void ContactLayer::draw(RendererKit& kit, const View& view, const Theme& theme) {
  if (mark_count_ == 0 && groups_.empty()) return;
  for (const Pass& pass : {Pass{GL_GREATER, 0.16F}, Pass{GL_LEQUAL, 0.9F}}) {
    gl_.glDepthFunc(pass.depth);
    draw_boxes(kit.contact_box, view, theme, pass);
    draw_normals(kit.contact_line, view, theme, pass);
  }
  draw_dots(kit.marker, view, theme);
  gl_.glDepthFunc(GL_LESS);
}

/// Instances from a box on: OpenGL 3.3 has no first instance.
void ContactLayer::use_box_buffer(int first) {
  gl_.glBindVertexArray(box_array_);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, boxes_);
  for (GLuint attribute = 0; attribute < 2; ++attribute) {
    gl_.glEnableVertexAttribArray(attribute);
    gl_.glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, floats_of_box * sizeof(float),
                              offset(static_cast<std::size_t>(first) * floats_of_box + 3 * attribute));
    gl_.glVertexAttribDivisor(attribute, 1);
  }
  gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void ContactLayer::draw_boxes(QOpenGLShaderProgram& program, const View& view, const Theme& theme,
                              const Pass& pass) {
  constexpr GLsizei vertices_of_box = 72;
  if (groups_.empty()) return;
  program.bind();
  program.setUniformValue("world_to_clip", uniform_matrix(view.world_to_clip));
  program.setUniformValue("viewport", viewport(gl_));
  program.setUniformValue("width", static_cast<float>(1.2 * view.pixel_ratio));
  program.setUniformValue("opacity", 0.8F * pass.opacity);
  int first = 0;
  for (const ContactPicture::Boxes& group : groups_) {
    const auto k = static_cast<std::size_t>(group.obstacle);
    const bool of_cloth = group.obstacle < 0;
    const cloth::Pose pose = of_cloth || k >= poses_.size() ? cloth::Pose{} : poses_[k];
    program.setUniformValue("turn",
                            uniform_matrix(Eigen::Matrix3d(pose.rotation * pose.stretch.asDiagonal())));
    program.setUniformValue("shift", uniform_vector(pose.translation));
    program.setUniformValue("line_colour",
                            as_srgb(of_cloth ? cloth_box_colour(theme) : obstacle_box_colour(theme)));
    use_box_buffer(first);
    gl_.glDrawArraysInstanced(GL_TRIANGLES, 0, vertices_of_box, group.count);
    first += group.count;
  }
  gl_.glBindVertexArray(0);
  program.release();
}

void ContactLayer::draw_normals(QOpenGLShaderProgram& program, const View& view, const Theme& theme,
                                const Pass& pass) {
  const double longest = std::clamp(1.8 * view.cell / view.pixel_ratio, 12.0, 30.0);  // px
  if (mark_count_ == 0) return;
  program.bind();
  program.setUniformValue("world_to_clip", uniform_matrix(view.world_to_clip));
  program.setUniformValue("viewport", viewport(gl_));
  program.setUniformValue("width", static_cast<float>((longest < 20 ? 1.3 : 1.8) * view.pixel_ratio));
  program.setUniformValue("reach", static_cast<float>(longest * view.pixel_ratio * view.metres_per_pixel));
  program.setUniformValue("opacity", pass.opacity);
  program.setUniformValue("line_colour", as_srgb(touch_colour(theme)));
  gl_.glBindVertexArray(line_array_);
  gl_.glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, mark_count_);
  gl_.glBindVertexArray(0);
  program.release();
}

void ContactLayer::draw_dots(QOpenGLShaderProgram& program, const View& view, const Theme& theme) {
  if (mark_count_ == 0) return;
  program.bind();
  program.setUniformValue("world_to_clip", uniform_matrix(view.world_to_clip));
  const double diameter = std::clamp(0.5 * view.cell / view.pixel_ratio, 3.0, 6.0);  // px
  program.setUniformValue("diameter", static_cast<float>(diameter * view.pixel_ratio));
  program.setUniformValue("disc_colour", as_srgb(touch_colour(theme)));
  const QColor rim = theme.dark ? QColor(0x12, 0x16, 0x1B) : QColor(Qt::white);
  program.setUniformValue("rim_colour",
                          as_srgb(diameter < 5 ? touch_colour(theme) : rim));  // or little is left
  gl_.glEnable(GL_PROGRAM_POINT_SIZE);
  gl_.glBindVertexArray(dot_array_);
  gl_.glDrawArrays(GL_POINTS, 0, mark_count_);
  gl_.glBindVertexArray(0);
  gl_.glDisable(GL_PROGRAM_POINT_SIZE);
  program.release();
}

}  // namespace clothlab
