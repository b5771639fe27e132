#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/data/stored_type.h"
#include "core/io/image_header.h"

namespace adamas::io {

/// The entries of a header of NIfTI-1 or NIfTI-2 that a volume needs (nifti.nimh.nih.gov).
struct NiftiHeader {
  /// The size of a header of NIfTI-2 with the flags of extensions.
  static constexpr std::size_t kMostBytes = 544;

  bool big_endian = false;
  bool single = true;     ///< whether the samples follow in the same file
  std::size_t bytes = 0;  ///< size of the header itself
  std::array<std::int64_t, 8> dim{};
  int datatype = 0, bits = 0;
  std::array<double, 8> pixdim{};
  double offset = 0;  ///< offset of the samples
  double slope = 0, intercept = 0;
  int qform_code = 0, sform_code = 0;
  int units = 0;  ///< code of the units of length and time
  std::array<double, 3> quaternion{}, qoffset{};
  std::array<std::array<double, 4>, 3> srow{};

  /// Reads a header. Throws Error with `name` unless the text begins with one.
  static NiftiHeader parse(std::string_view text, const std::string& name);

  /// The steps along the axes and the first sample's position, by the sform, else by the qform; empty if the
  /// header has neither. Coordinates are RAS.
  [[nodiscard]] std::optional<GridAxes> axes() const;
  /// The length of a step along an axis, by pixdim.
  [[nodiscard]] double spacing(int axis) const;
  /// The time from one step to the next, by pixdim: in seconds if the unit is one of time; 1 if it is not
  /// stated.
  [[nodiscard]] double time_spacing() const;
  /// The type of the samples; empty if these are no numbers.
  [[nodiscard]] std::optional<StoredType> type() const;
  /// The numbers per sample: more than one for colours and complex numbers.
  [[nodiscard]] std::size_t components() const;
};

/// Reads the first bytes of a file, unpacked: its header, or all of a shorter file.
std::string read_nifti_header(const std::filesystem::path& path);

/// Reads the header (NIfTI-1 or NIfTI-2) at the beginning of the file `path` as that of an image; sizes of
/// files are not checked. The samples of a pair lie in the .img file beside it.
ImageHeader nifti_image(std::string_view text, const std::filesystem::path& path);

/// Whether a header can tell a unit of length.
bool nifti_tells(const std::string& length_unit);

/// The bytes before the samples in a file that holds both: NIfTI-1, or NIfTI-2 if there are more than 32767
/// samples along an axis. Positions are in RAS if the space of the grid is known; `grid.space` has to be RAS
/// or one that cannot be converted to it.
std::string nifti_file_header(const VolumeGrid& grid, StoredType type);

}  // namespace adamas::io
