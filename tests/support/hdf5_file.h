#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/data/stored_type.h"

namespace adamas::test {

/// An HDF5 file that is written.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Adds a data set of `size` numbers along its axes, the slowest first, in the groups that its name states.
  /// Without `values` no data are written. The layout is contiguous where `chunk` is 0.
  void add(const std::string& name, const std::vector<std::uint64_t>& size, StoredType type,
           const void* values, std::uint64_t chunk = 0, bool big_endian = false);
  /// Adds a data set of texts, of variable length or padded by zeros.
  void add_texts(const std::string& name, const std::vector<std::string>& texts, bool variable);
  /// Adds an attribute to a data set or a group.
  void add_numbers(const std::string& name, const char* attribute, const std::vector<double>& numbers);
  /// Adds a group, with those that it is in.
  void add_group(const std::string& name);
  /// Adds an attribute of a text of fixed length.
  void add_text(const std::string& name, const char* attribute, const std::string& text);

 private:
  std::int64_t file_;
};

}  // namespace adamas::test
