#include "core/io/hdf5_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/io/hdf5_handle.h"

namespace adamas::io {

namespace {

struct Listing {
  int axes;
  std::size_t most;
  std::vector<std::string> names;
  bool too_deep;
};

}  // namespace

std::optional<StoredType> hdf5_stored_type(hid_t type) {
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

hid_t hdf5_memory_type(StoredType type) {
  const std::array<hid_t, 10> types{H5T_NATIVE_INT8,  H5T_NATIVE_UINT8,  H5T_NATIVE_INT16, H5T_NATIVE_UINT16,
                                    H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                                    H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE};
  return types[static_cast<std::size_t>(type)];
}

int hdf5_axes(hid_t place, const char* name) {
  const Hdf5Handle set(H5Dopen2(place, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(set.good() ? H5Dget_space(set.id()) : -1, H5Sclose);
  const Hdf5Handle type(set.good() ? H5Dget_type(set.id()) : -1, H5Tclose);
  if (!space.good() || !type.good() || !hdf5_stored_type(type.id())) return 0;
  const int axes = H5Sget_simple_extent_ndims(space.id());
  return axes > 0 ? axes : 0;
}

std::vector<std::string> find_hdf5_sets(hid_t file, int axes, std::size_t most) {
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

std::string choose_hdf5_set(const std::string& name, hid_t file, const std::string& wanted) {
  std::vector<std::string> found = find_hdf5_sets(file, 3);
  if (found.empty()) found = find_hdf5_sets(file, 4);
  std::string names;
  for (const std::string& one : found) names += (names.empty() ? "'" : ", '") + one + "'";
  if (!wanted.empty()) {
    // The root is there without a link to it.
    if (wanted == "/" || H5Lexists(file, wanted.c_str(), H5P_DEFAULT) > 0) return wanted;
    fail("{}: expected a data set '{}', found {}", name, wanted,
         names.empty() ? "none of three axes" : names);
  }
  if (found.empty()) fail("{}: expected a data set of numbers along three axes, found none", name);
  if (found.size() == kMostHdf5Listed) names += ", ...";
  if (found.size() > 1) fail("{}: expected the name of a data set, found {}", name, names);
  return found.front();
}

void check_hdf5_samples(const std::string& name, hid_t set) {
  const Hdf5Handle layout(H5Dget_create_plist(set), H5Pclose);
  if (!layout.good() || !hdf5_holds_values(layout.id()))
    fail("{}: expected samples in the file itself, found them in others", name);
}

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

std::vector<double> hdf5_times(hid_t set) {
  constexpr hssize_t kMost = hssize_t{1} << 24;
  if (H5Aexists(set, "time") <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(set, "time", H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(attribute.good() ? H5Aget_space(attribute.id()) : -1, H5Sclose);
  const Hdf5Handle type(attribute.good() ? H5Aget_type(attribute.id()) : -1, H5Tclose);
  const hssize_t count = space.good() ? H5Sget_simple_extent_npoints(space.id()) : 0;
  if (!type.good() || !hdf5_stored_type(type.id()) || count < 1 || count > kMost) return {};
  std::vector<double> times(static_cast<std::size_t>(count));
  if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, times.data()) < 0) return {};
  return times;
}

}  // namespace adamas::io
