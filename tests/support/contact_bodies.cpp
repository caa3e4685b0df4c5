#include "support/contact_bodies.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "scene/obstacle_shape.h"
#include "support/crossings.h"

namespace cloth::test {
namespace {

TriangleMesh irregular_sheet(Random& random) {
  constexpr int side = 5;
  Vec3Field position(side * side);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      position.set(at(row * side + column),
                   Vec3(0.1 * row - 0.2, 0, 0.1 * column - 0.2) + random.vector(0.02));
  return grid_triangles(side, side, position);
}

void set_mesh(ObstacleBody& body, Random& random) {
  TriangleMesh mesh = irregular_sheet(random);
  if (random.coin()) mesh = box_triangles(random.vector(0.05), Eigen::Matrix3d::Identity(), {0.1, 0.2, 0.15});
  body.vertices = mesh.vertices;
  const int vertices = static_cast<int>(mesh.vertices.size());
  body.surface = make_surface(vertices, std::move(mesh.triangles));
}

Pose random_pose(const ObstacleBody& body, double max_angle, Random& random) {
  const Vec3 axis = random.vector(1).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, max_angle), axis).toRotationMatrix();
  return {turn, random.vector(0.1) + body.pivot - turn * body.pivot};
}

bool share_a_particle(const std::vector<int>& a, const std::vector<int>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

std::vector<int> corners_of(const Triangle& triangle) {
  return {triangle[0], triangle[1], triangle[2]};
}

void add_all(int obstacle, PairKind kind, std::size_t features, std::size_t far_features,
             std::vector<FeaturePair>& pairs) {
  for (std::size_t i = 0; i < features; ++i)
    for (std::size_t j = 0; j < far_features; ++j)
      pairs.push_back({obstacle, kind, static_cast<int>(i), static_cast<int>(j)});
}

void add_own(const Surface& cloth, std::vector<FeaturePair>& pairs) {
  std::vector<FeaturePair> all;
  const int none = FeaturePair::cloth_itself;
  add_all(none, PairKind::vertex_face, cloth.triangle_of_vertex.size(), cloth.triangles.size(), all);
  for (std::size_t e = 0; e < cloth.edges.size(); ++e)
    for (std::size_t g = e + 1; g < cloth.edges.size(); ++g)
      all.push_back({none, PairKind::edge_edge, static_cast<int>(e), static_cast<int>(g)});
  for (const FeaturePair& pair : all) {
    const auto& far = cloth.edges[pair.kind == PairKind::edge_edge ? at(pair.far_feature) : 0];
    const std::vector<int> far_ends = pair.kind == PairKind::edge_edge
                                          ? std::vector<int>{far[0], far[1]}
                                          : corners_of(cloth.triangles[at(pair.far_feature)]);
    if (!share_a_particle(near_particles(pair, cloth), far_ends)) pairs.push_back(pair);
  }
}

}  // namespace

ObstacleBody random_body(Shape shape, Random& random) {
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.center = obstacle.point = random.vector(0.1);
  obstacle.radius = random.uniform(0.03, 0.2);
  obstacle.size = {random.uniform(0.02, 0.4), random.uniform(0.02, 0.4), random.uniform(0.02, 0.4)};
  obstacle.normal = random.vector(1);
  if (shape != &mesh_shape()) return body_of(obstacle);
  ObstacleBody body;
  body.kind = shape->body;
  body.pivot = random.vector(0.1);
  set_mesh(body, random);
  for (const Vec3& vertex : body.vertices) body.reach = std::max(body.reach, (vertex - body.pivot).norm());
  return body;
}

PoseInterpolation random_interpolation(const ObstacleBody& body, Random& random) {
  constexpr double max_angle = 3;  // rad
  if (random.coin() && random.coin()) return {body.pivot, Pose{}, Pose{}};
  const Pose from = random_pose(body, max_angle, random);
  if (random.coin() && random.coin()) return {body.pivot, from, from};
  Pose to = from;
  to.translation += random.vector(0.2);
  if (random.coin()) return {body.pivot, from, to};
  const Vec3 pivot = to.at(body.pivot);
  const Vec3 rotation = random.uniform(0, max_angle) * random.vector(1).normalized();
  const Eigen::Matrix3d turn = random.coin() ? from.rotation : rotation_matrix(rotation) * from.rotation;
  Vec3 stretch = Vec3::Ones();
  if (random.coin() && body.kind != BodyKind::half_space) stretch = Vec3::Constant(random.uniform(0.3, 2));
  if (random.coin() && body.kind == BodyKind::box) stretch.y() = random.uniform(0.3, 2);
  const Pose begin = about(body.pivot, from.rotation, from.at(body.pivot), stretch);
  if (random.coin()) stretch.setOnes();
  return {body.pivot, begin, about(body.pivot, turn, pivot, stretch)};
}

Sheet random_sheet(int rows, int columns, Random& random) {
  Sheet sheet;
  sheet.position = Vec3Field(at(rows * columns));
  const Vec3 place = random.vector(0.05);
  const double wave = random.uniform(0, 20), height = random.uniform(0, 0.15);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = 0.4 * row / (rows - 1) - 0.2, z = 0.4 * column / (columns - 1) - 0.2;
      sheet.position.set(
          at(row * columns + column),
          place + Vec3(x * std::cos(wave * z), height * std::sin(wave * (x + z)), z) + random.vector(0.01));
    }
  sheet.surface = make_surface(rows * columns, grid_triangles(rows, columns, sheet.position).triangles);
  return sheet;
}

std::vector<int> near_particles(const FeaturePair& pair, const Surface& cloth) {
  switch (pair.kind) {
    case PairKind::vertex_plane:
    case PairKind::vertex_box:
    case PairKind::vertex_face:
      return {pair.feature};
    case PairKind::edge_edge:
      return {cloth.edges[at(pair.feature)][0], cloth.edges[at(pair.feature)][1]};
    case PairKind::face_sphere:
    case PairKind::face_vertex:
      return corners_of(cloth.triangles[at(pair.feature)]);
  }
  return {};
}

std::vector<Vec3> far_points(const FeaturePair& pair, const ObstacleBody& body) {
  const auto vertex = [&](int i) { return body.vertices[at(i)]; };
  if (pair.kind == PairKind::face_vertex) return {vertex(pair.far_feature)};
  if (pair.kind == PairKind::edge_edge) {
    const auto& [a, b] = body.surface.edges[at(pair.far_feature)];
    return {vertex(a), vertex(b)};
  }
  const auto& [a, b, c] = body.surface.triangles[at(pair.far_feature)];
  return {vertex(a), vertex(b), vertex(c)};
}

std::vector<FeaturePair> all_pairs(const Surface& cloth, const std::vector<ObstacleBody>& bodies,
                                   bool with_itself) {
  std::vector<FeaturePair> pairs;
  const std::size_t vertices = cloth.triangle_of_vertex.size(), edges = cloth.edges.size(),
                    faces = cloth.triangles.size();
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const ObstacleBody& body = bodies[k];
    const auto obstacle = static_cast<int>(k);
    const auto add = [&](PairKind kind, std::size_t features, std::size_t far_features) {
      add_all(obstacle, kind, features, far_features, pairs);
    };
    if (body.kind == BodyKind::half_space) add(PairKind::vertex_plane, vertices, 1);
    if (body.kind == BodyKind::ball) add(PairKind::face_sphere, faces, 1);
    if (body.kind == BodyKind::box) add(PairKind::vertex_box, vertices, 1);
    if (body.kind == BodyKind::surface) add(PairKind::vertex_face, vertices, body.surface.triangles.size());
    if (body.kind == BodyKind::box || body.kind == BodyKind::surface) {
      add(PairKind::edge_edge, edges, body.surface.edges.size());
      add(PairKind::face_vertex, faces, body.vertices.size());
    }
  }
  if (with_itself) add_own(cloth, pairs);
  return pairs;
}

}  // namespace cloth::test
