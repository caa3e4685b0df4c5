// A cloth from a mesh and obstacles of any shape in the 3-D view: drawn, picked, in every look.
#include "geometry/mesh_repair.h"
#include "listed_test.h"
#include "scene/obstacle_shape.h"
#include "view_fixture.h"

namespace clothlab::test::mesh_view_test {

namespace {

std::shared_ptr<const cloth::LoadedMesh> scene_mesh(const cloth::TriangleMesh& surface) {
  auto mesh = std::make_shared<cloth::LoadedMesh>();
  mesh->file = "made.obj";
  mesh->surface = surface;
  for (const cloth::MeshEdge& edge : unique_edges(surface)) mesh->edges.push_back({edge.from, edge.to});
  for (const cloth::Vec3& vertex : surface.vertices) mesh->bounds.extend(vertex);
  return mesh;
}

/// A hexagon of radius 0.5 m about (0, 0.5, 0), its face towards +z.
std::shared_ptr<ClothFrame> hexagon() {
  cloth::TriangleMesh surface;
  surface.vertices.emplace_back(0, 0.5, 0);
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3;
    surface.vertices.emplace_back(0.5 * std::cos(angle), 0.5 + 0.5 * std::sin(angle), 0);
    surface.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
  }
  auto frame = std::make_shared<ClothFrame>();
  frame->topology = 7;
  frame->rows = 1;
  frame->columns = 7;
  frame->mesh = scene_mesh(surface);
  for (const cloth::Vec3& vertex : surface.vertices) {
    for (const double component : vertex) frame->positions.push_back(static_cast<float>(component));
    frame->normals.insert(frame->normals.end(), {0, 0, 1});
    frame->strain.push_back(0.1F);
    frame->pinned.push_back(0);
  }
  return frame;
}

cloth::Obstacle plate() {
  cloth::Obstacle plate;
  plate.shape = &cloth::mesh_shape();
  plate.mesh.file = "made.obj";
  plate.mesh.loaded = scene_mesh({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  plate.scale = 0.2;
  plate.translate = {0, 0.5, 0.3};
  return plate;
}

}  // namespace

class MeshViewTest : public ViewFixture {
  Q_OBJECT

 private:
  QColor seen_at(const QImage& image, const Eigen::Vector3d& point) {
    return image.pixelColor(rounded(view_->camera().project(point)));
  }

 private Q_SLOTS:
  void initTestCase() { apply_theme(*qApp, false); }
  void init() { open(); }
  void cleanup() { view_.reset(); }

  void a_mesh_is_drawn_where_its_triangles_are_in_every_look() {
    view_->clear();
    const QImage without = picture();
    for (const ViewMode mode : {ViewMode::textured, ViewMode::wireframe, ViewMode::strain}) {
      view_->setMode(mode);
      view_->showFrame(hexagon());
      view_->setCameraPose(head_on());
      const QImage with = picture();
      const auto changed = [&](const Eigen::Vector3d& p) {
        return distance(seen_at(with, p), seen_at(without, p)) > 12;
      };
      for (int k = 0; k < 6; ++k) {
        const double angle = (k + 0.4) * std::numbers::pi / 3;
        const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
        QVERIFY2(changed(Eigen::Vector3d(0, 0.5, 0) + 0.3 * out), "inside");
        QVERIFY2(!changed(Eigen::Vector3d(0, 0.5, 0) + 0.56 * out), "outside");
      }
    }
  }

  void the_wireframe_of_a_mesh_shows_its_edges() {
    view_->setMode(ViewMode::wireframe);
    view_->showFrame(hexagon());
    view_->setCameraPose(head_on());
    const QImage image = picture();
    const QPoint on_edge = rounded(view_->camera().project({0.25, 0.5, 0}));
    double most = 0;
    for (int dy = -2; dy <= 2; ++dy)
      most = std::max(most, distance(image.pixelColor(on_edge + QPoint(0, dy)),
                                     image.pixelColor(on_edge + QPoint(0, 12))));
    QVERIFY2(most > 40, qPrintable(QString::number(most)));
  }

  void the_vertex_nearest_to_the_cursor_is_picked() {
    const auto frame = hexagon();
    view_->showFrame(frame);
    view_->setCameraPose(head_on());
    for (int vertex = 0; vertex < 7; ++vertex) {
      const Eigen::Vector3d towards = Eigen::Vector3d(0, 0.5, 0) - particle_position(*frame, vertex);
      const Eigen::Vector3d near =
          particle_position(*frame, vertex) + 0.1 * towards + Eigen::Vector3d(0.01, 0.004, 0);
      QCOMPARE(pick_particle(*frame, view_->camera(), view_->camera().project(near)),
               std::optional<int>(vertex));
    }
    QCOMPARE(pick_particle(*frame, view_->camera(), view_->camera().project({1.2, 0.5, 0})),
             std::optional<int>());
  }

  void a_mesh_obstacle_is_drawn_where_it_is_placed_and_turned() {
    view_->showFrame(hexagon());
    view_->setCameraPose(head_on());
    const QImage without = picture();
    auto frame = hexagon();
    frame->obstacles = {plate()};
    const auto difference_at = [&](const Eigen::Vector3d& point) {
      view_->showFrame(frame);
      view_->setCameraPose(head_on());
      const QImage with = picture();
      return distance(seen_at(with, point), seen_at(without, point));
    };
    QVERIFY(difference_at({0.1, 0.6, 0.3}) > 12);
    QVERIFY(difference_at({0.3, 0.5, 0.3}) < 12);
    frame->obstacles[0].rotate = {0, 0, 45};  // its corner comes to the side
    QVERIFY(difference_at({0.25, 0.5, 0.3}) > 12);
    QVERIFY(difference_at({0.18, 0.68, 0.3}) < 12);
    frame->obstacles[0].translate.x() = 5;
    QVERIFY(difference_at({0.1, 0.6, 0.3}) < 12);
  }
};

const Listed listed{"mesh_view_test", test_main<MeshViewTest>};

}  // namespace clothlab::test::mesh_view_test

#include "mesh_view_test.moc"
