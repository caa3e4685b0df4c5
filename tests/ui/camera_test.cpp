// The camera's mathematics, without a view.
#include "viewport/camera.h"

#include <QTest>
#include <algorithm>
#include <cmath>

#include "listed_test.h"

namespace clothlab::test::camera_test {

class CameraTest : public QObject {
  Q_OBJECT

 private Q_SLOTS:
  void what_is_under_the_cursor_stays_there_while_zooming() {
    Camera camera;
    camera.set_viewport(900, 700);
    camera.set_pose({{0.2, 0.1, 0}, 4, 0.4, 0.3});
    const Eigen::Vector2d cursor(700, 150);
    const Eigen::Vector3d under = camera.on_screen_plane(cursor, camera.pose().target);
    camera.zoom(1.7, cursor);
    QVERIFY((camera.project(under) - cursor).norm() < 1e-6);
    QVERIFY(std::abs(camera.pose().distance - 4 / 1.7) < 1e-12);
  }

  void panning_moves_the_target_plane_with_the_cursor() {
    Camera camera;
    camera.set_viewport(900, 700);
    const Eigen::Vector3d target = camera.pose().target;
    camera.pan(40, -25);
    QVERIFY((camera.project(target) - Eigen::Vector2d(490, 325)).norm() < 1e-6);
  }

  void a_ray_through_a_projection_meets_its_point() {
    Camera camera;
    camera.set_viewport(640, 480);
    camera.set_pose({{0, 0, 0}, 2, -1.1, 0.6});
    const Eigen::Vector3d p(0.3, -0.2, 0.4);
    const Ray ray = camera.ray(camera.project(p));
    QVERIFY(ray.direction.cross(p - ray.origin).norm() < 1e-9);
  }

  void a_framed_box_is_seen_whole_and_large() {
    Camera camera;
    for (const double width : {300.0, 900.0, 1600.0}) {
      camera.set_viewport(width, 700);
      const Eigen::AlignedBox3d box(Eigen::Vector3d(-2, 0, -0.5), Eigen::Vector3d(1, 1, 0.7));
      camera.set_pose(camera.framed(box, {{9, 9, 9}, 1, 0.8, 0.4}));
      double largest = 0;
      for (int i = 0; i < 8; ++i) {
        const Eigen::Vector2d p = camera.project(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
        const double x = std::abs(2 * p.x() / width - 1), y = std::abs(2 * p.y() / 700 - 1);
        QVERIFY(x < 1 && y < 1);
        largest = std::max({largest, x, y});
      }
      QVERIFY(largest > 0.75);
    }
  }

  void a_flight_ends_where_it_was_sent() {
    CameraFlight flight;
    const CameraPose from{{0, 0.5, 0}, 3, 0, 0}, to{{1, 2, 3}, 5, 0.4, 1.0};
    flight.start(from, to);
    const CameraPose half = flight.advance(CameraFlight::duration / 2);
    QVERIFY(half.distance > 3 && half.distance < 5 && flight.flying());
    QVERIFY(flight.advance(CameraFlight::duration) == to);
    QVERIFY(!flight.flying());
  }
};

const Listed listed{"camera_test", test_main<CameraTest>};

}  // namespace clothlab::test::camera_test

#include "camera_test.moc"
