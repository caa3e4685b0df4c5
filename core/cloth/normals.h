// Normals of a cloth's particles.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

class WorkerTeam;

/// The normalised sum of the cross products of each particle's triangles (a,d,c) and (a,c,b) of every cell, a
/// = (r,c), b = (r,c+1), c = (r+1,c+1), d = (r+1,c): weighted by area, and zero where that sum is zero.
/// `team`: of a grid; null is one thread.
void particle_normals(int rows, int columns, const Vec3Field& position, Vec3Field& normal,
                      WorkerTeam* team = nullptr);

/// The directional derivative of the normals along `direction`; zero where there is no normal.
void particle_normal_changes(int rows, int columns, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change);

/// The same for a cloth of either kind; of a mesh over its triangles.
void particle_normals(const ClothSystem& system, const Vec3Field& position, Vec3Field& normal,
                      WorkerTeam* team = nullptr);
void particle_normal_changes(const ClothSystem& system, const Vec3Field& position, const Vec3Field& direction,
                             Vec3Field& change);

}  // namespace cloth
