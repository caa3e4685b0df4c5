// A material on triangle meshes: triangles of constant strain, bending of patches, mass by area.
#pragma once

#include "cloth/cloth_sheet.h"
#include "cloth/cloth_system.h"
#include "cloth/material.h"

namespace cloth {

/// A particle for every vertex with a third of the mass of its triangles, pinned ones at rest. The warp runs
/// along the sheet's `down` as projected into each triangle, where that stands across it the weft along
/// `across`. Edges are springs without stiffness: strain and the deformation rate are measured along them.
/// The cloth is flat where it does not bend, whatever the mesh's shape. Precondition: the mesh is loaded.
ClothSystem make_material_mesh(const ClothSheet& sheet, const Material& material);

/// m^2, of all triangles.
double area_of(const TriangleMesh& mesh);

}  // namespace cloth
