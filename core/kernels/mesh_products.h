// Products with the matrices of bending and of a mesh's triangles, for iterative solvers and powers: on a
// mesh with a particle's three numbers in one register. The same bits in every instruction set.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// result += scale * K field (cloth/bending.h): by the rows of a mesh (cloth/bending_rows.h), else by the
/// runs.
void add_bending_product(const ClothSystem& system, double scale, const Vec3Field& field, Vec3Field& result);

/// field . K field
double bending_square(const ClothSystem& system, const Vec3Field& field);

/// product += scale J^T K J direction with J = dq/dx at `position` (cloth/membrane.h): with damping's time as
/// `scale` its force at a velocity, with 1 the part of the second derivative of E that is never negative.
void add_membrane_product(const Membrane& membrane, double scale, const Vec3Field& position,
                          const Vec3Field& direction, Vec3Field& product);

/// direction J^T K J direction.
double membrane_square(const Membrane& membrane, const Vec3Field& position, const Vec3Field& direction);

}  // namespace cloth
