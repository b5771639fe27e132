#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "adamas/volume.h"
#include "core/geometry/vec3.h"
#include "core/io/image_header.h"
#include "core/io/stored_type.h"

namespace adamas::io {

/// What of a header of NIfTI-1 or NIfTI-2 matters to a volume (nifti.nimh.nih.gov).
struct NiftiHeader {
  /// What a header of NIfTI-2 takes, and room for extensions' flags.
  static constexpr std::size_t kMostBytes = 544;

  bool big_endian = false;
  bool single = true;     ///< the samples follow in the same file
  std::size_t bytes = 0;  ///< of the header itself
  std::array<std::int64_t, 8> dim{};
  int datatype = 0, bits = 0;
  std::array<double, 8> pixdim{};
  double offset = 0;  ///< of the samples
  double slope = 0, intercept = 0;
  int qform_code = 0, sform_code = 0;
  int units = 0;  ///< of lengths and times
  std::array<double, 3> quaternion{}, qoffset{};
  std::array<std::array<double, 4>, 3> srow{};

  /// Throws Error with `name` where the text does not begin with such a header.
  static NiftiHeader parse(std::string_view text, const std::string& name);

  /// Steps along the axes and the first sample's place: by the sform, else by the qform; nothing where the
  /// header has neither. Its coordinates are RAS.
  [[nodiscard]] std::optional<GridAxes> axes() const;
  /// Length of a step along an axis by pixdim.
  [[nodiscard]] double spacing(int axis) const;
  /// From one time to the next by pixdim: in seconds where the unit is one of time; 1 where nothing says.
  [[nodiscard]] double time_spacing() const;
  /// Nothing for a type of other things than numbers.
  [[nodiscard]] std::optional<StoredType> type() const;
  /// Numbers per sample: more than one of colours and of complex numbers.
  [[nodiscard]] std::size_t components() const;
};

/// The first bytes of a file, as they are once unpacked: its header, or all there is.
std::string read_nifti_header(const std::filesystem::path& path);

/// The header that begins the file `path`, NIfTI-1 or NIfTI-2, as that of an image; sizes of files are not
/// looked at. The samples of a pair lie in the .img beside.
ImageHeader nifti_image(std::string_view text, const std::filesystem::path& path);

/// The bytes before the samples in a file of its own: NIfTI-1, or NIfTI-2 where there are more than 32767
/// samples along an axis. Places are in RAS where the grid says what its coordinates are; `grid.space` has
/// to be RAS or one that cannot be turned to it.
std::string nifti_file_header(const VolumeGrid& grid);

}  // namespace adamas::io
