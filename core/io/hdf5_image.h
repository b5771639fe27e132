#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// A file of HDF5 that is built in memory. Equal calls give equal bytes. Throws Error where HDF5 fails.
class Hdf5Image {
 public:
  Hdf5Image();
  ~Hdf5Image();
  Hdf5Image(const Hdf5Image&) = delete;
  Hdf5Image& operator=(const Hdf5Image&) = delete;

  /// Adds an array as a data set; '/' in its name makes groups.
  void add(const NamedArray& array);
  void add(const std::string& name, std::span<const std::int64_t> numbers);
  /// Adds texts of any length, as VTK reads them; add() makes them all as long as the longest.
  void add_texts(const std::string& name, const std::vector<std::string>& texts);
  /// Adds an attribute to a group, which is made if there is none.
  void add_attribute(const std::string& group, const char* name, const std::string& text);
  void add_attribute(const std::string& group, const char* name, std::span<const std::int64_t> numbers);
  /// The bytes of the file.
  [[nodiscard]] std::string bytes();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace adamas::io
