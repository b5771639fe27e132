#include "decode_png.h"

#include <cairo.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

#include "core/base/error.h"

namespace adamas::test {

using namespace picture;

namespace {

cairo_status_t take(void* closure, unsigned char* data, unsigned int length) {
  auto& rest = *static_cast<std::string_view*>(closure);
  if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(data, rest.data(), length);
  rest.remove_prefix(length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Raster decode_png(std::string_view bytes) {
  const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> surface(
      cairo_image_surface_create_from_png_stream(take, &bytes), cairo_surface_destroy);
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    fail("picture: expected the bytes of a PNG file: {}", cairo_status_to_string(status));
  const cairo_format_t format = cairo_image_surface_get_format(surface.get());
  if (format != CAIRO_FORMAT_ARGB32 && format != CAIRO_FORMAT_RGB24) {
    fail("picture: expected a PNG file of 8 bits a channel, found Cairo format {}", static_cast<int>(format));
  }
  cairo_surface_flush(surface.get());
  Raster raster(cairo_image_surface_get_width(surface.get()), cairo_image_surface_get_height(surface.get()));
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  for (int y = 0; y < raster.height(); ++y) {
    for (int x = 0; x < raster.width(); ++x) {
      std::uint32_t word = 0;
      std::memcpy(&word, data + static_cast<std::size_t>(y) * stride + 4 * static_cast<std::size_t>(x),
                  sizeof word);
      const std::uint32_t a = format == CAIRO_FORMAT_ARGB32 ? word >> 24 : 255;
      const auto channel = [&](unsigned shift) {
        const std::uint32_t v = (word >> shift) & 255u;
        return static_cast<std::uint8_t>(a > 0 ? std::min((v * 255 + a / 2) / a, std::uint32_t{255}) : 0);
      };
      raster.at(x, y) = {channel(16), channel(8), channel(0), static_cast<std::uint8_t>(a)};
    }
  }
  return raster;
}

}  // namespace adamas::test
