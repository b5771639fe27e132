#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/io/grid_file.h"
#include "core/io/grid_numbers.h"
#include "core/io/hdf5_handle.h"
#include "core/io/hdf5_volumes.h"

namespace adamas::io {

namespace {

using Sizes = std::array<std::uint64_t, 3>;

/// A data set along three axes, or along four, and the grid that its numbers are on.
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
    check_hdf5_samples(name_, set_.id());
  }

  [[nodiscard]] const Sizes& sizes() const { return sizes_; }
  [[nodiscard]] Vec3 spacing() const { return hdf5_spacing(set_.id()); }

  [[nodiscard]] GridArray read() const {
    GridArray array;
    array.name = path_;
    array.type = stored_name(stored_);
    array.components = static_cast<int>(components_);
    visit_stored_type(stored_, [&]<class Stored>(Stored) {
      std::vector<Stored> numbers(static_cast<std::size_t>(count_));
      if (H5Dread(set_.id(), hdf5_memory_type(stored_), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
        fail("{}: expected whole samples, found corrupt or missing ones", name_);
      set_numbers(std::span<const Stored>(numbers), array);
    });
    if (planar_) interleave(array);
    return array;
  }

 private:
  void check_size() {
    constexpr auto kMost = std::uint64_t{1} << 40;
    count_ = components_;
    for (const std::uint64_t n : sizes_) {
      if (n == 0 || count_ == 0 || n > kMost / count_)
        fail("{}: expected samples, found no or too many", name_);
      count_ *= n;
    }
    // Samples that were never written would all come as the fill value, and no compression makes more of a
    // byte.
    constexpr std::uint64_t kGreatestExpansion = 10'000;
    const std::uint64_t stored = H5Dget_storage_size(set_.id());
    if (stored < count_ * stored_bytes(stored_) / kGreatestExpansion || stored == 0)
      fail("{}: expected {} samples, found {} bytes of them", name_, count_, stored);
    if (components_ > std::numeric_limits<int>::max())
      fail("{}: expected fewer components, found {}", name_, components_);
  }

  std::string path_, name_;
  Hdf5Handle set_;
  StoredType stored_ = StoredType::kUint8;
  Sizes sizes_{};
  std::uint64_t components_ = 1, count_ = 0;
  bool planar_ = false;  ///< components are along the first axis
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

GridFile read_hdf5_grid(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string name = path.string();
  const Hdf5Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) fail("{}: expected a whole HDF5 file, found something else", name);
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
