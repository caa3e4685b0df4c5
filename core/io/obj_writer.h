// Triangle meshes as Wavefront OBJ files. Numbers are written so that they read back to the same bits.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Vertices and triangles; `title` becomes a comment.
std::string obj_text(const TriangleMesh& mesh, const std::string& title);

/// A surface with what a renderer asks for. Lists go with the vertices; an empty one is left out of the file.
/// Number is float or double.
template <class Number>
struct ObjSurface {
  std::span<const Number> positions;           ///< m; x y z of vertex 0, of vertex 1, ...
  std::span<const Number> normals;             ///< likewise, of length 1
  std::vector<std::array<Number, 2>> texture;  ///< u to the right, v upwards
  std::span<const Triangle> triangles;
};

template <class Number>
std::string obj_text(const ObjSurface<Number>& surface, const std::string& title);

/// Texture coordinates of a grid, row by row: the first row along the upper edge of a picture. None for a
/// mesh, which has one row.
template <class Number>
std::vector<std::array<Number, 2>> grid_texture(int rows, int columns);

}  // namespace cloth
