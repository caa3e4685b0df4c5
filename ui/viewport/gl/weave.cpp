#include "viewport/gl/weave.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <future>
#include <numbers>

namespace clothlab {
namespace {

constexpr double pi = std::numbers::pi;

/// A fixed pseudo-random number in [0, 1) for a pair of whole numbers.
double noise(int a, int b) {
  auto h = static_cast<std::uint32_t>(a) * 0x9E3779B1U ^ static_cast<std::uint32_t>(b) * 0x85EBCA77U;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return (h ^ (h >> 15)) / 4294967296.0;
}

/// What one thread shows at a point: its height, and how bright its fibres are there.
struct ThreadPoint {
  double height = -2;  ///< in half-thicknesses; lower than anything where the thread is not
  double shade = 1;
};

/// across: from the thread's middle, in thread spacings; along: in thread spacings, a whole number at each
/// crossing's middle; over: at this crossing the thread lies on top. id tells the threads' small differences
/// apart.
ThreadPoint thread_at(double across, double along, bool over, int id) {
  const double width = 0.455 + 0.025 * (noise(id, 1) - 0.5);  // half of it
  const double sway = 0.012 * std::sin(2 * pi * along / 8 + 6.28 * noise(id, 2));
  const double x = (across + sway) / width;
  if (std::abs(x) >= 1) return {};
  const double round = std::sqrt(1 - x * x);
  const double wave = std::cos(pi * (along - std::round(along))) * (over ? 1 : -1);

  // Two twisted plies of fibres, and a slow change of thickness along the yarn.
  const double twist = std::sin(2 * pi * (2.0 * along + 0.85 * x + noise(id, 3)));
  const double fibres = std::sin(2 * pi * (1.0 * along + 2.6 * x + noise(id, 4)));
  const double slub = std::sin(2 * pi * (along / weave_threads + noise(id, 5)));
  ThreadPoint point;
  point.height = 0.75 * round + wave;
  point.shade = (0.66 + 0.34 * round) * (0.88 + 0.12 * wave) *
                (1 + 0.05 * twist + 0.03 * fibres + 0.025 * slub + 0.07 * (noise(id, 6) - 0.5));
  return point;
}

QRgb blend(const QColor& colour, double shade) {
  const auto channel = [shade](float c) {
    return static_cast<int>(std::clamp(255.0 * c * shade, 0.0, 255.0) + 0.5);
  };
  return qRgba(channel(colour.redF()), channel(colour.greenF()), channel(colour.blueF()), 255);
}

/// Begun by the first call.
const std::shared_future<QImage>& shared_tile() {
  static const std::shared_future<QImage> tile = std::async(std::launch::async, [] { return weave_tile(); });
  return tile;
}

}  // namespace

void begin_shared_weave_tile() {
  shared_tile();
}

const QImage& shared_weave_tile() {
  return shared_tile().get();
}

QColor warp_colour() {
  return {0xF5, 0xEB, 0xDF};
}
QColor weft_colour() {
  return {0xBE, 0x79, 0x68};
}

QImage weave_tile(int size) {
  QImage tile(size, size, QImage::Format_RGBA8888);
  const QColor warp = warp_colour(), weft = weft_colour();
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double u = (x + 0.5) / size * weave_threads, v = (y + 0.5) / size * weave_threads;
      const int column = static_cast<int>(u), row = static_cast<int>(v);
      const bool warp_over = (column + row) % 2 == 0;
      const ThreadPoint up = thread_at(u - column - 0.5, v - 0.5, warp_over, column);
      const ThreadPoint across = thread_at(v - row - 0.5, u - 0.5, !warp_over, 1000 + row);
      const bool warp_seen = up.height >= across.height;
      const ThreadPoint& seen = warp_seen ? up : across;
      const double gap = seen.height < -1.5 ? 0.42 : 1;  // between the threads one sees the dark underneath
      const QRgb rgb = blend(warp_seen ? warp : weft, gap * seen.shade);
      tile.setPixel(x, y, qRgba(qRed(rgb), qGreen(rgb), qBlue(rgb), 255));
    }
  }
  return tile;
}

}  // namespace clothlab
