#include "core/io/hdf5_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/io/grid_numbers.h"
#include "core/io/hdf5_handle.h"
#include "core/io/input_file.h"
#include "core/io/mesh_builder.h"
#include "core/io/volume_stack.h"

namespace adamas::io {

namespace {

constexpr std::size_t kLongestText = 4096;
/// Deflate never makes data smaller than this part.
constexpr double kMostPacked = 1100;
/// The greatest number of axes of a data set that is read.
constexpr int kMostAxes = 6;

}  // namespace

Hdf5Meshes::Hdf5Meshes(const std::filesystem::path& path)
    : name_(path.string()), bytes_(check_input_file(path)), file_(new Hdf5Handle(open_hdf5(name_))) {}

bool Hdf5Meshes::has(const std::string& path) const {
  for (std::size_t end = path.find('/'); end != std::string::npos; end = path.find('/', end + 1)) {
    if (end > 0 && H5Lexists(file_->id(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(file_->id(), path.c_str(), H5P_DEFAULT) > 0;
}

std::optional<Numbers> Hdf5Meshes::look_at(const std::string& path) const {
  const Hdf5Handle set(H5Dopen2(file_->id(), path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.good()) return {};
  const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose), type(H5Dget_type(set.id()), H5Tclose);
  const auto stored = type.good() ? hdf5_stored_type(type.id()) : std::nullopt;
  const int axes = space.good() ? H5Sget_simple_extent_ndims(space.id()) : 0;
  if (!stored || axes < 1 || axes > kMostAxes) return {};
  Numbers result;
  result.type = stored_name(*stored);
  std::array<hsize_t, kMostAxes> size{};
  H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  result.size.assign(size.begin(), size.begin() + axes);
  return result;
}

Numbers Hdf5Meshes::read(const std::string& path, std::optional<std::uint64_t> of_first) const {
  std::optional<Numbers> found = look_at(path);
  if (!found) fail("{}: {}: expected numbers, found none", name_, path);
  double count = 1;
  for (const std::uint64_t n : found->size) count *= static_cast<double>(n);
  const Hdf5Handle set(H5Dopen2(file_->id(), path.c_str(), H5P_DEFAULT), H5Dclose);
  // Numbers that were never written would all be read as the fill value.
  const hsize_t held = std::min<hsize_t>(H5Dget_storage_size(set.id()), bytes_);
  if (count * static_cast<double>(stored_bytes(*find_stored_type(found->type))) >
      kMostPacked * static_cast<double>(held))
    fail("{}: {}: expected {:g} numbers, found {} bytes of them", name_, path, count, held);
  const Hdf5Handle layout(H5Dget_create_plist(set.id()), H5Pclose);
  if (!layout.good() || !hdf5_holds_values(layout.id()))
    fail("{}: {}: expected numbers in the file itself, found them in others", name_, path);
  const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
  std::vector<hsize_t> start(found->size.size(), 0), part(found->size.begin(), found->size.end());
  if (of_first) {
    start[0] = *of_first;
    part[0] = 1;
    count /= static_cast<double>(std::max<std::uint64_t>(found->size[0], 1));
  }
  found->values.resize(static_cast<std::size_t>(count));
  const Hdf5Handle memory(H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr), H5Sclose);
  const bool chosen =
      H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr) >= 0;
  if (!chosen ||
      H5Dread(set.id(), H5T_NATIVE_DOUBLE, memory.id(), space.id(), H5P_DEFAULT, found->values.data()) < 0)
    fail("{}: {}: expected whole numbers, found corrupt or missing ones", name_, path);
  if (of_first) found->size.erase(found->size.begin());
  return std::move(*found);
}

std::string Hdf5Meshes::text(const std::string& path, const std::string& attribute) const {
  if (H5Aexists_by_name(file_->id(), path.c_str(), attribute.c_str(), H5P_DEFAULT) <= 0) return {};
  const Hdf5Handle own(
      H5Aopen_by_name(file_->id(), path.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(own.good() ? H5Aget_type(own.id()) : -1, H5Tclose);
  const Hdf5Handle space(own.good() ? H5Aget_space(own.id()) : -1, H5Sclose);
  if (!type.good() || H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0 ||
      H5Sget_simple_extent_npoints(space.id()) != 1)
    return {};
  if (H5Tget_size(type.id()) > kLongestText) return {};
  std::string result(H5Tget_size(type.id()), '\0');
  if (H5Aread(own.id(), type.id(), result.data()) < 0) return {};
  result.resize(std::min(result.find('\0'), result.size()));
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

std::vector<double> Hdf5Meshes::attribute(const std::string& path, const char* name,
                                          std::size_t count) const {
  std::vector<double> result(count);
  bool good = H5Aexists_by_name(file_->id(), path.c_str(), name, H5P_DEFAULT) > 0;
  if (good) {
    const Hdf5Handle own(H5Aopen_by_name(file_->id(), path.c_str(), name, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
    const Hdf5Handle space(own.good() ? H5Aget_space(own.id()) : -1, H5Sclose),
        type(own.good() ? H5Aget_type(own.id()) : -1, H5Tclose);
    good = space.good() && type.good() && hdf5_stored_type(type.id()).has_value() &&
           H5Sget_simple_extent_npoints(space.id()) == static_cast<hssize_t>(count) &&
           H5Aread(own.id(), H5T_NATIVE_DOUBLE, result.data()) >= 0 &&
           std::ranges::all_of(result, [](double v) { return std::isfinite(v); });
  }
  if (!good) fail("{}: {}: expected {} numbers as attribute '{}', found none", name_, path, count, name);
  return result;
}

std::vector<std::string> Hdf5Meshes::names(const std::string& group) const {
  std::vector<std::string> result;
  const Hdf5Handle own(H5Gopen2(file_->id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  if (own.good()) H5Literate(own.id(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &result);
  std::ranges::sort(result, natural_less);
  return result;
}

std::vector<std::string> Hdf5Meshes::data_sets(const std::string& group) const {
  constexpr std::size_t kMost = 4096;
  constexpr std::ptrdiff_t kDeepest = 64;
  struct Found {
    std::vector<std::string> names;
    bool too_deep = false;
  } found;
  const Hdf5Handle own(H5Gopen2(file_->id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    auto& result = *static_cast<Found*>(list);
    const std::string_view path(name);
    result.too_deep = std::count(path.begin(), path.end(), '/') > kDeepest;
    if (info->type == H5O_TYPE_DATASET) result.names.emplace_back(name);
    return result.too_deep || result.names.size() >= kMost ? 1 : 0;
  };
  if (own.good()) H5Ovisit(own.id(), H5_INDEX_NAME, H5_ITER_NATIVE, add, &found);
  if (found.too_deep)
    fail("{}: expected groups that are at most {} deep, found deeper ones", name_, kDeepest);
  std::erase_if(found.names, [&](const std::string& name) { return !look_at(group + "/" + name); });
  std::ranges::sort(found.names, natural_less);
  return found.names;
}

std::optional<double> Hdf5Meshes::time_of(const std::string& group) const {
  const Hdf5Handle own(H5Gopen2(file_->id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  const std::vector<double> times = own.good() ? hdf5_times(own.id()) : std::vector<double>();
  return times.size() == 1 && std::isfinite(times[0]) ? std::optional(times[0]) : std::nullopt;
}

void add_array(std::string name, Centering centering, const Numbers& numbers, int components,
               MeshFile& file) {
  GridArray array;
  array.name = std::move(name);
  array.type = numbers.type;
  array.centering = centering;
  array.components = components;
  set_numbers(std::span(numbers.values), array);
  file.arrays.push_back(std::move(array));
}

MergedPoints add_merged_points(const std::string& name, const std::vector<Vec3>& points, MeshFile& file) {
  Box3 box;
  for (const Vec3& p : points) {
    if (!is_finite(p)) fail("{}: expected finite coordinates, found others", name);
    box.extend(p);
  }
  PointMerger merger(PointMerger::kCoincident * std::max(box.diagonal(), 1e-300), file.points);
  MergedPoints result;
  for (const Vec3& p : points) {
    const std::size_t before = file.points.size();
    result.numbers.push_back(merger.number(p));
    if (file.points.size() > before) result.taken.push_back(result.numbers.size() - 1);
  }
  return result;
}

Numbers rows_of(const Numbers& all, std::span<const std::size_t> rows) {
  Numbers own{all.type, {rows.size()}, {}};
  for (const std::size_t r : rows)
    own.values.insert(own.values.end(), all.values.begin() + static_cast<std::ptrdiff_t>(r * all.row()),
                      all.values.begin() + static_cast<std::ptrdiff_t>((r + 1) * all.row()));
  return own;
}

}  // namespace adamas::io
