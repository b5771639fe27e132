#include "core/io/tiff_reader.h"

#include <cstring>

#include "core/io/input_file.h"
#include "core/io/tiff_pages.h"

namespace adamas {

namespace {

template <class T, class Out>
void append(const std::vector<std::byte>& row, std::vector<Out>& values) {
  for (std::size_t at = 0; at + sizeof(T) <= row.size(); at += sizeof(T)) {
    T value;
    std::memcpy(&value, row.data() + at, sizeof(T));
    values.push_back(static_cast<Out>(value));
  }
}

void append(const TiffLayout& layout, const std::vector<std::byte>& row, GridArray& array) {
  if (layout.is_float) return append<float>(row, std::get<0>(array.values));
  if (layout.bits == 32 && !layout.is_signed) return append<std::uint32_t>(row, std::get<0>(array.values));
  auto& values = std::get<1>(array.values);
  if (layout.bits == 32) return append<std::int32_t>(row, values);
  if (layout.bits == 16) {
    return layout.is_signed ? append<std::int16_t>(row, values) : append<std::uint16_t>(row, values);
  }
  return layout.is_signed ? append<std::int8_t>(row, values) : append<std::uint8_t>(row, values);
}

}  // namespace

GridFile read_tiff_stack(const std::filesystem::path& path) {
  TiffPages pages(path);
  const TiffLayout& layout = pages.layout();
  GridArray array;
  array.name = file_stem(path);
  array.type = layout.type();
  array.components = layout.samples;
  if (array.type[0] != 'f' && array.type != "uint32") array.values = std::vector<std::int32_t>();
  std::vector<std::byte> row(layout.row_bytes());
  do {
    for (std::uint32_t y = 0; y < layout.height; ++y) {
      pages.read_row(y, row);
      append(layout, row, array);
    }
  } while (pages.next_page());

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

}  // namespace adamas
