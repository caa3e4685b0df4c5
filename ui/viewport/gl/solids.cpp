#include "viewport/gl/solids.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace clothlab {
namespace {

struct Mesh {
  std::vector<float> vertices;  // position and normal
  std::vector<std::uint32_t> indices;

  std::uint32_t size() const { return static_cast<std::uint32_t>(vertices.size() / 6); }
  void add(const Eigen::Vector3f& position, const Eigen::Vector3f& normal) {
    vertices.insert(vertices.end(), position.data(), position.data() + 3);
    vertices.insert(vertices.end(), normal.data(), normal.data() + 3);
  }
};

void add_sphere(Mesh& mesh) {
  constexpr std::uint32_t around = 64, down = 32;
  constexpr auto pi = std::numbers::pi_v<float>;
  const std::uint32_t first = mesh.size();
  for (std::uint32_t i = 0; i <= down; ++i) {
    for (std::uint32_t k = 0; k <= around; ++k) {
      const float polar = pi * static_cast<float>(i) / down, turn = 2 * pi * static_cast<float>(k) / around;
      const Eigen::Vector3f n(std::sin(polar) * std::sin(turn), std::cos(polar),
                              std::sin(polar) * std::cos(turn));
      mesh.add(n, n);
    }
  }
  for (std::uint32_t i = 0; i < down; ++i) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = first + i * (around + 1) + k, b = a + around + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
}

void add_box(Mesh& mesh) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5F, 0.5F}) {
      const std::uint32_t first = mesh.size();
      const Eigen::Vector3f n = 2 * side * Eigen::Vector3f::Unit(axis);
      const Eigen::Vector3f u = Eigen::Vector3f::Unit((axis + 1) % 3), v = n.cross(u);
      for (const auto& [s, t] : {std::pair{-0.5F, -0.5F}, {0.5F, -0.5F}, {0.5F, 0.5F}, {-0.5F, 0.5F}})
        mesh.add(0.5F * n + s * u + t * v, n);
      for (const std::uint32_t k : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + k);
    }
  }
}

}  // namespace

void upload_corners(QOpenGLFunctions_3_3_Core& gl, GLuint array, GLuint buffer,
                    const std::vector<float>& values) {
  gl.glBindVertexArray(array);
  gl.glBindBuffer(GL_ARRAY_BUFFER, buffer);
  gl.glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data(),
                  GL_STATIC_DRAW);
  for (GLuint attribute = 0; attribute < 2; ++attribute) {
    gl.glEnableVertexAttribArray(attribute);
    gl.glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float),
                             reinterpret_cast<const void*>(3 * attribute * sizeof(float)));
  }
  gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
}

Solids::Solids(QOpenGLFunctions_3_3_Core& gl) : gl_(gl) {
  Mesh mesh;
  add_sphere(mesh);
  sphere_count_ = static_cast<GLsizei>(mesh.indices.size());
  add_box(mesh);
  box_count_ = static_cast<GLsizei>(mesh.indices.size()) - sphere_count_;

  gl_.glGenVertexArrays(1, &solid_array_);
  gl_.glGenVertexArrays(1, &empty_array_);
  gl_.glGenBuffers(1, &vertices_);
  gl_.glGenBuffers(1, &indices_);
  upload_corners(gl_, solid_array_, vertices_, mesh.vertices);
  gl_.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  gl_.glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                   static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)), mesh.indices.data(),
                   GL_STATIC_DRAW);
  gl_.glBindVertexArray(0);
}

Solids::~Solids() {
  gl_.glDeleteVertexArrays(1, &solid_array_);
  gl_.glDeleteVertexArrays(1, &empty_array_);
  gl_.glDeleteBuffers(1, &vertices_);
  gl_.glDeleteBuffers(1, &indices_);
}

void Solids::draw_solid(GLsizei first, GLsizei count) {
  gl_.glBindVertexArray(solid_array_);
  const auto offset = static_cast<std::uintptr_t>(first) * sizeof(std::uint32_t);
  gl_.glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset));
  gl_.glBindVertexArray(0);
}

void Solids::draw_made_corners(GLenum shape, GLsizei count) {
  gl_.glBindVertexArray(empty_array_);
  gl_.glDrawArrays(shape, 0, count);
  gl_.glBindVertexArray(0);
}

}  // namespace clothlab
