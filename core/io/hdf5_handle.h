#pragma once

#define H5_USE_110_API
#include <hdf5.h>

#include <cstddef>
#include <cstdint>

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

}  // namespace adamas::io
