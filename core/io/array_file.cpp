#include "core/io/array_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "core/io/array_file_head.h"
#include "core/io/hdf5_handle.h"
#include "core/io/output_stream.h"

namespace adamas::io {

namespace {

constexpr hsize_t kChunk = 1 << 16;
constexpr unsigned kDeflate = 4;
/// Arrays of so many bytes are not worth chunks of their own.
constexpr std::size_t kCompact = 4096;
constexpr std::size_t kGrowth = std::size_t{1} << 20;

[[noreturn]] void broken(const std::string& what) { fail("an array file: {}", what); }

/// Writes an array; `components` numbers to a row, where there are several.
void add_data(hid_t file, const std::string& name, hid_t type, std::size_t count, int components,
              const void* data) {
  const auto columns = static_cast<hsize_t>(std::max(components, 1));
  const std::array<hsize_t, 2> size{count / columns, columns};
  const int dimensions = components > 1 ? 2 : 1;
  const Hdf5Handle space(H5Screate_simple(dimensions, size.data(), nullptr), H5Sclose);
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
      layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  H5Pset_obj_track_times(layout.id(), false);
  if (count * H5Tget_size(type) <= kCompact) {
    H5Pset_layout(layout.id(), H5D_COMPACT);
  } else {
    const std::array<hsize_t, 2> chunk{std::min(size[0], std::max<hsize_t>(kChunk / columns, 1)), columns};
    H5Pset_chunk(layout.id(), dimensions, chunk.data());
    H5Pset_shuffle(layout.id());
    H5Pset_deflate(layout.id(), kDeflate);
  }
  const Hdf5Handle set(H5Dcreate2(file, name.c_str(), type, space.id(), links.id(), layout.id(), H5P_DEFAULT),
                       H5Dclose);
  if (!set.good() || (count > 0 && H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
    broken(fmt::format("the array '{}' could not be written", name));
}

void add_array(hid_t file, const NamedArray& array) {
  std::visit(
      [&](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_same_v<Value, std::string>) {
          std::size_t length = 1;
          for (const std::string& text : values) length = std::max(length, text.size());
          std::string all(values.size() * length, '\0');
          for (std::size_t i = 0; i < values.size(); ++i)
            std::copy(values[i].begin(), values[i].end(),
                      all.begin() + static_cast<std::ptrdiff_t>(i * length));
          add_data(file, array.name, hdf5_text_type(length).id(), values.size(), 1, all.data());
        } else {
          add_data(file, array.name, hdf5_type_of<Value>(), values.size(), array.components, values.data());
        }
      },
      array.values);
}

/// The bytes of an HDF5 file that is kept in memory.
std::string image_of(const std::vector<NamedArray>& arrays) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), kGrowth, false);
  const Hdf5Handle file(H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  if (!file.good()) broken("HDF5 could not begin a file");
  for (const NamedArray& array : arrays) add_array(file.id(), array);
  H5Fflush(file.id(), H5F_SCOPE_GLOBAL);
  const ssize_t size = H5Fget_file_image(file.id(), nullptr, 0);
  if (size <= 0) broken("HDF5 could not end a file");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file.id(), bytes.data(), bytes.size()) != size) broken("HDF5 could not end a file");
  return bytes;
}

}  // namespace

void write_array_file(const std::filesystem::path& path, const ArrayFile& file) {
  const std::string image = image_of(file.arrays);
  OutputStream stream(path);
  stream.write(
      array_file_head(file.format, file.version, image.size(), crc32c(std::as_bytes(std::span(image)))));
  stream.write(image);
  stream.finish();
}

}  // namespace adamas::io
