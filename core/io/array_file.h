#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// A file of named arrays: HDF5 (1.8 or later reads it) behind a block of 512 bytes, which says what the file
/// is, how long, and what its checksum is. Names may have groups: "vertices/radius".
struct ArrayFile {
  std::string format;  ///< a word or two
  int version = 1;
  std::vector<NamedArray> arrays;
};

/// Writes a file of arrays; equal arrays give equal bytes. Throws Error where the file cannot be written in
/// full.
void write_array_file(const std::filesystem::path& path, const ArrayFile& file);

/// Whether a file begins as a file of arrays of this format.
bool is_array_file(const std::filesystem::path& path, const std::string& format);

/// Reads the arrays of these names, as far as the file has them; a '#' in a name stands for 0, 1, 2 and so
/// on. Nothing else in the file is looked at. HDF5 runs in a process of its own (reader_program.h). Throws
/// Error, with the file's name, where it is not of the format, of a version before `oldest` or after
/// `newest`, or not as it was written: a checksum over all bytes is looked at first; and where arrays lie in
/// other files, or have more values than the file can hold.
ArrayFile read_array_file(const std::filesystem::path& path, const std::string& format,
                          const std::vector<std::string>& names, int oldest, int newest);

}  // namespace adamas::io
