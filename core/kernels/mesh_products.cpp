#include "kernels/mesh_products.h"

#include <algorithm>
#include <cstddef>

#include "geometry/aligned.h"
#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"

namespace cloth {
namespace {

/// Fields as vectors, kept by each thread from product to product.
struct Scratch {
  AlignedDoubles position, direction, product;
};
Scratch& scratch() {
  thread_local Scratch of_thread;
  return of_thread;
}

const VectorKernels& kernels_of_now() {
  return active_kernels<VectorKernels>();
}

const double* put(const Vec3Field& field, AlignedDoubles& vectors) {
  if (vectors.size() != 4 * field.size()) vectors.assign(4 * field.size(), 0.0);
  kernels_of_now().to_vectors({field.x(), field.y(), field.z()}, vectors.data(), field.size());
  return vectors.data();
}

void add(const double* vectors, Vec3Field& result) {
  kernels_of_now().add_vectors(vectors, {result.x(), result.y(), result.z()}, result.size());
}

/// scale K field
double* bending_product(const BendingRows& rows, double scale, const Vec3Field& field) {
  const double* from = put(field, scratch().direction);
  AlignedDoubles& product = scratch().product;
  product.resize(4 * field.size());
  kernels_of_now().multiply_rows(
      {rows.begin.size() - 1, rows.begin.data(), rows.column.data(), rows.stiffness.data()}, scale, from,
      product.data());
  return product.data();
}

/// scale J^T K J direction
double* membrane_product(const Membrane& membrane, double scale, const Vec3Field& position,
                         const Vec3Field& direction) {
  static_assert(sizeof(MembraneTriangle) % sizeof(double) == 0);
  const double *at = put(position, scratch().position), *along = put(direction, scratch().direction);
  AlignedDoubles& product = scratch().product;
  product.assign(4 * position.size(), 0.0);
  if (membrane.empty()) return product.data();
  const TriangleRows triangles{.count = membrane.size(),
                               .corner = membrane.front().corner.data(),
                               .k = membrane.front().k.front().data(),
                               .corner_stride = sizeof(MembraneTriangle) / sizeof(int),
                               .k_stride = sizeof(MembraneTriangle) / sizeof(double)};
  kernels_of_now().add_triangles(triangles, scale, at, along, product.data());
  return product.data();
}

/// Of a product with the direction that it was made of.
double along_direction(const double* product) {
  return kernels_of_now().dot(scratch().direction.data(), product, scratch().direction.size());
}

}  // namespace

void add_bending_product(const ClothSystem& system, double scale, const Vec3Field& field, Vec3Field& result) {
  if (system.bending_rows.begin.empty()) return add_bending_product(system.bending, scale, field, result);
  add(bending_product(system.bending_rows, scale, field), result);
}

double bending_square(const ClothSystem& system, const Vec3Field& field) {
  if (system.bending_rows.begin.empty()) return bending_square(system.bending, field);
  return along_direction(bending_product(system.bending_rows, 1, field));
}

void add_membrane_product(const Membrane& membrane, double scale, const Vec3Field& position,
                          const Vec3Field& direction, Vec3Field& product) {
  add(membrane_product(membrane, scale, position, direction), product);
}

double membrane_square(const Membrane& membrane, const Vec3Field& position, const Vec3Field& direction) {
  return along_direction(membrane_product(membrane, 1, position, direction));
}

}  // namespace cloth
