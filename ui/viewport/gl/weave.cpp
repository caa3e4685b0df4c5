#include "viewport/gl/weave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <future>
#include <numbers>
#include <vector>

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

/// What tells one thread from another. Phases are parts of a turn.
struct Thread {
  explicit Thread(int id)
      : half_width(0.455 + 0.025 * (noise(id, 1) - 0.5)),
        sway(noise(id, 2)),
        twist(noise(id, 3)),
        fibres(noise(id, 4)),
        slub(noise(id, 5)),
        tone(0.07 * (noise(id, 6) - 0.5)) {}
  double half_width;  ///< in thread spacings
  double sway, twist, fibres, slub;
  double tone;  ///< brighter or darker than the others
};

/// A thread at one place of its way: lengths in thread spacings, a whole number at each crossing's middle.
struct Section {
  Section(const Thread& of, double place)
      : thread(of),
        along(place),
        sway(0.012 * std::sin(2 * pi * place / 8 + 6.28 * of.sway)),
        rise(std::cos(pi * (place - std::round(place)))),
        slub(std::sin(2 * pi * (place / weave_threads + of.slub))) {}
  Thread thread;
  double along, sway;
  double rise;  ///< in half-thicknesses, where it lies on top
  double slub;  ///< a slow change of thickness along the yarn
};

/// What is seen of a thread at a point of a section.
struct ThreadPoint {
  const Section& section;
  double x;            ///< from the thread's middle, in half-widths
  double round = 0;    ///< of its cross section
  double wave = 0;     ///< in half-thicknesses
  double height = -2;  ///< likewise; lower than anything where the thread is not

  /// across: from the thread's middle, in thread spacings; over: at this crossing the thread lies on top.
  ThreadPoint(const Section& of, double across, bool over)
      : section(of), x((across + of.sway) / of.thread.half_width) {
    if (std::abs(x) >= 1) return;
    round = std::sqrt(1 - x * x);
    wave = of.rise * (over ? 1 : -1);
    height = 0.75 * round + wave;
  }

  /// How bright its fibres are: two twisted plies.
  double shade() const {
    if (height <= -2) return 1;
    const double along = section.along;
    const double twist = std::sin(2 * pi * (2.0 * along + 0.85 * x + section.thread.twist));
    const double fibres = std::sin(2 * pi * (1.0 * along + 2.6 * x + section.thread.fibres));
    return (0.66 + 0.34 * round) * (0.88 + 0.12 * wave) *
           (1 + 0.05 * twist + 0.03 * fibres + 0.025 * section.slub + section.thread.tone);
  }
};

/// Of all threads of one direction, at every pixel of their way.
std::vector<Section> sections_of(int first_id, int size) {
  std::vector<Section> sections;
  sections.reserve(static_cast<std::size_t>(weave_threads * size));
  for (int n = 0; n < weave_threads; ++n) {
    const Thread thread(first_id + n);
    for (int i = 0; i < size; ++i) sections.emplace_back(thread, (i + 0.5) / size * weave_threads - 0.5);
  }
  return sections;
}

QRgb blend(const QColor& colour, double shade) {
  const auto channel = [shade](float c) {
    return static_cast<int>(std::clamp(255.0 * c * shade, 0.0, 255.0) + 0.5);
  };
  return qRgba(channel(colour.redF()), channel(colour.greenF()), channel(colour.blueF()), 255);
}

/// Begun by the first call.
const std::shared_future<std::vector<QImage>>& weave() {
  static const std::shared_future<std::vector<QImage>> tile =
      std::async(std::launch::async, [] { return mipmaps_of(weave_tile()); });
  return tile;
}

double light_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
double srgb_of(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

constexpr int light_steps = 1 << 14;  ///< of equal light; the darkest 8-bit value has five of them

/// The light of each 8-bit value, and back.
struct LightTables {
  LightTables() {
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = static_cast<int>(std::lround(light_of(static_cast<double>(i) / 255) * (light_steps - 1)));
    for (std::size_t i = 0; i < srgb.size(); ++i)
      srgb[i] = static_cast<uchar>(std::lround(255 * srgb_of(static_cast<double>(i) / (light_steps - 1))));
  }
  std::array<int, 256> light;
  std::array<uchar, light_steps> srgb;
};

QImage half_of(const QImage& picture) {
  static const LightTables tables;
  QImage half(picture.size() / 2, picture.format());
  half.fill(Qt::black);
  for (int y = 0; y < half.height(); ++y) {
    const uchar *upper = picture.constScanLine(2 * y), *lower = picture.constScanLine(2 * y + 1);
    uchar* const mean = half.scanLine(y);
    for (int x = 0; x < half.width(); ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const int left = 8 * x + channel, right = left + 4;
        const int light = tables.light[upper[left]] + tables.light[upper[right]] + tables.light[lower[left]] +
                          tables.light[lower[right]];
        mean[4 * x + channel] = tables.srgb[static_cast<std::size_t>((light + 2) / 4)];
      }
  }
  return half;
}

}  // namespace

void begin_shared_weave() {
  weave();
}

const std::vector<QImage>& shared_weave() {
  return weave().get();
}

std::vector<QImage> mipmaps_of(QImage picture) {
  std::vector<QImage> levels{std::move(picture)};
  while (levels.back().width() > 1) levels.push_back(half_of(levels.back()));
  return levels;
}

QColor warp_colour() {
  return {0xF5, 0xEB, 0xDF};
}
QColor weft_colour() {
  return {0xBE, 0x79, 0x68};
}

QImage weave_tile(int size) {
  QImage tile(size, size, QImage::Format_ARGB32);
  const QColor warp = warp_colour(), weft = weft_colour();
  const std::vector<Section> warps = sections_of(0, size), wefts = sections_of(1000, size);
  const auto at = [size](const std::vector<Section>& sections, int thread, int pixel) -> const Section& {
    return sections[static_cast<std::size_t>(thread * size + pixel)];
  };
  for (int y = 0; y < size; ++y) {
    auto* const pixels = reinterpret_cast<QRgb*>(tile.scanLine(y));
    for (int x = 0; x < size; ++x) {
      const double u = (x + 0.5) / size * weave_threads, v = (y + 0.5) / size * weave_threads;
      const int column = static_cast<int>(u), row = static_cast<int>(v);
      const bool warp_over = (column + row) % 2 == 0;
      const ThreadPoint up(at(warps, column, y), u - column - 0.5, warp_over);
      const ThreadPoint across(at(wefts, row, x), v - row - 0.5, !warp_over);
      const bool warp_seen = up.height >= across.height;
      const ThreadPoint& seen = warp_seen ? up : across;
      const double gap = seen.height < -1.5 ? 0.42 : 1;  // between the threads one sees the dark underneath
      pixels[x] = blend(warp_seen ? warp : weft, gap * seen.shade());
    }
  }
  return tile.convertToFormat(QImage::Format_RGBA8888);
}

}  // namespace clothlab
