#include "core/io/tiff_reader.h"

#include <tiffio.h>

#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/base/error.h"
#include "core/io/input_file.h"

namespace adamas {

namespace {

std::array<char, 256> first_message{};

void keep_message(const char*, const char* format, va_list arguments) {
  if (first_message[0] == '\0') std::vsnprintf(first_message.data(), first_message.size(), format, arguments);
}

struct Close {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using TiffFile = std::unique_ptr<TIFF, Close>;

struct Layout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG;
  bool operator==(const Layout&) const = default;

  [[nodiscard]] std::string type() const {
    return (format == SAMPLEFORMAT_IEEEFP ? "float"
            : format == SAMPLEFORMAT_INT  ? "int"
                                          : "uint") +
           std::to_string(bits);
  }
  [[nodiscard]] std::size_t row_bytes() const { return std::size_t{width} * samples * bits / 8; }
};

Layout layout_of(TIFF* file, const std::string& name) {
  Layout layout;
  TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(file, TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &layout.samples);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &layout.format);
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &layout.planar);
  const bool known = (layout.format == SAMPLEFORMAT_IEEEFP && layout.bits == 32) ||
                     ((layout.format == SAMPLEFORMAT_UINT || layout.format == SAMPLEFORMAT_INT) &&
                      (layout.bits == 8 || layout.bits == 16 || layout.bits == 32));
  if (layout.width == 0 || layout.height == 0) fail("{}: expected an image, found none", name);
  if (!known) fail("{}: expected samples of 8, 16 or 32 bits, found {}", name, layout.type());
  if (TIFFIsTiled(file) != 0) fail("{}: expected an image in strips, found tiles", name);
  if (layout.samples > 1 && layout.planar != PLANARCONFIG_CONTIG) {
    fail("{}: expected interleaved samples, found separate planes", name);
  }
  return layout;
}

template <class T, class Out>
void append(const std::vector<unsigned char>& row, std::vector<Out>& values) {
  for (std::size_t at = 0; at + sizeof(T) <= row.size(); at += sizeof(T)) {
    T value;
    std::memcpy(&value, row.data() + at, sizeof(T));
    values.push_back(static_cast<Out>(value));
  }
}

void append(const Layout& layout, const std::vector<unsigned char>& row, GridArray& array) {
  const bool is_signed = layout.format == SAMPLEFORMAT_INT;
  if (layout.format == SAMPLEFORMAT_IEEEFP) return append<float>(row, std::get<0>(array.values));
  if (layout.bits == 32 && !is_signed) return append<std::uint32_t>(row, std::get<0>(array.values));
  auto& values = std::get<1>(array.values);
  if (layout.bits == 32) return append<std::int32_t>(row, values);
  if (layout.bits == 16)
    return is_signed ? append<std::int16_t>(row, values) : append<std::uint16_t>(row, values);
  return is_signed ? append<std::int8_t>(row, values) : append<std::uint8_t>(row, values);
}

}  // namespace

GridFile read_tiff_stack(const std::filesystem::path& path) {
  const std::string name = path.string();
  TIFFSetErrorHandler(keep_message);
  TIFFSetWarningHandler(nullptr);
  const TiffFile file(TIFFOpen(name.c_str(), "r"));
  if (!file) fail("{}: expected TIFF, found something else", name);

  GridArray array;
  array.name = file_stem(path);
  const Layout layout = layout_of(file.get(), name);
  array.type = layout.type();
  array.components = layout.samples;
  if (array.type[0] != 'f' && array.type != "uint32") array.values = std::vector<std::int32_t>();
  std::size_t pages = 0;
  do {
    if (layout_of(file.get(), name) != layout) {
      fail("{}: expected pages of one size and type, found another on page {}", name, pages + 1);
    }
    std::vector<unsigned char> row(static_cast<std::size_t>(TIFFScanlineSize(file.get())));
    if (row.size() != layout.row_bytes()) fail("{}: expected rows of {} bytes", name, layout.row_bytes());
    for (std::uint32_t y = 0; y < layout.height; ++y) {
      if (TIFFReadScanline(file.get(), row.data(), y) != 1 || first_message[0] != '\0') {
        fail("{}: page {}, row {}: could not be read: {}", name, pages + 1, y, first_message.data());
      }
      append(layout, row, array);
    }
    ++pages;
  } while (TIFFReadDirectory(file.get()) != 0);
  if (first_message[0] != '\0')
    fail("{}: page {}: could not be read: {}", name, pages + 1, first_message.data());

  GridFile result;
  result.kind = "TIFF";
  const std::array<std::size_t, 3> size{layout.width, layout.height, pages};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < size[axis]; ++i) result.nodes[axis].push_back(static_cast<double>(i));
  }
  result.arrays.push_back(std::move(array));
  return result;
}

}  // namespace adamas
