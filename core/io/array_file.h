#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// A file of named arrays: HDF5 (readable by version 1.8 or later) behind a block of 512 bytes with the
/// file's kind, length and checksum. Names may have groups: "vertices/radius".
struct ArrayFile {
  std::string format;  ///< a word or two
  int version = 1;
  std::vector<NamedArray> arrays;
};

/// Writes a file of arrays; equal arrays give equal bytes. Throws Error if the file cannot be written in
/// full.
void write_array_file(const std::filesystem::path& path, const ArrayFile& file);

/// Whether a file begins as a file of arrays of this format.
bool is_array_file(const std::filesystem::path& path, const std::string& format);

/// Reads the arrays with these names that the file has; a '#' in a name stands for 0, 1, 2 and so on. Nothing
/// else in the file is read. HDF5 runs in a process of its own (reader_program.h). Throws Error, with the
/// file's name, if the file is not of the format, if its version is not from `oldest` to `newest`, if it is
/// not as it was written (a checksum over all bytes is compared first), and if arrays lie in other files or
/// have more values than the file can hold.
ArrayFile read_array_file(const std::filesystem::path& path, const std::string& format,
                          const std::vector<std::string>& names, int oldest, int newest);

}  // namespace adamas::io
