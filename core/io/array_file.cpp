#include "core/io/array_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <span>
#include <type_traits>
#include <utility>

#include "core/base/checksum.h"
#include "core/base/error.h"
#include "core/io/array_file_head.h"
#include "core/io/hdf5_handle.h"
#include "core/io/hdf5_image.h"
#include "core/io/input_file.h"
#include "core/io/output_stream.h"
#include "core/io/reader_program.h"

namespace adamas::io {

void write_array_file(const std::filesystem::path& path, const ArrayFile& file) {
  Hdf5Image hdf5;
  for (const NamedArray& array : file.arrays) hdf5.add(array);
  const std::string image = hdf5.bytes();
  OutputStream stream(path);
  stream.write(
      array_file_head(file.format, file.version, image.size(), crc32c(std::as_bytes(std::span(image)))));
  stream.write(image);
  stream.finish();
}

namespace {

/// Reads arrays of one file in the child. Only data sets with the given names in the file itself are opened,
/// and none is read before all of them are known to have sizes that the file can hold.
class ArraySender {
 public:
  ArraySender(const ReaderRequest& request, hid_t file) : request_(request), file_(file) {
    for (const std::string& name : request.arrays) find(name);
    std::uint64_t bytes = 0;
    const std::uint64_t most = most_array_bytes(request.input_bytes);
    for (const Found& found : found_) {
      // In the end each text is a string of its own, which takes more memory than in the file.
      constexpr std::uint64_t kTextBytes = 48;
      const bool is_text = std::holds_alternative<std::vector<std::string>>(found.array.values);
      const std::uint64_t each = found.bytes + (is_text ? kTextBytes : 0);
      if (found.count > (most - bytes) / each)
        fail("{}: array '{}': expected no more values than a file of {} bytes has, found {} x {}",
             request.name, found.array.name, request.input_bytes, found.size[0], found.size[1]);
      bytes += found.count * each;
    }
  }

  void send(ByteSink& sink) {
    sink.put(static_cast<std::uint64_t>(found_.size()));
    for (Found& found : found_) {
      read(found);
      sink.put(std::exchange(found.array, {}));
    }
  }

 private:
  struct Found {
    NamedArray array;  ///< without values yet, but of their type
    std::array<hsize_t, 2> size{0, 1};
    std::uint64_t count = 0, bytes = 1;  ///< number of values, and size of each
  };

  [[noreturn]] void refuse(const std::string& array, const std::string& expected) const {
    fail("{}: array '{}': expected {}, found others", request_.name, array, expected);
  }

  /// Adds an array, if there is one; a '#' in its name stands for 0, 1, 2 and so on, as long as such an array
  /// exists.
  void find(const std::string& name) {
    const std::size_t place = name.find('#');
    if (place == std::string::npos) {
      if (is_linked(name)) found_.push_back(look_at(name));
      return;
    }
    for (std::size_t i = 0;; ++i) {
      const std::string numbered = name.substr(0, place) + std::to_string(i) + name.substr(place + 1);
      if (!is_linked(numbered)) return;
      found_.push_back(look_at(numbered));
    }
  }

  /// Whether an object of this name exists in the file itself.
  [[nodiscard]] bool is_linked(const std::string& name) const {
    for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
      const std::string part = name.substr(0, end);
      H5L_info_t link;
      if (H5Lexists(file_, part.c_str(), H5P_DEFAULT) <= 0) return false;
      if (H5Lget_info(file_, part.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD)
        refuse(part, "arrays and groups in the file itself");
      if (end == std::string::npos) return true;
    }
  }

  [[nodiscard]] Found look_at(const std::string& name) const {
    const Hdf5Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(set.good() ? H5Dget_space(set.id()) : -1, H5Sclose);
    const Hdf5Handle type(set.good() ? H5Dget_type(set.id()) : -1, H5Tclose);
    const Hdf5Handle layout(set.good() ? H5Dget_create_plist(set.id()) : -1, H5Pclose);
    Found found{{name, 1, {}}};
    if (!space.good() || !type.good() || !layout.good() || H5Sget_simple_extent_ndims(space.id()) > 2 ||
        H5Sget_simple_extent_dims(space.id(), found.size.data(), nullptr) < 1)
      refuse(name, "one or two dimensions");
    check_layout(name, layout.id());
    const std::size_t bytes = H5Tget_size(type.id());
    switch (H5Tget_class(type.id())) {
      case H5T_FLOAT:
        if (bytes != 4 && bytes != 8) refuse(name, "numbers of 4 or 8 bytes");
        if (bytes == 4) found.array.values = std::vector<float>();
        break;
      case H5T_INTEGER:
        if (bytes != 4 && bytes != 1) refuse(name, "whole numbers of 1 or 4 bytes");
        if (bytes == 4) found.array.values = std::vector<std::int32_t>();
        if (bytes == 1) found.array.values = std::vector<std::uint8_t>();
        break;
      case H5T_STRING:
        if (H5Tis_variable_str(type.id()) > 0) refuse(name, "texts of one length");
        found.array.values = std::vector<std::string>();
        break;
      default:
        refuse(name, "numbers or texts");
    }
    found.bytes = bytes;
    constexpr hsize_t kMost = std::uint64_t{1} << 31;
    if (found.size[0] >= kMost || found.size[1] == 0 || found.size[1] >= kMost || bytes >= kMost)
      refuse(name, "fewer than 2147483648 rows");
    found.count = found.size[0] * found.size[1];
    found.array.components = static_cast<int>(found.size[1]);
    return found;
  }

  /// Refuses values that lie in other files, and filters that HDF5 would load to unpack them.
  void check_layout(const std::string& name, hid_t layout) const {
    if (!hdf5_holds_values(layout)) refuse(name, "values in the file itself");
    for (int i = 0; i < H5Pget_nfilters(layout); ++i) {
      unsigned flags = 0, settings = 0;
      std::size_t values = 0;
      const H5Z_filter_t filter =
          H5Pget_filter2(layout, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &settings);
      if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE)
        refuse(name, "values that are shuffled or deflated, if at all");
    }
  }

  void read(Found& found) const {
    const Hdf5Handle set(H5Dopen2(file_, found.array.name.c_str(), H5P_DEFAULT), H5Dclose);
    const auto read_as = [&](hid_t type, auto& values, const char* expected) {
      if (!values.empty() && H5Dread(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
        refuse(found.array.name, expected);
    };
    const auto read_values = [&]<class Value>(std::vector<Value>& values) {
      if constexpr (std::is_same_v<Value, std::string>) {
        std::string all(found.count * found.bytes, '\0');
        read_as(hdf5_text_type(found.bytes).id(), all, "whole texts");
        for (std::size_t i = 0; i < found.count; ++i) {
          const std::string text = all.substr(i * found.bytes, found.bytes);
          values.push_back(text.substr(0, text.find('\0')));
        }
      } else {
        values.resize(found.count);
        read_as(hdf5_type_of<Value>(), values, "whole values");
      }
    };
    std::visit(read_values, found.array.values);
  }

  const ReaderRequest& request_;
  hid_t file_;
  std::vector<Found> found_;
};

/// Returns the version of the file, once its bytes are known to be those that were written.
int check_whole(const std::filesystem::path& path, const std::string& format, int oldest, int newest) {
  const std::string name = path.string();
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("{}: expected a file that can be read, found none", name);
  std::string head(kArrayFileHeadBytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  const std::string line = array_file_line(format);
  if (head.rfind(line, 0) != 0)
    fail("{}: expected a file that begins with 'adamas {}', found another", name, format);
  int version = 0;
  unsigned long long length = 0;
  unsigned checksum = 0;
  if (std::sscanf(head.c_str() + line.size(), "version %d\nbytes %llu\ncrc32c %x\n", &version, &length,
                  &checksum) != 3)
    fail("{}: expected a version, a length and a checksum, found others", name);
  if (version < oldest || version > newest)
    fail("{}: expected version {} of 'adamas {}', found {}", name,
         oldest == newest ? std::to_string(newest) : fmt::format("{} to {}", oldest, newest), format,
         version);
  std::string piece(std::size_t{1} << 20, '\0');
  std::size_t bytes = 0;
  std::uint32_t found = 0;
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto read = static_cast<std::size_t>(stream.gcount());
    found = crc32c(std::as_bytes(std::span(piece).first(read)), found);
    bytes += read;
  }
  if (head.size() + bytes != length)
    fail("{}: expected {} bytes, found {}", name, length, head.size() + bytes);
  if (found != checksum)
    fail_as(ErrorKind::kDamaged, "{}: expected the checksum {:08x}, found {:08x}: the file is damaged", name,
            checksum, found);
  if (head != array_file_head(format, version, bytes, checksum))
    fail_as(ErrorKind::kDamaged, "{}: its first {} bytes are damaged", name, kArrayFileHeadBytes);
  return version;
}

}  // namespace

bool is_array_file(const std::filesystem::path& path, const std::string& format) {
  std::ifstream stream(path, std::ios::binary);
  const std::string wanted = array_file_line(format);
  std::string found(wanted.size(), '\0');
  stream.read(found.data(), static_cast<std::streamsize>(found.size()));
  return stream && found == wanted;
}

ArrayFile read_array_file(const std::filesystem::path& path, const std::string& format,
                          const std::vector<std::string>& names, int oldest, int newest) {
  ArrayFile file{format, check_whole(path, format, oldest, newest), {}};
  ReaderRequest request = request_of(LibraryReader::kArrays, path);
  request.arrays = names;
  file.arrays = receive_from_child<std::vector<NamedArray>>(request);
  return file;
}

void send_arrays(const ReaderRequest& request, ByteSink& sink) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle file(H5Fopen(request.paths.at(0).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good())
    fail("{}: expected HDF5 behind {} bytes, found something else", request.name, kArrayFileHeadBytes);
  ArraySender(request, file.id()).send(sink);
}

}  // namespace adamas::io
