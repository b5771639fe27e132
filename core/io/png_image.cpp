#include "core/io/png_image.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "core/base/error.h"

namespace adamas::io {

namespace {

/// A PNG file that is being read. libpng leaves a failing function by longjmp, so its calls are in functions
/// that have nothing to destroy.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : name_(path.string()) {
    file_ = std::fopen(name_.c_str(), "rb");
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_error, [](png_structp, const char*) {});
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (file_ == nullptr || info_ == nullptr) fail("{}: expected a readable PNG file, found none", name_);
  }
  ~Reader() {
    png_destroy_read_struct(&png_, &info_, nullptr);
    if (file_ != nullptr) std::fclose(file_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  void check() {
    if (!read_header()) fail_here();
    rows_.resize(png_get_image_height(png_, info_));
    row_.resize(png_get_rowbytes(png_, info_));
    std::fill(rows_.begin(), rows_.end(), reinterpret_cast<png_bytep>(row_.data()));
    if (!read_rows()) fail_here();
  }

  PngImage run() {
    if (!read_header()) fail_here();
    const int color = png_get_color_type(png_, info_);
    PngImage image;
    image.width = png_get_image_width(png_, info_);
    image.height = png_get_image_height(png_, info_);
    image.bits = png_get_bit_depth(png_, info_);
    if (color != PNG_COLOR_TYPE_GRAY || image.bits < 8) {
      fail("{}: expected gray samples of 8 or 16 bits, found {} of {} bits", name_,
           color == PNG_COLOR_TYPE_GRAY ? "gray ones" : "colours", image.bits);
    }
    const std::size_t row = std::size_t{image.width} * static_cast<std::size_t>(image.bits) / 8;
    image.samples.resize(row * image.height);
    rows_.reserve(image.height);
    for (std::uint32_t y = 0; y < image.height; ++y) {
      rows_.push_back(reinterpret_cast<png_bytep>(image.samples.data() + y * row));
    }
    if (!read_rows()) fail_here();
    return image;
  }

 private:
  static void keep_error(png_structp png, const char* text) {
    auto* reader = static_cast<Reader*>(png_get_error_ptr(png));
    std::snprintf(reader->error_.data(), reader->error_.size(), "%s", text);
    png_longjmp(png, 1);
  }

  [[noreturn]] void fail_here() const { fail("{}: expected a whole PNG file: {}", name_, error_.data()); }

  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, file_);
    png_read_info(png_, info_);
    return true;
  }

  bool read_rows() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows_.data());
    png_read_end(png_, nullptr);
    return true;
  }

  std::string name_;
  std::FILE* file_ = nullptr;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::vector<png_bytep> rows_;
  std::vector<std::byte> row_;  ///< receives the rows that are only checked
  std::array<char, 128> error_{};
};

}  // namespace

void check_png(const std::filesystem::path& path) { Reader(path).check(); }

PngImage read_png(const std::filesystem::path& path) { return Reader(path).run(); }

}  // namespace adamas::io
