// The cloth of a scene, be it a grid or a triangle mesh.
#pragma once

#include "cloth/cloth_sheet.h"
#include "cloth/cloth_system.h"

namespace cloth {

/// Particles, springs, masses and pins. Of a mesh every vertex is a particle, edges are structural springs,
/// the vertices opposite an inner edge are joined by flexion springs, and there is no shear; masses are
/// equal. Precondition: a mesh is loaded.
ClothSystem make_cloth(const ClothSheet& sheet, const SpringMaterial& material);

/// m: of a grid as if its directions were at right angles, of a mesh that of the box around it.
double diagonal_of(const ClothSheet& sheet);

/// The cloth's surface: a mesh's own triangles; of a grid (a,d,c) and (a,c,b) of every cell, row by row, with
/// a = (r,c), b = (r,c+1), c = (r+1,c+1), d = (r+1,c).
std::vector<Triangle> triangles_of(const ClothSystem& system);

/// The same at the start, with its vertices.
TriangleMesh rest_surface(const ClothSystem& system);

/// The same with its structural springs as edges, for whoever draws a cloth that is no whole grid.
std::shared_ptr<const LoadedMesh> surface_to_draw(const ClothSystem& system);

}  // namespace cloth
