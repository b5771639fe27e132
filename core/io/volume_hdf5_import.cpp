#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/io/hdf5_handle.h"
#include "core/io/input_file.h"
#include "core/io/volume_import.h"

namespace adamas {

namespace {

/// The type that samples are handed over as; nothing where they are no numbers.
std::optional<StoredType> find_type(hid_t type) {
  const std::size_t bytes = H5Tget_size(type);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_FLOAT) return bytes <= 4 ? StoredType::kFloat32 : StoredType::kFloat64;
  if (kind != H5T_INTEGER) return {};
  const bool is_signed = H5Tget_sign(type) == H5T_SGN_2;
  if (bytes == 1) return is_signed ? StoredType::kInt8 : StoredType::kUint8;
  if (bytes == 2) return is_signed ? StoredType::kInt16 : StoredType::kUint16;
  if (bytes == 4) return is_signed ? StoredType::kInt32 : StoredType::kUint32;
  return is_signed ? StoredType::kInt64 : StoredType::kUint64;
}

hid_t memory_type(StoredType type) {
  const std::array<hid_t, 10> types{H5T_NATIVE_INT8,  H5T_NATIVE_UINT8,  H5T_NATIVE_INT16, H5T_NATIVE_UINT16,
                                    H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                                    H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE};
  return types[static_cast<std::size_t>(type)];
}

/// Whether it is a data set of numbers along three axes.
bool is_volume(hid_t file, const char* name) {
  const Hdf5Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(set.good() ? H5Dget_space(set.id()) : -1, H5Sclose);
  const Hdf5Handle type(set.good() ? H5Dget_type(set.id()) : -1, H5Tclose);
  return space.good() && type.good() && H5Sget_simple_extent_ndims(space.id()) == 3 && find_type(type.id());
}

/// The names of all such, no more than are worth listing.
constexpr std::size_t kMostListed = 8;
std::vector<std::string> find_volumes(hid_t file) {
  std::vector<std::string> names;
  const auto add = [](hid_t root, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    auto& list = *static_cast<std::vector<std::string>*>(found);
    if (info->type == H5O_TYPE_DATASET && is_volume(root, name)) list.emplace_back(name);
    return list.size() < kMostListed ? 0 : 1;
  };
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, add, &names);
  return names;
}

/// Reads a data set, in the child.
class DataSet {
 public:
  DataSet(const std::string& name, hid_t file, const std::string& path)
      : name_(name + ": " + path), set_(H5Dopen2(file, path.c_str(), access().id()), H5Dclose) {
    if (!set_.good()) fail("{}: expected a data set, found none", name_);
    const Hdf5Handle type(H5Dget_type(set_.id()), H5Tclose);
    const auto stored = type.good() ? find_type(type.id()) : std::nullopt;
    if (!stored) fail("{}: expected one number per sample, found another type", name_);
    volume_.stored = *stored;
    set_dimensions();
    set_spacing();
  }

  void send(ImportSink& sink) {
    sink.begin(volume_);
    const std::array<hsize_t, 3> size{volume_.dimensions[2], volume_.dimensions[1], volume_.dimensions[0]};
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    std::vector<std::byte> planes;
    const std::uint64_t plane_bytes = size[1] * size[2] * stored_bytes(volume_.stored);
    const std::uint64_t step = planes_at_once(plane_bytes);
    for (hsize_t k = 0; k < size[0]; k += step) {
      const std::array<hsize_t, 3> start{k, 0, 0},
          count{std::min<hsize_t>(step, size[0] - k), size[1], size[2]};
      const Hdf5Handle memory(H5Screate_simple(3, count.data(), nullptr), H5Sclose);
      planes.resize(count[0] * plane_bytes);
      const bool read = H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                            nullptr) >= 0 &&
                        H5Dread(set_.id(), memory_type(volume_.stored), memory.id(), space.id(), H5P_DEFAULT,
                                planes.data()) >= 0;
      if (!read) fail("{}: plane {}: expected whole samples, found corrupt or missing ones", name_, k);
      sink.samples(planes);
    }
  }

 private:
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;

  /// With room for the chunks that a plane crosses.
  static Hdf5Handle access() {
    const hid_t list = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(list, 100'003, kMostBytes, 1);
    return {list, H5Pclose};
  }

  void set_dimensions() {
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    const int axes = space.good() ? H5Sget_simple_extent_ndims(space.id()) : 0;
    if (axes != 3) fail("{}: expected samples along three axes, found {}", name_, axes);
    std::array<hsize_t, 3> size{};
    H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
    volume_.dimensions = {size[2], size[1], size[0]};
    VolumeGrid grid;
    grid.dimensions = volume_.dimensions;
    grid.check(name_);
    // Samples that were never written would all come as the fill value.
    if (H5Dget_storage_size(set_.id()) == 0)
      fail("{}: expected samples, found a data set without any", name_);
  }

  void set_spacing() {
    const char* name = "element_size_um";
    if (H5Aexists(set_.id(), name) <= 0) return;
    const Hdf5Handle attribute(H5Aopen(set_.id(), name, H5P_DEFAULT), H5Aclose);
    const Hdf5Handle space(attribute.good() ? H5Aget_space(attribute.id()) : -1, H5Sclose);
    std::array<double, 3> zyx{};
    if (!space.good() || H5Sget_simple_extent_npoints(space.id()) != 3 ||
        H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, zyx.data()) < 0) {
      return;
    }
    if (std::all_of(zyx.begin(), zyx.end(), [](double s) { return s > 0 && std::isfinite(s); })) {
      volume_.spacing = {zyx[2], zyx[1], zyx[0]};
    }
  }

  /// As many as a layer of chunks has, where they fit into memory.
  [[nodiscard]] std::uint64_t planes_at_once(std::uint64_t plane_bytes) const {
    const Hdf5Handle list(H5Dget_create_plist(set_.id()), H5Pclose);
    std::array<hsize_t, 3> chunk{1, 1, 1};
    if (H5Pget_layout(list.id()) == H5D_CHUNKED) H5Pget_chunk(list.id(), 3, chunk.data());
    return std::max<std::uint64_t>(1, std::min<std::uint64_t>(chunk[0], kMostBytes / plane_bytes));
  }

  std::string name_;
  Hdf5Handle set_;
  ImportedVolume volume_;
};

std::string chosen_set(const std::string& name, hid_t file, const std::string& wanted) {
  const auto found = find_volumes(file);
  std::string names;
  for (const std::string& one : found) names += (names.empty() ? "'" : ", '") + one + "'";
  if (!wanted.empty()) {
    if (H5Lexists(file, wanted.c_str(), H5P_DEFAULT) > 0) return wanted;
    fail("{}: expected a data set '{}', found {}", name, wanted,
         names.empty() ? "none of three axes" : names);
  }
  if (found.empty()) fail("{}: expected a data set of numbers along three axes, found none", name);
  if (found.size() == kMostListed) names += ", ...";
  if (found.size() > 1) fail("{}: expected the name of a data set, found {}", name, names);
  return found.front();
}

}  // namespace

void send_hdf5_volume(const ReaderRequest& request, ByteSink& sink) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string& name = request.name;
  const Hdf5Handle file(H5Fopen(request.paths.front().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) fail("{}: expected a whole HDF5 file, found something else", name);
  ImportSink import(request, sink);
  DataSet(name, file.id(), chosen_set(name, file.id(), request.array)).send(import);
}

VolumeSource import_hdf5(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  const std::uint64_t size = check_input_file(path);
  return import_volume({LibraryReader::kHdf5Volume, path.string(), size, {path.string()}, options.array},
                       options, progress);
}

}  // namespace adamas
