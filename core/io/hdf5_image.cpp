#include "core/io/hdf5_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "core/base/error.h"
#include "core/io/hdf5_handle.h"

namespace adamas::io {

namespace {

constexpr hsize_t kChunk = 1 << 16;
constexpr unsigned kDeflate = 4;
/// Smaller arrays, in bytes, are not worth chunks of their own.
constexpr std::size_t kCompact = 4096;
constexpr std::size_t kGrowth = std::size_t{1} << 20;

[[noreturn]] void broken(const std::string& what) { fail("a file of HDF5 that is made in memory: {}", what); }

/// Writes an array; `components` numbers per row if there are several.
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

}  // namespace

struct Hdf5Image::File {
  File()
      : access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose),
        file(H5Pset_fapl_core(access.id(), kGrowth, false) < 0
                 ? -1
                 : H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, access.id()),
             H5Fclose) {
    if (!file.good()) broken("HDF5 could not begin a file");
  }

  [[nodiscard]] hid_t id() const { return file.id(); }

  /// Opens a group, which is made if there is none.
  [[nodiscard]] Hdf5Handle open_group(const std::string& name) const {
    const bool exists = H5Lexists(id(), name.c_str(), H5P_DEFAULT) > 0;
    return {exists ? H5Gopen2(id(), name.c_str(), H5P_DEFAULT)
                   : H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Gclose};
  }

  Hdf5Handle access, file;
};

Hdf5Image::Hdf5Image() : file_(std::make_unique<File>()) {}
Hdf5Image::~Hdf5Image() = default;

void Hdf5Image::add(const NamedArray& array) { add_array(file_->id(), array); }

void Hdf5Image::add(const std::string& name, std::span<const std::int64_t> numbers) {
  add_data(file_->id(), name, H5T_STD_I64LE, numbers.size(), 1, numbers.data());
}

void Hdf5Image::add_texts(const std::string& name, const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose),
      layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Pset_create_intermediate_group(links.id(), 1);
  H5Pset_obj_track_times(layout.id(), false);
  const hsize_t count = pointers.size();
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle set(
      H5Dcreate2(file_->id(), name.c_str(), type.id(), space.id(), links.id(), layout.id(), H5P_DEFAULT),
      H5Dclose);
  if (!set.good() ||
      (count > 0 && H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0))
    broken(fmt::format("the texts '{}' could not be written", name));
}

void Hdf5Image::add_attribute(const std::string& group, const char* name, const std::string& text) {
  const Hdf5Handle owner = file_->open_group(group), space(H5Screate(H5S_SCALAR), H5Sclose),
                   type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  const Hdf5Handle attribute(H5Acreate2(owner.id(), name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  if (!attribute.good() || H5Awrite(attribute.id(), type.id(), text.c_str()) < 0)
    broken(fmt::format("the attribute '{}' could not be written", name));
}

void Hdf5Image::add_attribute(const std::string& group, const char* name,
                              std::span<const std::int64_t> numbers) {
  const hsize_t count = numbers.size();
  const Hdf5Handle owner = file_->open_group(group), space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(owner.id(), name, H5T_STD_I64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.good() || H5Awrite(attribute.id(), H5T_NATIVE_INT64, numbers.data()) < 0)
    broken(fmt::format("the attribute '{}' could not be written", name));
}

std::string Hdf5Image::bytes() {
  H5Fflush(file_->id(), H5F_SCOPE_GLOBAL);
  const ssize_t size = H5Fget_file_image(file_->id(), nullptr, 0);
  if (size <= 0) broken("HDF5 could not end a file");
  std::string result(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file_->id(), result.data(), result.size()) != size)
    broken("HDF5 could not end a file");
  return result;
}

}  // namespace adamas::io
