#pragma once

#define H5_USE_110_API
#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/data/stored_type.h"

namespace adamas::io {

/// An identifier of HDF5 and the function that closes it.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;

  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Whether the values of a data set, with these creation properties, lie in the file itself.
inline bool hdf5_holds_values(hid_t layout) {
  return H5Pget_layout(layout) != H5D_VIRTUAL && H5Pget_external_count(layout) <= 0;
}

/// The type that numbers have in the files of this program.
template <class T>
hid_t hdf5_type_of();
template <>
inline hid_t hdf5_type_of<double>() {
  return H5T_IEEE_F64LE;
}
template <>
inline hid_t hdf5_type_of<float>() {
  return H5T_IEEE_F32LE;
}
template <>
inline hid_t hdf5_type_of<std::int32_t>() {
  return H5T_STD_I32LE;
}
template <>
inline hid_t hdf5_type_of<std::uint8_t>() {
  return H5T_STD_U8LE;
}

/// The type of texts of at most this length.
inline Hdf5Handle hdf5_text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, length);
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return {type, H5Tclose};
}

/// The type in which numbers of an HDF5 type are passed on; empty if they are no numbers.
inline std::optional<StoredType> hdf5_stored_type(hid_t type) {
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

/// Opens a file to be read. Throws Error, which begins with `name`, if it is none of HDF5.
inline Hdf5Handle open_hdf5(const std::string& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) fail("{}: expected a whole HDF5 file, found something else", name);
  return {file, H5Fclose};
}

/// The attribute `time` of a data set or a group as numbers; empty if it has none, or one that is no number.
inline std::vector<double> hdf5_times(hid_t set) {
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
