// A finished picture: rows of pixels, and the PNG file made of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cloth {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;  ///< sRGB
  bool operator==(const Rgb&) const = default;
};

struct Image {
  int width = 0, height = 0;  ///< px
  std::vector<Rgb> pixels;    ///< row by row from the top left
  const Rgb& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// The bytes of a PNG file: 8 bits per channel, sRGB, no alpha, no time stamp. Empty for an image without
/// pixels.
std::vector<std::uint8_t> png_file(const Image& image);

}  // namespace cloth
