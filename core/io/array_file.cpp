#include "core/io/array_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <type_traits>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "core/io/hdf5_handle.h"
#include "core/io/output_stream.h"

namespace adamas {

namespace {

constexpr std::size_t kHeadBytes = 512;
constexpr hsize_t kChunk = 1 << 16;
constexpr unsigned kDeflate = 4;
/// Arrays of so many bytes are not worth chunks of their own.
constexpr std::size_t kCompact = 4096;
constexpr std::size_t kGrowth = std::size_t{1} << 20;

[[noreturn]] void broken(const std::string& what) { fail("an array file: {}", what); }

template <class T>
hid_t type_of();
template <>
hid_t type_of<double>() {
  return H5T_IEEE_F64LE;
}
template <>
hid_t type_of<float>() {
  return H5T_IEEE_F32LE;
}
template <>
hid_t type_of<std::int32_t>() {
  return H5T_STD_I32LE;
}
template <>
hid_t type_of<std::uint8_t>() {
  return H5T_STD_U8LE;
}

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

Hdf5Handle text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, length);
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return {type, H5Tclose};
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
          add_data(file, array.name, text_type(length).id(), values.size(), 1, all.data());
        } else {
          add_data(file, array.name, type_of<Value>(), values.size(), array.components, values.data());
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

std::string head_of(const ArrayFile& file, std::size_t bytes, std::uint32_t checksum) {
  std::string head = fmt::format("adamas {}\nversion {}\nbytes {}\ncrc32c {:08x}\n", file.format,
                                 file.version, bytes, checksum);
  head.resize(kHeadBytes, '\0');
  return head;
}

std::string first_line(const std::string& format) { return "adamas " + format + "\n"; }

std::uint32_t checksum_of(const std::string& bytes) { return crc32c(std::as_bytes(std::span(bytes))); }

template <class T>
std::vector<T> read_numbers(hid_t set, std::size_t count, const std::string& name) {
  std::vector<T> values(count);
  if (count > 0 && H5Dread(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail("array '{}': expected whole values, found others", name);
  return values;
}

std::vector<std::string> read_texts(hid_t set, std::size_t length, std::size_t count,
                                    const std::string& name) {
  std::string all(count * length, '\0');
  if (count > 0 && H5Dread(set, text_type(length).id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0)
    fail("array '{}': expected whole texts, found others", name);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    std::string text = all.substr(i * length, length);
    text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
    texts.push_back(std::move(text));
  }
  return texts;
}

NamedArray read_array(hid_t file, const std::string& name) {
  const Hdf5Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(set.good() ? H5Dget_space(set.id()) : -1, H5Sclose);
  const Hdf5Handle type(set.good() ? H5Dget_type(set.id()) : -1, H5Tclose);
  std::array<hsize_t, 2> size{0, 1};
  if (!space.good() || !type.good() || H5Sget_simple_extent_ndims(space.id()) > 2 ||
      H5Sget_simple_extent_dims(space.id(), size.data(), nullptr) < 1)
    fail("array '{}': expected one or two dimensions, found others", name);
  NamedArray array{name, static_cast<int>(size[1]), {}};
  const std::size_t count = size[0] * size[1], bytes = H5Tget_size(type.id());
  switch (H5Tget_class(type.id())) {
    case H5T_FLOAT:
      if (bytes == 8) array.values = read_numbers<double>(set.id(), count, name);
      if (bytes == 4) array.values = read_numbers<float>(set.id(), count, name);
      break;
    case H5T_INTEGER:
      if (bytes == 4) array.values = read_numbers<std::int32_t>(set.id(), count, name);
      if (bytes == 1) array.values = read_numbers<std::uint8_t>(set.id(), count, name);
      break;
    case H5T_STRING:
      array.values = read_texts(set.id(), bytes, count, name);
      break;
    default:
      fail("array '{}': expected numbers or texts, found others", name);
  }
  return array;
}

std::vector<std::string> array_names(hid_t file) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &names);
  return names;
}

std::string read_all(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("{}: expected a file that can be read, found none", path.string());
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(path)), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace

void write_array_file(const std::filesystem::path& path, const ArrayFile& file) {
  const std::string image = image_of(file.arrays);
  OutputStream stream(path);
  stream.write(head_of(file, kHeadBytes + image.size(), checksum_of(image)));
  stream.write(image);
  stream.finish();
}

bool is_array_file(const std::filesystem::path& path, const std::string& format) {
  std::ifstream stream(path, std::ios::binary);
  const std::string wanted = first_line(format);
  std::string found(wanted.size(), '\0');
  stream.read(found.data(), static_cast<std::streamsize>(found.size()));
  return stream && found == wanted;
}

ArrayFile read_array_file(const std::filesystem::path& path, const std::string& format, int version) {
  std::string bytes = read_all(path);
  const std::string name = path.string();
  if (bytes.rfind(first_line(format), 0) != 0)
    fail("{}: expected a file that begins with 'adamas {}', found another", name, format);
  ArrayFile file{format, 0, {}};
  unsigned long long length = 0;
  unsigned checksum = 0;
  const std::string head = bytes.substr(0, kHeadBytes);
  if (std::sscanf(head.c_str() + first_line(format).size(), "version %d\nbytes %llu\ncrc32c %x\n",
                  &file.version, &length, &checksum) != 3)
    fail("{}: expected a version, a length and a checksum, found others", name);
  if (file.version != version)
    fail("{}: expected version {} of 'adamas {}', found {}", name, version, format, file.version);
  if (bytes.size() != length) fail("{}: expected {} bytes, found {}", name, length, bytes.size());
  bytes.erase(0, kHeadBytes);
  if (const std::uint32_t found = checksum_of(bytes); found != checksum)
    fail("{}: expected the checksum {:08x}, found {:08x}: the file is damaged", name, checksum, found);
  if (head != head_of(file, length, checksum)) fail("{}: its first {} bytes are damaged", name, kHeadBytes);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), kGrowth, false);
  H5Pset_file_image(access.id(), bytes.data(), bytes.size());
  const Hdf5Handle opened(H5Fopen("in memory", H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!opened.good()) fail("{}: expected HDF5 behind {} bytes, found something else", name, kHeadBytes);
  for (const std::string& array : array_names(opened.id())) {
    try {
      file.arrays.push_back(read_array(opened.id(), array));
    } catch (const Error& error) {
      fail("{}: {}", name, error.what());
    }
  }
  return file;
}

}  // namespace adamas
