#include "core/io/dream3d_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/hdf5_handle.h"
#include "core/io/hdf5_numbers.h"
#include "core/io/input_formats.h"
#include "core/io/volume_import.h"

namespace adamas::io {

namespace {

using Sizes = std::array<std::uint64_t, 3>;

/// An image geometry, along x, y and z.
struct Geometry {
  std::string path;  ///< the group that holds its arrays
  Sizes cells{};
  std::array<double, 3> spacing{}, origin{};
};

/// The names of what a file holds, below a group.
struct Names {
  std::vector<std::string> groups, sets;
  bool too_many = false;
};

/// Lists the groups and data sets below a group by their paths from there.
Names names_below(hid_t group) {
  Names names;
  const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    constexpr std::size_t kMost = 100'000;
    auto& list = *static_cast<Names*>(found);
    if (info->type == H5O_TYPE_GROUP) list.groups.emplace_back(name);
    if (info->type == H5O_TYPE_DATASET) list.sets.emplace_back(name);
    list.too_many = list.groups.size() + list.sets.size() > kMost;
    return list.too_many ? 1 : 0;
  };
  H5Ovisit(group, H5_INDEX_NAME, H5_ITER_INC, add, &names);
  std::ranges::sort(names.groups);
  std::ranges::sort(names.sets);
  return names;
}

/// Whether an attribute or a data set holds three numbers.
bool holds_three(hid_t space_id, hid_t type_id) {
  const Hdf5Handle space(space_id, H5Sclose), type(type_id, H5Tclose);
  return space.good() && type.good() && hdf5_stored_type(type.id()) &&
         H5Sget_simple_extent_npoints(space.id()) == 3;
}

/// Three numbers of a data set, or of an attribute of a group; empty if there are no such three.
std::optional<std::array<double, 3>> three_of_set(hid_t group, const char* name) {
  std::array<double, 3> numbers{};
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0) return {};
  const Hdf5Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  const bool read = set.good() && holds_three(H5Dget_space(set.id()), H5Dget_type(set.id())) &&
                    H5Dread(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) >= 0;
  return read ? std::optional(numbers) : std::nullopt;
}

std::optional<std::array<double, 3>> three_of_attribute(hid_t group, const char* name) {
  std::array<double, 3> numbers{};
  if (H5Aexists(group, name) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(group, name, H5P_DEFAULT), H5Aclose);
  const bool read = attribute.good() &&
                    holds_three(H5Aget_space(attribute.id()), H5Aget_type(attribute.id())) &&
                    H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, numbers.data()) >= 0;
  return read ? std::optional(numbers) : std::nullopt;
}

/// Makes a geometry of what is stated of it. Throws Error, which begins with `name`.
Geometry geometry_of(const std::string& name, std::string path,
                     const std::optional<std::array<double, 3>>& dimensions,
                     const std::optional<std::array<double, 3>>& spacing,
                     const std::optional<std::array<double, 3>>& origin) {
  constexpr double kMost = 1 << 30;
  const auto all = [](const auto& numbers, const auto& good) {
    return numbers && std::ranges::all_of(*numbers, good);
  };
  if (!all(dimensions, [](double n) { return n >= 1 && n <= kMost && n == std::floor(n); }))
    fail("{}: {}: expected three positive numbers of cells, found others or none", name, path);
  if (!all(spacing, [](double step) { return step > 0 && std::isfinite(step); }))
    fail("{}: {}: expected three positive spacings, found others or none", name, path);
  if (!all(origin, [](double place) { return std::isfinite(place); }))
    fail("{}: {}: expected the three coordinates of an origin, found others or none", name, path);
  Geometry geometry{std::move(path), {}, *spacing, *origin};
  for (std::size_t axis = 0; axis < 3; ++axis)
    geometry.cells[axis] = static_cast<std::uint64_t>((*dimensions)[axis]);
  return geometry;
}

/// Finds all image geometries in both forms of files. Throws Error where there is none.
std::vector<Geometry> find_geometries(const std::string& name, hid_t file) {
  constexpr std::string_view kOlder = "/_SIMPL_GEOMETRY";
  std::vector<Geometry> found;
  std::string others;
  const Names names = names_below(file);
  if (names.too_many) fail("{}: expected at most 100000 groups and data sets, found more", name);
  for (const std::string& path : names.groups) {
    const Hdf5Handle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose);
    if (!group.good()) fail("{}: {}: expected a whole group, found a damaged one", name, path);
    const bool older = path.ends_with(kOlder);
    if (older && H5Lexists(group.id(), "DIMENSIONS", H5P_DEFAULT) > 0) {
      found.push_back(geometry_of(name, path.substr(0, path.size() - kOlder.size()),
                                  three_of_set(group.id(), "DIMENSIONS"), three_of_set(group.id(), "SPACING"),
                                  three_of_set(group.id(), "ORIGIN")));
    } else if (H5Aexists(group.id(), "_DIMENSIONS") > 0) {
      found.push_back(geometry_of(name, path, three_of_attribute(group.id(), "_DIMENSIONS"),
                                  three_of_attribute(group.id(), "_SPACING"),
                                  three_of_attribute(group.id(), "_ORIGIN")));
    } else if (older) {
      others += fmt::format("{}'{}'", others.empty() ? "" : ", ", path);
    }
  }
  if (found.empty())
    fail("{}: expected an image geometry of DREAM.3D (DIMENSIONS, SPACING, ORIGIN), found {}", name,
         others.empty() ? "none" : "other geometries: " + others);
  return found;
}

/// The sizes of a data set along its axes; empty if it has too many, or none.
std::vector<hsize_t> axes_of(hid_t set) {
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  const int axes = space.good() ? H5Sget_simple_extent_ndims(space.id()) : 0;
  if (axes < 1 || axes > 8) return {};
  std::vector<hsize_t> sizes(static_cast<std::size_t>(axes));
  H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
  return sizes;
}

/// The number of components of a data set on the cells of a geometry, z slowest; 0 if it is on others.
std::uint64_t components_on(const Geometry& geometry, const std::vector<hsize_t>& sizes) {
  if (sizes.size() < 3) return 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (sizes[axis] != geometry.cells[2 - axis]) return 0;
  std::uint64_t components = 1;
  for (std::size_t axis = 3; axis < sizes.size(); ++axis) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    if (sizes[axis] == 0 || sizes[axis] > kMost / components) return 0;
    components *= sizes[axis];
  }
  return components;
}

/// Reads the texts of a data set along one axis; none if it holds no texts, or too many.
std::vector<std::string> texts_of(hid_t group, const std::string& name) {
  constexpr hsize_t kMost = 65536;
  const Hdf5Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(set.good() ? H5Dget_type(set.id()) : -1, H5Tclose);
  if (!type.good() || H5Tget_class(type.id()) != H5T_STRING) return {};
  hsize_t count = 1;
  for (const hsize_t size : axes_of(set.id())) count = size > kMost / count ? kMost + 1 : count * size;
  if (count == 0 || count > kMost) return {};
  std::vector<std::string> texts;
  if (H5Tis_variable_str(type.id()) > 0) {
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose), memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory.id(), H5T_VARIABLE);
    H5Tset_cset(memory.id(), H5Tget_cset(type.id()));
    std::vector<char*> read(static_cast<std::size_t>(count), nullptr);
    if (H5Dread(set.id(), memory.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()) < 0) return {};
    for (const char* text : read) texts.emplace_back(text == nullptr ? "" : text);
    H5Dvlen_reclaim(memory.id(), space.id(), H5P_DEFAULT, read.data());
    return texts;
  }
  constexpr std::size_t kLongest = 4096;
  const std::size_t length = H5Tget_size(type.id());
  if (length == 0 || length > kLongest) return {};
  std::string all(length * static_cast<std::size_t>(count), '\0');
  if (H5Dread(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) return {};
  for (std::size_t at = 0; at < all.size(); at += length) {
    std::string text = all.substr(at, length);
    text.resize(std::min(text.find('\0'), text.size()));
    text.resize(text.find_last_not_of(' ') + 1);
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string last_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// Names of phases by their numbers, unlike each other: one that is empty or was there before gets its
/// number.
std::vector<std::string> phase_names(hid_t group, const std::vector<std::string>& sets) {
  std::vector<std::string> names;
  for (const std::string& set : sets) {
    if (last_name(set) != "PhaseName" && last_name(set) != "MaterialName") continue;
    names = texts_of(group, set);
    if (last_name(set) == "PhaseName" && !names.empty()) break;
  }
  std::set<std::string> before;
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (names[n].empty()) names[n] = std::to_string(n);
    if (!before.insert(names[n]).second) names[n] += fmt::format(" {}", n);
  }
  return names;
}

GridArray read_array(const std::string& name, hid_t group, const std::string& path, const Geometry& geometry,
                     std::uint64_t components) {
  const std::string where = name + ": " + path;
  const Hdf5Handle set(H5Dopen2(group, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
  GridArray array;
  array.name = last_name(path);
  array.centering = Centering::kCells;
  array.components = static_cast<int>(components);
  const StoredType stored = *hdf5_stored_type(type.id());
  array.type = stored_name(stored);
  read_hdf5_numbers(where, set.id(), stored,
                    count_hdf5_numbers(where, set.id(), stored, geometry.cells, components), array);
  return array;
}

/// Reads all arrays of numbers on the cells of a geometry: ids of features come first, then phases.
std::vector<GridArray> read_arrays(const std::string& name, hid_t group, const Geometry& geometry,
                                   const Names& names) {
  std::vector<GridArray> arrays;
  std::set<std::string> before;
  for (const std::string& path : names.sets) {
    const Hdf5Handle set(H5Dopen2(group, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.good()) fail("{}: {}: expected a whole data set, found a damaged one", name, path);
    const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
    const std::uint64_t components = components_on(geometry, axes_of(set.id()));
    if (components == 0 || !type.good() || !hdf5_stored_type(type.id())) continue;
    arrays.push_back(read_array(name, group, path, geometry, components));
    if (!before.insert(arrays.back().name).second) arrays.back().name = path;
    if (last_name(path) == "Phases") arrays.back().label_names = phase_names(group, names.sets);
  }
  const auto rank = [](const GridArray& array) {
    return array.name == "FeatureIds" ? 0 : array.name == "Phases" ? 1 : 2;
  };
  std::ranges::stable_sort(arrays, {}, rank);
  return arrays;
}

}  // namespace

InputFormat dream3d_format() {
  return {.name = kDream3d, .endings = ".dream3d", .read_grid = read_grid_by_library};
}

GridFile read_dream3d(const std::filesystem::path& path) {
  const std::string name = path.string();
  const Hdf5Handle file = open_hdf5(name);
  const std::vector<Geometry> geometries = find_geometries(name, file.id());
  GridFile result;
  result.kind = kDream3d;
  for (const Geometry& geometry : geometries) {
    const Hdf5Handle group(H5Gopen2(file.id(), geometry.path.c_str(), H5P_DEFAULT), H5Gclose);
    if (!group.good()) fail("{}: {}: expected a whole group, found a damaged one", name, geometry.path);
    result.arrays = read_arrays(name, group.id(), geometry, names_below(group.id()));
    if (result.arrays.empty()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::uint64_t i = 0; i <= geometry.cells[axis]; ++i)
        result.nodes[axis].push_back(geometry.origin[axis] + static_cast<double>(i) * geometry.spacing[axis]);
    }
    if (geometries.size() > 1)
      result.remark = fmt::format("arrays of '{}' are read, the first of {} image geometries that has some",
                                  geometry.path, geometries.size());
    return result;
  }
  fail("{}: expected arrays of {} x {} x {} cells, found none", name, geometries.front().cells[0],
       geometries.front().cells[1], geometries.front().cells[2]);
}

}  // namespace adamas::io
