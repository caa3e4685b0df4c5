// What a picture shows, as triangles: the sheet, spheres, boxes.
#pragma once

#include "cloth/cloth_system.h"
#include "picture/rasteriser.h"

namespace cloth {

struct PictureMesh {
  std::vector<PictureVertex> vertices;
  std::vector<int> triangles;  ///< three vertices each, counter-clockwise seen from the front
};

/// The cells of a grid or the triangles of a mesh; `strain_scale` is the strain at which a vertex has
/// strain 1.
PictureMesh sheet_mesh(const ClothSystem& system, const Vec3Field& position, double strain_scale);
/// A mesh with its edges kept sharp.
PictureMesh body_mesh(const TriangleMesh& body);
PictureMesh sphere_mesh(const Vec3& center, double radius);
/// Its edges rounded by that radius, all in metres.
PictureMesh box_mesh(const Vec3& center, const Vec3& size, double rounding);

}  // namespace cloth
