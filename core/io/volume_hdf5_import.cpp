#include <algorithm>
#include <array>
#include <optional>

#include "core/base/error.h"
#include "core/io/hdf5_handle.h"
#include "core/io/hdf5_volumes.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/volume_import.h"

namespace adamas::io {

namespace {

/// Reads a data set, or one time of it, in the child.
class DataSet {
 public:
  DataSet(const std::string& name, hid_t file, const std::string& path, std::optional<std::uint64_t> time)
      : path_(path), name_(name + ": " + path), set_(H5Dopen2(file, path.c_str(), access().id()), H5Dclose) {
    if (!set_.good()) fail("{}: expected a data set, found none", name_);
    const Hdf5Handle type(H5Dget_type(set_.id()), H5Tclose);
    const auto stored = type.good() ? hdf5_stored_type(type.id()) : std::nullopt;
    if (!stored) fail("{}: expected one number per sample, found another type", name_);
    volume_.stored = *stored;
    set_dimensions(time);
    volume_.spacing = hdf5_spacing(set_.id());
  }

  void send(ImportSink& sink) {
    sink.begin(volume_, path_);
    const auto [nx, ny, nz] = volume_.dimensions;
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    std::vector<std::byte> planes;
    const std::uint64_t plane_bytes = nx * ny * stored_bytes(volume_.stored);
    const std::uint64_t step = planes_at_once(plane_bytes);
    for (hsize_t k = 0; k < nz; k += step) {
      std::vector<hsize_t> start{k, 0, 0}, count{std::min<hsize_t>(step, nz - k), ny, nx};
      planes.resize(count[0] * plane_bytes);
      if (has_times_) {
        start.insert(start.begin(), time_);
        count.insert(count.begin(), 1);
      }
      const Hdf5Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                              H5Sclose);
      const bool read = H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                            nullptr) >= 0 &&
                        H5Dread(set_.id(), hdf5_memory_type(volume_.stored), memory.id(), space.id(),
                                H5P_DEFAULT, planes.data()) >= 0;
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

  void set_dimensions(std::optional<std::uint64_t> time) {
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    const int axes = space.good() ? H5Sget_simple_extent_ndims(space.id()) : 0;
    if (axes != 3 && axes != 4) fail("{}: expected samples along three axes, found {}", name_, axes);
    has_times_ = axes == 4;
    std::array<hsize_t, 4> size{1};
    H5Sget_simple_extent_dims(space.id(), size.data() + (has_times_ ? 0 : 1), nullptr);
    const std::uint64_t last = size[0] - std::min<std::uint64_t>(size[0], 1);
    if (has_times_ && !time)
      fail("{}: expected samples along three axes, or one time of four by --time (0 to {})", name_, last);
    time_ = time.value_or(0);
    if (time_ > last) fail("{}: expected a time from 0 to {}, found {}", name_, last, time_);
    volume_.dimensions = {size[3], size[2], size[1]};
    VolumeGrid grid;
    grid.dimensions = volume_.dimensions;
    grid.check(name_);
    check_hdf5_samples(name_, set_.id());
    // Samples that were never written would all come as the fill value.
    if (H5Dget_storage_size(set_.id()) == 0)
      fail("{}: expected samples, found a data set without any", name_);
  }

  /// As many as a layer of chunks has, where they fit into memory.
  [[nodiscard]] std::uint64_t planes_at_once(std::uint64_t plane_bytes) const {
    const Hdf5Handle list(H5Dget_create_plist(set_.id()), H5Pclose);
    std::array<hsize_t, 4> chunk{1, 1, 1, 1};
    if (H5Pget_layout(list.id()) == H5D_CHUNKED) H5Pget_chunk(list.id(), has_times_ ? 4 : 3, chunk.data());
    return std::max<std::uint64_t>(
        1, std::min<std::uint64_t>(chunk[has_times_ ? 1 : 0], kMostBytes / plane_bytes));
  }

  std::string path_, name_;
  Hdf5Handle set_;
  ImportedVolume volume_;
  bool has_times_ = false;  ///< along the first of four axes
  hsize_t time_ = 0;
};

}  // namespace

void send_hdf5_volume(const ReaderRequest& request, ByteSink& sink) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string& name = request.name;
  const Hdf5Handle file(H5Fopen(request.paths.front().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) fail("{}: expected a whole HDF5 file, found something else", name);
  ImportSink import(request, sink);
  DataSet(name, file.id(), choose_hdf5_set(name, file.id(), request.array), request.time).send(import);
}

InputFormat hdf5_format() {
  return {.name = "HDF5",
          .endings = ".h5",
          .more_endings = ".hdf5 .he5",
          .shown_by = [](std::string_view bytes) { return bytes.starts_with("\x89HDF\r\n\x1a\n"); },
          .read_grid = read_hdf5_by_library,
          .find_volume = import_hdf5,
          .find_series = find_hdf5_series,
          .several_arrays = true,
          .several_times = true};
}

VolumeSource import_hdf5(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  const std::uint64_t size = check_input_file(path);
  ReaderRequest request{LibraryReader::kHdf5Volume, path.string(), size, {path.string()}, options.array};
  request.time = options.time;
  return import_volume(request, options, progress);
}

}  // namespace adamas::io
