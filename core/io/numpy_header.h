#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adamas/raw_volume.h"  // StoredType
#include "core/io/image_header.h"

namespace adamas::io {

/// The header of an array of NumPy (versions 1 to 3 of the format .npy).
struct NumpyHeader {
  std::optional<StoredType> type;  ///< none if it is none of ours, or if the array's elements are no numbers
  std::string type_text;           ///< the type by the header, as "<f4"; empty for records
  bool big_endian = false;
  bool fortran_order = false;        ///< whether the first index runs fastest, else the last one
  std::vector<std::uint64_t> shape;  ///< the array's length along each axis
  std::uint64_t bytes = 0;           ///< of the header
};

/// Parses the beginning of a file. Throws Error with `name` if it is no such header.
NumpyHeader parse_numpy_header(std::string_view beginning, const std::string& name);

/// The header of an array (.npy), or of those in an archive (.npz), as an image. In the usual order of NumPy
/// an array's axes are z, y, x, in Fortran order x, y, z. Of four axes the shorter one of the first and the
/// last (the first if they are equal) is that of components, or of times where it is the slowest of a single
/// array. Of an archive, all arrays of the greatest shape are taken; others, and what is no array of
/// numbers, are named in a remark. Throws Error if the file is damaged, or if it has no array of numbers
/// along one to four axes.
ImageHeader numpy_image(const std::filesystem::path& path);

}  // namespace adamas::io
