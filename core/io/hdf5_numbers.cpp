#include "core/io/hdf5_numbers.h"

#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/io/grid_numbers.h"
#include "core/io/hdf5_handle.h"
#include "core/io/volume_import.h"

namespace adamas::io {

Hdf5Id hdf5_memory_type(StoredType type) {
  const std::array<hid_t, 10> types{H5T_NATIVE_INT8,  H5T_NATIVE_UINT8,  H5T_NATIVE_INT16, H5T_NATIVE_UINT16,
                                    H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                                    H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE};
  return types[static_cast<std::size_t>(type)];
}

void check_hdf5_samples(const std::string& name, Hdf5Id set) {
  const Hdf5Handle layout(H5Dget_create_plist(set), H5Pclose);
  if (!layout.good() || !hdf5_holds_values(layout.id()))
    fail("{}: expected samples in the file itself, found them in others", name);
}

std::uint64_t count_hdf5_numbers(const std::string& name, Hdf5Id set, StoredType stored,
                                 const std::array<std::uint64_t, 3>& sizes, std::uint64_t components) {
  constexpr auto kMost = std::uint64_t{1} << 40;
  std::uint64_t count = components;
  for (const std::uint64_t n : sizes) {
    if (n == 0 || count == 0 || n > kMost / count) fail("{}: expected samples, found no or too many", name);
    count *= n;
  }
  // Samples that were never written would all be read as the fill value.
  const std::uint64_t bytes = H5Dget_storage_size(set);
  if (bytes < count * stored_bytes(stored) / kGreatestExpansion || bytes == 0)
    fail("{}: expected {} samples, found {} bytes of them", name, count, bytes);
  check_hdf5_samples(name, set);
  return count;
}

void read_hdf5_numbers(const std::string& name, Hdf5Id set, StoredType stored, std::uint64_t count,
                       GridArray& array) {
  visit_stored_type(stored, [&]<class Stored>(Stored) {
    std::vector<Stored> numbers(static_cast<std::size_t>(count));
    if (H5Dread(set, hdf5_memory_type(stored), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
      fail("{}: expected whole samples, found corrupt or missing ones", name);
    set_numbers(std::span<const Stored>(numbers), array);
  });
}

}  // namespace adamas::io
