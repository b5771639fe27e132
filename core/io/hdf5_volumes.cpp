#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/error.h"
#include "core/data/stored_type.h"
#include "core/io/grid_file.h"
#include "core/io/hdf5_handle.h"
#include "core/io/hdf5_layout_reader.h"
#include "core/io/hdf5_numbers.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/reader_program.h"
#include "core/io/volume_import.h"
#include "core/io/volume_stack.h"

namespace adamas::io {

namespace {

/// What find_hdf5_sets searches for, and the result.
struct Listing {
  int axes;
  std::size_t most;
  std::vector<std::string> names;
  bool too_deep;
};

/// The number of axes of a numeric data set; 0 if there is no such set, or its values are no numbers.
int hdf5_axes(hid_t place, const char* name) {
  const Hdf5Handle set(H5Dopen2(place, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(set.good() ? H5Dget_space(set.id()) : -1, H5Sclose);
  const Hdf5Handle type(set.good() ? H5Dget_type(set.id()) : -1, H5Tclose);
  if (!space.good() || !type.good() || !hdf5_stored_type(type.id())) return 0;
  const int axes = H5Sget_simple_extent_ndims(space.id());
  return axes > 0 ? axes : 0;
}

constexpr std::size_t kMostHdf5Listed = 8;

/// The names of at most `most` numeric data sets with so many axes.
std::vector<std::string> find_hdf5_sets(hid_t file, int axes, std::size_t most = kMostHdf5Listed) {
  constexpr std::ptrdiff_t kDeepest = 64;
  Listing listing{axes, most, {}, false};
  const auto add = [](hid_t root, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    auto& list = *static_cast<Listing*>(found);
    const std::string_view path(name);
    list.too_deep = std::count(path.begin(), path.end(), '/') > kDeepest;
    if (list.too_deep) return 1;
    if (info->type == H5O_TYPE_DATASET && hdf5_axes(root, name) == list.axes) list.names.emplace_back(name);
    return list.names.size() < list.most ? 0 : 1;
  };
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, add, &listing);
  if (listing.too_deep) fail("expected groups that are at most {} deep, found deeper ones", kDeepest);
  return listing.names;
}

/// The data set that `wanted` names; if it is empty, the only one along three axes or, if there is none,
/// along four. Throws Error, which begins with `name`, if there is none or more than one.
std::string choose_hdf5_set(const std::string& name, hid_t file, const std::string& wanted) {
  std::vector<std::string> found = find_hdf5_sets(file, 3);
  if (found.empty()) found = find_hdf5_sets(file, 4);
  std::string names = found.empty() ? "" : fmt::format("'{}'", fmt::join(found, "', '"));
  if (!wanted.empty()) {
    // The root group exists without a link to it.
    if (wanted == "/" || H5Lexists(file, wanted.c_str(), H5P_DEFAULT) > 0) return wanted;
    fail("{}: expected a data set '{}', found {}", name, wanted,
         names.empty() ? "none of three axes" : names);
  }
  if (found.empty()) fail("{}: expected a data set of numbers along three axes, found none", name);
  if (found.size() == kMostHdf5Listed) names += ", ...";
  if (found.size() > 1) fail("{}: expected the name of a data set, found {}", name, names);
  return found.front();
}

/// The spacing along x, y and z by the attribute "element_size_um"; 1 if there is none.
Vec3 hdf5_spacing(hid_t set) {
  const char* name = "element_size_um";
  if (H5Aexists(set, name) <= 0) return {1, 1, 1};
  const Hdf5Handle attribute(H5Aopen(set, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(attribute.good() ? H5Aget_space(attribute.id()) : -1, H5Sclose);
  std::array<double, 3> zyx{};
  const bool read = space.good() && H5Sget_simple_extent_npoints(space.id()) == 3 &&
                    H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, zyx.data()) >= 0;
  const bool good =
      read && std::all_of(zyx.begin(), zyx.end(), [](double s) { return s > 0 && std::isfinite(s); });
  return good ? Vec3{zyx[2], zyx[1], zyx[0]} : Vec3{1, 1, 1};
}

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

  /// Access properties with a cache large enough for the chunks that a plane crosses.
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
    // Samples that were never written would all be read as the fill value.
    if (H5Dget_storage_size(set_.id()) == 0)
      fail("{}: expected samples, found a data set without any", name_);
  }

  /// The number of planes read at once: those of one layer of chunks, if they fit into memory.
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
  bool has_times_ = false;  ///< whether times run along the first of four axes
  hsize_t time_ = 0;
};

}  // namespace

void send_hdf5_volume(const ReaderRequest& request, ByteSink& sink) {
  const std::string& name = request.name;
  const Hdf5Handle file = open_hdf5(name);
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
          .several_times = true,
          .may_be_cells = true};
}

VolumeSource import_hdf5(const std::filesystem::path& path, const VolumeOptions& options,
                         Progress& progress) {
  ReaderRequest request = request_of(LibraryReader::kHdf5Volume, path);
  request.array = options.array;
  request.time = options.time;
  return import_volume(request, options, progress);
}

namespace {

/// The data sets of a file that may be steps, in the form in which they are sent to the parent.
struct StepSets {
  std::vector<std::string> sets;  ///< the data sets of a group, or the one along four axes
  std::uint64_t count = 0;        ///< number of times along the first axis; 0 for a group
  std::vector<double> times;      ///< one for each step, or none
  std::string remark{};           ///< why there are none although the file states some
};

}  // namespace

template <>
inline constexpr auto kSentMembers<StepSets> =
    std::tuple{&StepSets::sets, &StepSets::count, &StepSets::times, &StepSets::remark};

namespace {

/// Finds the data sets along three axes in a group. It has times if all of them have one.
StepSets find_members(hid_t group, const std::string& path) {
  std::vector<std::string> members;
  const auto add = [](hid_t place, const char* name, const H5L_info_t*, void* found) -> herr_t {
    if (hdf5_axes(place, name) == 3) static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &members);
  std::sort(members.begin(), members.end(), natural_less);
  StepSets found;
  for (const std::string& name : members) {
    const Hdf5Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
    const std::vector<double> time = set.good() ? hdf5_times(set.id()) : std::vector<double>();
    if (time.size() == 1) found.times.push_back(time.front());
    found.sets.push_back(path + (path.ends_with('/') ? "" : "/") + name);
  }
  if (found.times.size() == found.sets.size()) return found;
  if (!found.times.empty())
    found.remark = fmt::format("{} of {} data sets in '{}' have a time: steps are taken to be at 0, 1, 2 ...",
                               found.times.size(), found.sets.size(), path);
  found.times.clear();
  return found;
}

StepSets find_times_of_set(hid_t set, const std::string& path) {
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  std::array<hsize_t, 4> size{};
  H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  StepSets found{{path}, size[0], hdf5_times(set)};
  if (found.times.size() == found.count) return found;
  if (!found.times.empty())
    found.remark =
        fmt::format("'{}' has {} numbers as its time, of {} steps: these are taken to be at 0, 1, 2 ...",
                    path, found.times.size(), found.count);
  found.times.clear();
  return found;
}

StepSets find_steps(const std::string& name, hid_t file, const std::string& wanted) {
  const std::string path = choose_hdf5_set(name, file, wanted);
  const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose);
  const H5I_type_t type = object.good() ? H5Iget_type(object.id()) : H5I_BADID;
  if (type == H5I_GROUP) {
    StepSets members = find_members(object.id(), path);
    if (members.sets.empty())
      fail("{}: expected data sets of numbers along three axes in the group '{}', found none", name, path);
    return members;
  }
  if (type == H5I_DATASET && hdf5_axes(file, path.c_str()) == 4) return find_times_of_set(object.id(), path);
  return {};
}

/// Returns the steps in the order of their times.
VolumeSeries in_order(const std::string& name, std::vector<VolumeStep> steps, bool have_times) {
  if (!have_times) return {std::move(steps), StepTimes::kCounted};
  for (const VolumeStep& step : steps) {
    if (!std::isfinite(step.time))
      fail("{}: expected finite times, found {} as the time of '{}'", name, step.time, step.array);
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const VolumeStep& a, const VolumeStep& b) { return a.time < b.time; });
  for (std::size_t n = 1; n < steps.size(); ++n) {
    if (steps[n].time == steps[n - 1].time)
      fail("{}: expected another time for each step, found {} twice, of '{}' and '{}'", name, steps[n].time,
           steps[n - 1].array, steps[n].array);
  }
  return {std::move(steps), StepTimes::kAbsolute};
}

}  // namespace

void send_hdf5_steps(const ReaderRequest& request, ByteSink& sink) {
  const Hdf5Handle file = open_hdf5(request.name);
  sink.put(find_steps(request.name, file.id(), request.array));
}

VolumeSeries find_hdf5_series(const std::filesystem::path& path, const std::string& array) {
  const std::string name = path.string();
  ReaderRequest request = request_of(LibraryReader::kHdf5Steps, path);
  request.array = array;
  const auto found = receive_from_child<StepSets>(request);
  std::vector<VolumeStep> steps;
  const bool of_one = found.count > 0 && found.sets.size() == 1;
  if (found.count > kMostVolumeSteps)
    fail("{}: expected at most {} times, found {}", name, kMostVolumeSteps, found.count);
  for (std::uint64_t n = 0; n < (of_one ? found.count : found.sets.size()); ++n) {
    VolumeStep step{static_cast<double>(n), found.sets[of_one ? 0 : n], {}};
    if (of_one) step.number = n;
    if (found.times.size() > n) step.time = found.times[n];
    steps.push_back(step);
  }
  const bool have_times = found.times.size() == steps.size();
  VolumeSeries series = in_order(name, std::move(steps), have_times);
  if (!found.remark.empty()) series.remark = name + ": " + found.remark;
  return series;
}

namespace {

using Sizes = std::array<std::uint64_t, 3>;

/// A data set along three or four axes, and the grid that its numbers are on.
class GridSet {
 public:
  GridSet(const std::string& name, hid_t file, const std::string& path)
      : path_(path), name_(name + ": " + path), set_(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose) {
    const Hdf5Handle space(set_.good() ? H5Dget_space(set_.id()) : -1, H5Sclose);
    const Hdf5Handle type(set_.good() ? H5Dget_type(set_.id()) : -1, H5Tclose);
    const auto stored = type.good() ? hdf5_stored_type(type.id()) : std::nullopt;
    if (!space.good() || !stored) fail("{}: expected a data set of numbers, found none", name_);
    stored_ = *stored;
    std::array<hsize_t, 4> size{};
    const int axes = H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
    const bool first_is_odd = size[0] != size[1] && size[1] == size[2] && size[2] == size[3],
               last_is_odd = size[3] != size[2] && size[2] == size[1] && size[1] == size[0];
    planar_ = axes == 4 && (first_is_odd || (!last_is_odd && size[0] <= size[3]));
    components_ = axes == 3 ? 1 : planar_ ? size[0] : size[3];
    const std::size_t first = planar_ ? 1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sizes_[axis] = size[first + 2 - axis];
    check_size();
  }

  [[nodiscard]] const Sizes& sizes() const { return sizes_; }
  [[nodiscard]] Vec3 spacing() const { return hdf5_spacing(set_.id()); }

  [[nodiscard]] GridArray read() const {
    GridArray array;
    array.name = path_;
    array.type = stored_name(stored_);
    array.components = static_cast<int>(components_);
    read_hdf5_numbers(name_, set_.id(), stored_, count_, array);
    if (planar_) interleave(array);
    return array;
  }

 private:
  void check_size() {
    count_ = count_hdf5_numbers(name_, set_.id(), stored_, sizes_, components_);
    if (components_ > std::numeric_limits<int>::max())
      fail("{}: expected fewer components, found {}", name_, components_);
  }

  std::string path_, name_;
  Hdf5Handle set_;
  StoredType stored_ = StoredType::kUint8;
  Sizes sizes_{};
  std::uint64_t components_ = 1, count_ = 0;
  bool planar_ = false;  ///< whether components are along the first axis
};

std::string text(const Sizes& sizes) { return fmt::format("{} x {} x {}", sizes[0], sizes[1], sizes[2]); }

void set_places(const GridSet& set, GridFile& file) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = set.spacing()[static_cast<int>(axis)];
    for (std::uint64_t i = 0; i <= set.sizes()[axis]; ++i) {
      if (i < set.sizes()[axis]) file.nodes[axis].push_back(static_cast<double>(i) * step);
      file.faces[axis].push_back((static_cast<double>(i) - 0.5) * step);
    }
  }
}

}  // namespace

namespace {

/// The centering of numbers on a grid with these nodes; none where they are of another one.
std::optional<Centering> centering_of(const Sizes& sizes, const std::array<std::vector<double>, 3>& nodes) {
  for (const std::size_t less : {std::size_t{0}, std::size_t{1}}) {
    bool fits = true;
    for (std::size_t axis = 0; axis < 3; ++axis) fits = fits && sizes[axis] + less == nodes[axis].size();
    if (fits) return less == 0 ? Centering::kPoints : Centering::kCells;
  }
  return {};
}

/// Reads the data sets on the grid whose axes a layout names.
GridFile read_laid_out_grid(const std::filesystem::path& path) {
  const Hdf5Meshes source(path);
  GridFile result;
  result.kind = "HDF5 grid";
  result.nodes = read_laid_out_axes(source, hdf5_layout());
  if (result.nodes[2].empty())
    fail("{}: --hdf5: expected axes x, y and z of a grid, found none of z", source.name());
  const Hdf5Handle file = open_hdf5(source.name());
  for (const std::string& one : source.data_sets("/")) {
    const std::size_t axes = source.look_at(one)->size.size();
    if (axes < 3 || axes > 4) continue;
    const GridSet set(source.name(), file.id(), one);
    const auto centering = centering_of(set.sizes(), result.nodes);
    if (!centering) continue;
    result.arrays.push_back(set.read());
    result.arrays.back().centering = *centering;
  }
  if (result.arrays.empty())
    fail("{}: --hdf5: expected data sets of {} x {} x {} numbers, or of one less along all axes, found none",
         source.name(), result.nodes[2].size(), result.nodes[1].size(), result.nodes[0].size());
  return result;
}

}  // namespace

GridFile read_hdf5_grid(const std::filesystem::path& path) {
  if (hdf5_layout().of_grid()) return read_laid_out_grid(path);
  const std::string name = path.string();
  const Hdf5Handle file = open_hdf5(name);
  constexpr std::size_t kMost = 1000;
  std::vector<std::string> names = find_hdf5_sets(file.id(), 3, kMost);
  std::ranges::copy(find_hdf5_sets(file.id(), 4, kMost), std::back_inserter(names));
  if (names.empty()) fail("{}: expected data sets of numbers along three or four axes, found none", name);
  GridFile result;
  result.kind = "HDF5";
  Sizes sizes{};
  for (const std::string& one : names) {
    const GridSet set(name, file.id(), one);
    if (result.arrays.empty()) {
      sizes = set.sizes();
      set_places(set, result);
    }
    if (set.sizes() != sizes)
      fail("{}: expected data sets on one grid, found '{}' of {} and '{}' of {}", name, names.front(),
           text(sizes), one, text(set.sizes()));
    result.arrays.push_back(set.read());
  }
  return result;
}

}  // namespace adamas::io
