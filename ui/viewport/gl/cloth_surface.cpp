#include "viewport/gl/cloth_surface.h"

#include "viewport/gl/cloth_mesh.h"

namespace clothlab {
namespace {

GLsizeiptr bytes(const auto& values) {
  return static_cast<GLsizeiptr>(values.size() * sizeof(values[0]));
}

}  // namespace

ClothSurface::ClothSurface(QOpenGLFunctions_3_3_Core& gl) : gl_(gl) {
  gl_.glGenVertexArrays(1, &vertex_array_);
  gl_.glGenBuffers(buffer_count, buffers_);
  gl_.glBindVertexArray(vertex_array_);
  constexpr int components[] = {3, 3, 1, 2};  // of positions, normals, strain, cells
  for (GLuint attribute = 0; attribute < 4; ++attribute) {
    gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[attribute]);
    gl_.glEnableVertexAttribArray(attribute);
    gl_.glVertexAttribPointer(attribute, components[attribute], GL_FLOAT, GL_FALSE, 0, nullptr);
  }
  gl_.glBindVertexArray(0);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
}

ClothSurface::~ClothSurface() {
  gl_.glDeleteVertexArrays(1, &vertex_array_);
  gl_.glDeleteBuffers(buffer_count, buffers_);
}

void ClothSurface::refill(Buffer buffer, const std::vector<float>& values) {
  gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[buffer]);
  // Orphaned: the driver may still draw from the old memory and need not be waited for.
  gl_.glBufferData(GL_ARRAY_BUFFER, bytes(values), nullptr, GL_STREAM_DRAW);
  gl_.glBufferSubData(GL_ARRAY_BUFFER, 0, bytes(values), values.data());
}

void ClothSurface::upload(const ClothFrame& frame) {
  const bool new_grid = frame.rows != rows_ || frame.columns != columns_ || frame.topology != topology_;
  if (new_grid) upload_grid(frame);
  if (new_grid || frame.pinned != pinned_flags_) upload_pins(frame);
  cloth_normals(frame.positions, frame.rows, frame.columns, normal_values_);
  refill(positions, frame.positions);
  refill(normals, normal_values_);
  refill(strain, frame.strain);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void ClothSurface::upload_grid(const ClothFrame& frame) {
  rows_ = frame.rows;
  columns_ = frame.columns;
  topology_ = frame.topology;
  std::vector<std::uint32_t> indices;
  cloth_triangles(rows_, columns_, indices);
  index_count_ = static_cast<GLsizei>(indices.size());
  std::vector<float> grid;
  grid.reserve(2 * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c)
      grid.insert(grid.end(), {static_cast<float>(c), static_cast<float>(r)});
  gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[cells]);
  gl_.glBufferData(GL_ARRAY_BUFFER, bytes(grid), grid.data(), GL_STATIC_DRAW);
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[triangles]);
  gl_.glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices), indices.data(), GL_STATIC_DRAW);
  gl_.glBindVertexArray(0);
}

void ClothSurface::upload_pins(const ClothFrame& frame) {
  pinned_flags_ = frame.pinned;
  pinned_indices_.clear();
  for (std::size_t i = 0; i < frame.pinned.size(); ++i)
    if (frame.pinned[i]) pinned_indices_.push_back(static_cast<std::uint32_t>(i));
  pinned_count_ = static_cast<GLsizei>(pinned_indices_.size());
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[pinned]);
  gl_.glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(pinned_indices_), pinned_indices_.data(), GL_STATIC_DRAW);
  gl_.glBindVertexArray(0);
}

void ClothSurface::draw_triangles() {
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[triangles]);
  gl_.glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
  gl_.glBindVertexArray(0);
}

void ClothSurface::draw_pinned_points() {
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[pinned]);
  gl_.glDrawElements(GL_POINTS, pinned_count_, GL_UNSIGNED_INT, nullptr);
  gl_.glBindVertexArray(0);
}

}  // namespace clothlab
