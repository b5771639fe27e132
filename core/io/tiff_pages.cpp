#include "core/io/tiff_pages.h"

#include <tiffio.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "core/base/error.h"
#include "core/data/stored_type.h"
#include "core/io/grid_numbers.h"
#include "core/io/input_file.h"

namespace adamas::io {

namespace {

std::array<char, 256> first_message{};

void keep_message(const char*, const char* format, va_list arguments) {
  if (first_message[0] == '\0') std::vsnprintf(first_message.data(), first_message.size(), format, arguments);
}

}  // namespace

struct TiffPages::File {
  TIFF* tiff;
};

std::string TiffLayout::type() const {
  return (is_float ? "float" : is_signed ? "int" : "uint") + std::to_string(bits);
}

TiffPages::TiffPages(const std::filesystem::path& path) : name_(path.string()) {
  first_message[0] = '\0';
  TIFFSetErrorHandler(keep_message);
  TIFFSetWarningHandler(nullptr);
  TIFF* tiff = TIFFOpen(name_.c_str(), "r");
  if (tiff == nullptr) fail("{}: expected TIFF, found something else", name_);
  file_ = std::make_unique<File>(File{tiff});
  layout_ = find_layout();
}

TiffPages::~TiffPages() {
  if (file_) TIFFClose(file_->tiff);
}

TiffLayout TiffPages::find_layout() const {
  TIFF* file = file_->tiff;
  TiffLayout layout;
  std::uint16_t format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG;
  TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(file, TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &layout.samples);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &planar);
  layout.is_float = format == SAMPLEFORMAT_IEEEFP;
  layout.is_signed = format == SAMPLEFORMAT_INT;
  const bool known = (layout.is_float || format == SAMPLEFORMAT_UINT || layout.is_signed) &&
                     find_stored_type(layout.type()).has_value();
  if (layout.width == 0 || layout.height == 0) fail("{}: expected an image, found none", name_);
  if (!known)
    fail("{}: expected whole numbers of 8 to 64 bits or floats of 32 or 64, found {}", name_, layout.type());
  if (TIFFIsTiled(file) != 0) fail("{}: expected an image in strips, found tiles", name_);
  if (layout.samples > 1 && planar != PLANARCONFIG_CONTIG) {
    fail("{}: expected interleaved samples, found separate planes", name_);
  }
  if (static_cast<std::size_t>(TIFFScanlineSize(file)) != layout.row_bytes()) {
    fail("{}: expected rows of {} bytes", name_, layout.row_bytes());
  }
  return layout;
}

std::size_t TiffPages::count() const {
  const auto count = TIFFNumberOfDirectories(file_->tiff);
  check_messages();
  return count;
}

void TiffPages::check_messages() const {
  if (first_message[0] == '\0') return;
  fail("{}: page {}: could not be read: {}", name_, page_ + 1, first_message.data());
}

void TiffPages::read_row(std::uint32_t y, std::span<std::byte> row) {
  if (TIFFReadScanline(file_->tiff, row.data(), y) == 1 && first_message[0] == '\0') return;
  fail("{}: page {}, row {}: could not be read: {}", name_, page_ + 1, y, first_message.data());
}

bool TiffPages::next_page() {
  ++page_;
  if (TIFFReadDirectory(file_->tiff) == 0) {
    check_messages();
    return false;
  }
  if (find_layout() != layout_) {
    fail("{}: expected pages of one size and type, found another on page {}", name_, page_ + 1);
  }
  return true;
}

GridFile read_tiff_stack(const std::filesystem::path& path) {
  TiffPages pages(path);
  const TiffLayout& layout = pages.layout();
  GridArray array;
  array.name = file_stem(path);
  array.type = layout.type();
  array.components = layout.samples;
  std::vector<std::byte> bytes;
  do {
    for (std::uint32_t y = 0; y < layout.height; ++y) {
      bytes.resize(bytes.size() + layout.row_bytes());
      pages.read_row(y, std::span(bytes).last(layout.row_bytes()));
    }
  } while (pages.next_page());
  visit_stored_type(find_stored_type(array.type).value(), [&]<class Stored>(Stored) {
    set_numbers<Stored>(
        [&bytes](const auto& take) {
          for (std::size_t at = 0; at < bytes.size(); at += sizeof(Stored)) {
            Stored number;
            std::memcpy(&number, bytes.data() + at, sizeof(Stored));
            if (!take(number)) return;
          }
        },
        bytes.size() / sizeof(Stored), array);
  });

  GridFile result;
  result.kind = "TIFF";
  const std::array<std::size_t, 3> size{layout.width, layout.height, pages.page()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < size[axis]; ++i) result.nodes[axis].push_back(static_cast<double>(i));
    for (std::size_t i = 0; i <= size[axis]; ++i) result.faces[axis].push_back(static_cast<double>(i) - 0.5);
  }
  result.arrays.push_back(std::move(array));
  return result;
}

}  // namespace adamas::io
