#include "picture/image.h"

#include <png.h>

namespace cloth {

static_assert(sizeof(Rgb) == 3, "libpng reads the pixels as they lie");

std::vector<std::uint8_t> png_file(const Image& image) {
  if (image.pixels.empty()) return {};
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  std::size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::vector<std::uint8_t> bytes(size);
  const int written =
      png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr);
  bytes.resize(written != 0 ? size : 0);
  return bytes;
}

}  // namespace cloth
