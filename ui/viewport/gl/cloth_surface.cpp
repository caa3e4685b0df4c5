#include "viewport/gl/cloth_surface.h"

#include "geometry/mesh_look.h"

namespace clothlab {
namespace {

GLsizeiptr bytes(const auto& values) {
  return static_cast<GLsizeiptr>(values.size() * sizeof(values[0]));
}

/// Triangles (a, d, c) and (a, c, b) of each cell a = (r, c), b = (r, c+1), c = (r+1, c+1), d = (r+1, c): the
/// face of a cloth laid out to the right and downwards looks at the viewer.
std::vector<std::uint32_t> grid_triangles(int rows, int columns) {
  std::vector<std::uint32_t> indices;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<std::uint32_t>(r * columns + column), b = a + 1;
      const std::uint32_t d = a + static_cast<std::uint32_t>(columns), c = d + 1;
      indices.insert(indices.end(), {a, d, c, a, c, b});
    }
  }
  return indices;
}

}  // namespace

ClothSurface::ClothSurface(QOpenGLFunctions_3_3_Core& gl) : gl_(gl) {
  gl_.glGenVertexArrays(1, &vertex_array_);
  gl_.glGenBuffers(buffer_count, buffers_);
}

ClothSurface::~ClothSurface() {
  gl_.glDeleteVertexArrays(1, &vertex_array_);
  gl_.glDeleteBuffers(buffer_count, buffers_);
}

void ClothSurface::upload(const ClothFrame& frame) {
  const bool new_grid = frame.rows != rows_ || frame.columns != columns_ || frame.topology != topology_;
  if (new_grid) upload_topology(frame);
  if (new_grid || frame.pinned != pinned_flags_) upload_pins(frame);
  upload_moving(frame);
}

void ClothSurface::upload_moving(const ClothFrame& frame) {
  gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[moving]);
  // Orphaned: the driver may still draw from the old memory and need not be waited for.
  gl_.glBufferData(GL_ARRAY_BUFFER, bytes(frame.positions) + bytes(frame.normals) + bytes(frame.strain),
                   nullptr, GL_STREAM_DRAW);
  GLintptr at = 0;
  for (const std::vector<float>* values : {&frame.positions, &frame.normals, &frame.strain}) {
    gl_.glBufferSubData(GL_ARRAY_BUFFER, at, bytes(*values), values->data());
    at += bytes(*values);
  }
  gl_.glBindBuffer(GL_ARRAY_BUFFER, 0);
}

/// Where each attribute of cloth.vert lies.
void ClothSurface::lay_out_attributes(std::size_t particles) {
  struct Attribute {
    Buffer buffer;
    GLint components;
    std::size_t floats_before;
  };
  const Attribute attributes[] = {
      {moving, 3, 0}, {moving, 3, 3 * particles}, {moving, 1, 6 * particles}, {cells, 2, 0}};
  gl_.glBindVertexArray(vertex_array_);
  for (GLuint i = 0; i < std::size(attributes); ++i) {
    gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[attributes[i].buffer]);
    gl_.glEnableVertexAttribArray(i);
    gl_.glVertexAttribPointer(i, attributes[i].components, GL_FLOAT, GL_FALSE, 0,
                              reinterpret_cast<const void*>(attributes[i].floats_before * sizeof(float)));
  }
  gl_.glBindVertexArray(0);
}

void ClothSurface::upload_topology(const ClothFrame& frame) {
  rows_ = frame.rows;
  columns_ = frame.columns;
  topology_ = frame.topology;
  const std::vector<float> pattern = pattern_of(frame);
  lay_out_attributes(pattern.size() / 2);
  const std::vector<float> middle(frame.mesh ? pattern.size() : 0, 0.5F);
  for (const auto& [buffer, values] : {std::pair{cells, &pattern}, std::pair{middles, &middle}}) {
    gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[buffer]);
    gl_.glBufferData(GL_ARRAY_BUFFER, bytes(*values), values->data(), GL_STATIC_DRAW);
  }

  std::vector<std::uint32_t> indices, lines;
  if (frame.mesh) {
    for (const cloth::Triangle& triangle : frame.mesh->surface.triangles)
      for (const int corner : triangle) indices.push_back(static_cast<std::uint32_t>(corner));
    for (const auto& edge : frame.mesh->edges)
      for (const int end : edge) lines.push_back(static_cast<std::uint32_t>(end));
  } else {
    indices = grid_triangles(rows_, columns_);
  }
  upload_indices(triangles, indices);
  upload_indices(edges, lines);
}

/// Column and row of each particle; of a mesh its place in the cloth laid flat, m.
std::vector<float> ClothSurface::pattern_of(const ClothFrame& frame) const {
  std::vector<float> pattern;
  if (frame.mesh) {
    for (const Eigen::Vector2d& at : cloth::flat_pattern(frame.mesh->surface).at)
      pattern.insert(pattern.end(), {static_cast<float>(at.x()), static_cast<float>(at.y())});
    return pattern;
  }
  pattern.reserve(2 * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c)
      pattern.insert(pattern.end(), {static_cast<float>(c), static_cast<float>(r)});
  return pattern;
}

void ClothSurface::upload_indices(Buffer buffer, const std::vector<std::uint32_t>& indices) {
  counts_[buffer] = static_cast<GLsizei>(indices.size());
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[buffer]);
  gl_.glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(indices), indices.data(), GL_STATIC_DRAW);
  gl_.glBindVertexArray(0);
}

void ClothSurface::upload_pins(const ClothFrame& frame) {
  pinned_flags_ = frame.pinned;
  pinned_indices_.clear();
  for (std::size_t i = 0; i < frame.pinned.size(); ++i)
    if (frame.pinned[i]) pinned_indices_.push_back(static_cast<std::uint32_t>(i));
  upload_indices(pinned, pinned_indices_);
}

void ClothSurface::draw(GLenum shape, Buffer buffer) {
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[buffer]);
  gl_.glDrawElements(shape, counts_[buffer], GL_UNSIGNED_INT, nullptr);
  gl_.glBindVertexArray(0);
}

void ClothSurface::draw_plain_triangles() {
  take_cells_from(middles);
  draw_triangles();
  take_cells_from(cells);
}

void ClothSurface::take_cells_from(Buffer buffer) {
  constexpr GLuint cell = 3;
  gl_.glBindVertexArray(vertex_array_);
  gl_.glBindBuffer(GL_ARRAY_BUFFER, buffers_[buffer]);
  gl_.glVertexAttribPointer(cell, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_.glBindVertexArray(0);
}

}  // namespace clothlab
