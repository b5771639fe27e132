#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/data/unstructured_mesh.h"

namespace adamas {

/// A file of named arrays: HDF5 (1.8 or later reads it) behind a block of 512 bytes, which says what the file
/// is, how long, and what its checksum is. Names may have groups: "vertices/radius".
struct ArrayFile {
  std::string format;  ///< a word or two
  int version = 1;
  std::vector<NamedArray> arrays;
};

/// Equal arrays give equal bytes. Throws Error where the file cannot be written in full.
void write_array_file(const std::filesystem::path& path, const ArrayFile& file);

/// Whether a file begins as one of this format does.
bool is_array_file(const std::filesystem::path& path, const std::string& format);

/// Throws Error, with the file's name, where it is not of the format, of a version other than `version`, or
/// not as it was written: a checksum over all bytes is looked at first.
ArrayFile read_array_file(const std::filesystem::path& path, const std::string& format, int version);

}  // namespace adamas
