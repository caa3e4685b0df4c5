// The cloth in the graphics memory: uploaded once for each frame, drawn any number of times.
#pragma once

#include <QOpenGLFunctions_3_3_Core>
#include <vector>

#include "bridge/frame.h"

namespace clothlab {

/// A context must be current whenever a member is called, the destructor included.
class ClothSurface {
 public:
  explicit ClothSurface(QOpenGLFunctions_3_3_Core& gl);
  ~ClothSurface();
  ClothSurface(const ClothSurface&) = delete;
  ClothSurface& operator=(const ClothSurface&) = delete;

  /// Positions, normals and strain always, into one buffer; cells and indices only when the topology has
  /// changed, and pins when they have. Allocates only for those.
  void upload(const ClothFrame& frame);
  void draw_triangles() { draw(GL_TRIANGLES, triangles); }
  /// The same without a pattern: every particle in the middle of a cell.
  void draw_plain_triangles();
  /// The edges of a mesh, as lines; none of a grid.
  void draw_edges() { draw(GL_LINES, edges); }
  void draw_pinned_points() { draw(GL_POINTS, pinned); }
  bool has_pinned_points() const { return counts_[pinned] > 0; }

 private:
  enum Buffer { moving, cells, middles, triangles, edges, pinned, buffer_count };

  void draw(GLenum shape, Buffer buffer);
  void upload_topology(const ClothFrame& frame);
  std::vector<float> pattern_of(const ClothFrame& frame) const;
  void upload_indices(Buffer buffer, const std::vector<std::uint32_t>& indices);
  void lay_out_attributes(std::size_t particles);
  void take_cells_from(Buffer buffer);
  void upload_pins(const ClothFrame& frame);
  void upload_moving(const ClothFrame& frame);

  QOpenGLFunctions_3_3_Core& gl_;
  GLuint vertex_array_ = 0;
  GLuint buffers_[buffer_count] = {};
  GLsizei counts_[buffer_count] = {};  ///< of indices
  int rows_ = 0, columns_ = 0;
  std::uint64_t topology_ = 0;
  std::vector<std::uint8_t> pinned_flags_;  // as uploaded
  std::vector<std::uint32_t> pinned_indices_;
};

}  // namespace clothlab
