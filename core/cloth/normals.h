// Normals of a cloth's particles.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// The normalised sum of the cross products of each particle's triangles (a,d,c) and (a,c,b) of every cell, a
/// = (r,c), b = (r,c+1), c = (r+1,c+1), d = (r+1,c): weighted by area, and zero where that sum is zero.
void particle_normals(int rows, int columns, const Vec3Field& position, Vec3Field& normal);
/// The same of the particles in rows [begin, end) alone.
void particle_normals_of_rows(int begin, int end, int rows, int columns, const Vec3Field& position,
                              Vec3Field& normal);
/// That of one particle.
Vec3 particle_normal(int rows, int columns, const Vec3Field& position, std::size_t particle);

/// The directional derivative of the normals along `direction`; zero where there is no normal.
void particle_normal_changes(int rows, int columns, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change);

/// The same for a cloth of either kind; of a mesh over its triangles.
void particle_normals(const ClothSystem& system, const Vec3Field& position, Vec3Field& normal);
void particle_normal_changes(const ClothSystem& system, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change);

}  // namespace cloth
