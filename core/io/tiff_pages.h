#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/io/grid_file.h"

namespace adamas::io {

/// The size of a page and the type of its samples.
struct TiffLayout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1;  ///< bits of a sample, and samples of a pixel
  bool is_signed = false, is_float = false;
  bool operator==(const TiffLayout&) const = default;

  /// The type of a sample by name, as "uint16".
  [[nodiscard]] std::string type() const;
  [[nodiscard]] std::size_t row_bytes() const { return std::size_t{width} * samples * bits / 8; }
};

/// The pages of a TIFF file one after the other, and their rows. Throws Error that names the file if it
/// cannot be read, and for images in tiles or with samples other than whole numbers of 8, 16, 32 or 64 bits
/// and floats of 32 or 64. Only the reader process uses it: libtiff may crash on a corrupt file.
class TiffPages {
 public:
  explicit TiffPages(const std::filesystem::path& path);
  ~TiffPages();
  TiffPages(const TiffPages&) = delete;
  TiffPages& operator=(const TiffPages&) = delete;

  /// The layout of the current page, which is the first one in the beginning.
  [[nodiscard]] const TiffLayout& layout() const { return layout_; }
  [[nodiscard]] std::size_t page() const { return page_; }
  /// The number of pages.
  [[nodiscard]] std::size_t count() const;
  /// Reads a row of layout().row_bytes() bytes in the machine's byte order; rows are read one after the
  /// other.
  void read_row(std::uint32_t y, std::span<std::byte> row);
  /// Goes to the next page; returns false behind the last one. Throws Error if the next page has another
  /// layout.
  bool next_page();

 private:
  struct File;
  [[nodiscard]] TiffLayout find_layout() const;
  void check_messages() const;

  std::string name_;
  std::unique_ptr<File> file_;
  TiffLayout layout_;
  std::size_t page_ = 0;
};

/// Reads the pages of a TIFF file as the z planes of one image: rows as stored, the first at y = 0; unit
/// spacing. (VTK's own reader converts files of several pages to 8-bit RGBA.) Only the reader process calls
/// it: libtiff may crash on a corrupt file.
GridFile read_tiff_stack(const std::filesystem::path& path);

}  // namespace adamas::io
