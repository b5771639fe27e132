#pragma once

#define H5_USE_110_API
#include <hdf5.h>

#include <filesystem>
#include <string>
#include <vector>

namespace adamas::test {

/// An HDF5 file that is being written.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~Hdf5File() { H5Fclose(file_); }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Nothing is written where there are no values; `chunk` of 0: contiguous.
  void add(const std::string& name, const std::vector<hsize_t>& size, hid_t stored, hid_t memory,
           const void* values, hsize_t chunk = 0, const std::vector<double>& element = {}) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    if (chunk > 0) {
      const std::vector<hsize_t> chunks(size.size(), chunk);
      H5Pset_chunk(how, static_cast<int>(size.size()), chunks.data());
      H5Pset_deflate(how, 6);
    }
    const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, name.c_str(), stored, space, links, how, H5P_DEFAULT);
    if (values != nullptr) H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(how);
    H5Pclose(links);
    if (!element.empty()) add_numbers(name, "element_size_um", element);
  }
  /// An attribute of a data set.
  void add_numbers(const std::string& name, const char* attribute_name, const std::vector<double>& numbers) {
    const hsize_t count = numbers.size();
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    const hid_t line = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute = H5Acreate2(set, attribute_name, H5T_IEEE_F64LE, line, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, numbers.data());
    H5Aclose(attribute);
    H5Sclose(line);
    H5Dclose(set);
  }

 private:
  hid_t file_;
};

}  // namespace adamas::test
