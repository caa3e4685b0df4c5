// A view with a flat cloth in it, and what a test looks at and does to it.
#pragma once

#include <QApplication>
#include <QProcess>
#include <QSignalSpy>
#include <QTest>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "theme/theme.h"
#include "viewport/cloth_view.h"
#include "viewport/gl/weave.h"
#include "viewport/picking.h"

namespace clothlab::test {

inline constexpr int side = 17;  // particles along each edge

/// A flat, upright square cloth of 1 m about (0, 0.5, 0), its face towards +z; strain grows from left to
/// right.
inline std::shared_ptr<ClothFrame> flat_cloth(std::uint64_t topology = 1, int n = side) {
  auto frame = std::make_shared<ClothFrame>();
  frame->topology = topology;
  frame->rows = frame->columns = n;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      const float u = static_cast<float>(c) / static_cast<float>(n - 1),
                  v = static_cast<float>(r) / static_cast<float>(n - 1);
      frame->positions.insert(frame->positions.end(), {u - 0.5F, 1 - v, 0});
      frame->normals.insert(frame->normals.end(), {0, 0, 1});
      frame->strain.push_back(0.2F * u);
      frame->pinned.push_back(r == 0 && c == 0);
    }
  }
  frame->largest_strain = 0.2F;
  return frame;
}

inline CameraPose head_on(double distance = 3) {
  return {{0, 0.5, 0}, distance, 0, 0};
}

inline QPoint rounded(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

/// How far apart two colours are, 0 to 441.
inline double distance(QColor a, QColor b) {
  return std::hypot(a.red() - b.red(), a.green() - b.green(), a.blue() - b.blue());
}

/// Light and shade change a thread's brightness, hardly its balance of red to blue.
inline bool is_weft(QColor seen) {
  const auto balance = [](QColor c) { return std::log((c.red() + 1.0) / (c.blue() + 1.0)); };
  const double warp = balance(warp_colour()), weft = balance(weft_colour());
  return std::abs(balance(seen) - weft) < std::abs(balance(seen) - warp);
}

inline double saturation(QColor c) {
  return c.hsvSaturationF();
}

inline Eigen::Vector2d through(const Eigen::Matrix4d& to_screen, const Eigen::Vector3d& point) {
  const Eigen::Vector4d h = to_screen * point.homogeneous();
  return h.head<2>() / h.w();
}

/// Real mouse events with a button held, which QTest::mouseMove does not hold.
inline void drag(QWidget& view, QPoint from, QPoint to, Qt::MouseButton button = Qt::LeftButton,
                 Qt::KeyboardModifiers modifiers = {}, bool release = true) {
  QTest::mousePress(&view, button, modifiers, from);
  for (const QPoint at : {(from + to) / 2, to}) {
    QMouseEvent move(QEvent::MouseMove, at, view.mapToGlobal(at), Qt::NoButton, button, modifiers);
    QApplication::sendEvent(&view, &move);
  }
  if (release) QTest::mouseRelease(&view, button, modifiers, to);
}

class ViewFixture : public QObject {
 protected:
  std::unique_ptr<ClothView> view_;

  QPoint at(int particle) const {
    return rounded(view_->camera().project(particle_position(*view_->frame(), particle)));
  }
  QImage picture() { return view_->grabPicture(); }
  static int middle() { return side / 2 * side + side / 2; }

  /// Before every test.
  void open() {
    view_ = std::make_unique<ClothView>();
    if (!view_->hasOpenGl()) QSKIP(qPrintable("no OpenGL here: " + view_->openGlProblem()));
    view_->setAnimated(false);
    view_->resize(600, 500);
    view_->show();
    QVERIFY(QTest::qWaitForWindowExposed(view_.get()));
    view_->showFrame(flat_cloth());
    view_->setCameraPose(head_on());
    picture();
  }
};

}  // namespace clothlab::test
