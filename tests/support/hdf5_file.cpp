#include "tests/support/hdf5_file.h"

#define H5_USE_110_API
#include <hdf5.h>

namespace adamas::test {

namespace {

struct Types {
  hid_t memory, little, big;
};

Types types_of(StoredType type) {
  const Types all[] = {{H5T_NATIVE_INT8, H5T_STD_I8LE, H5T_STD_I8BE},
                       {H5T_NATIVE_UINT8, H5T_STD_U8LE, H5T_STD_U8BE},
                       {H5T_NATIVE_INT16, H5T_STD_I16LE, H5T_STD_I16BE},
                       {H5T_NATIVE_UINT16, H5T_STD_U16LE, H5T_STD_U16BE},
                       {H5T_NATIVE_INT32, H5T_STD_I32LE, H5T_STD_I32BE},
                       {H5T_NATIVE_UINT32, H5T_STD_U32LE, H5T_STD_U32BE},
                       {H5T_NATIVE_INT64, H5T_STD_I64LE, H5T_STD_I64BE},
                       {H5T_NATIVE_UINT64, H5T_STD_U64LE, H5T_STD_U64BE},
                       {H5T_NATIVE_FLOAT, H5T_IEEE_F32LE, H5T_IEEE_F32BE},
                       {H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE, H5T_IEEE_F64BE}};
  return all[static_cast<std::size_t>(type)];
}

}  // namespace

Hdf5File::Hdf5File(const std::filesystem::path& path)
    : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
Hdf5File::~Hdf5File() { H5Fclose(file_); }

void Hdf5File::add(const std::string& name, const std::vector<std::uint64_t>& size, StoredType type,
                   const void* values, std::uint64_t chunk, bool big_endian) {
  const hid_t links = H5Pcreate(H5P_LINK_CREATE), how = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const int axes = static_cast<int>(size.size());
  if (chunk > 0) {
    const std::vector<hsize_t> chunks(size.size(), chunk);
    H5Pset_chunk(how, axes, chunks.data());
    H5Pset_deflate(how, 6);
  }
  const std::vector<hsize_t> counts(size.begin(), size.end());
  const Types types = types_of(type);
  const hid_t space = H5Screate_simple(axes, counts.data(), nullptr);
  const hid_t set =
      H5Dcreate2(file_, name.c_str(), big_endian ? types.big : types.little, space, links, how, H5P_DEFAULT);
  if (values != nullptr) H5Dwrite(set, types.memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(how);
  H5Pclose(links);
}

void Hdf5File::add_texts(const std::string& name, const std::vector<std::string>& texts, bool variable) {
  constexpr std::size_t kLength = 40;
  const hid_t links = H5Pcreate(H5P_LINK_CREATE), type = H5Tcopy(H5T_C_S1);
  H5Pset_create_intermediate_group(links, 1);
  H5Tset_size(type, variable ? H5T_VARIABLE : kLength);
  const hsize_t count = texts.size();
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT);
  std::vector<const char*> pointers;
  std::string padded;
  for (const std::string& text : texts) {
    pointers.push_back(text.c_str());
    padded += text + std::string(kLength - text.size(), '\0');
  }
  const void* values = variable ? static_cast<const void*>(pointers.data()) : padded.data();
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(set);
  H5Sclose(space);
  H5Tclose(type);
  H5Pclose(links);
}

void Hdf5File::add_group(const std::string& name) {
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  H5Gclose(H5Gcreate2(file_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT));
  H5Pclose(links);
}

void Hdf5File::add_numbers(const std::string& name, const char* attribute_name,
                           const std::vector<double>& numbers) {
  const hsize_t count = numbers.size();
  const hid_t object = H5Oopen(file_, name.c_str(), H5P_DEFAULT);
  const hid_t line = H5Screate_simple(1, &count, nullptr);
  const hid_t attribute = H5Acreate2(object, attribute_name, H5T_IEEE_F64LE, line, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, numbers.data());
  H5Aclose(attribute);
  H5Sclose(line);
  H5Oclose(object);
}

void Hdf5File::add_text(const std::string& name, const char* attribute_name, const std::string& text) {
  const hid_t object = H5Oopen(file_, name.c_str(), H5P_DEFAULT), type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size());
  const hid_t one = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, attribute_name, type, one, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, text.data());
  H5Aclose(attribute);
  H5Sclose(one);
  H5Tclose(type);
  H5Oclose(object);
}

}  // namespace adamas::test
