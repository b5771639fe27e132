#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/data/stored_type.h"
#include "core/io/image_header.h"
#include "core/io/segment_layers.h"

namespace adamas::io {

/// The contents of the header of an NRRD file (teem.sourceforge.net/nrrd/format.html) with two or three axes
/// of space and at most one other axis, the first or the last, whose entries are components.
struct NrrdHeader {
  std::optional<StoredType> type;  ///< set by parse_nrrd_header
  std::array<std::size_t, 3> sizes{1, 1, 1};
  std::size_t components = 1;
  bool planar = false;  ///< whether the axis of components is the last
  GridAxes axes;        ///< a step along each axis, and the position of the first sample
  std::array<SampleCentering, 3> centers;
  std::string space;                    ///< the space of coordinates, as in VolumeGrid
  std::string length_unit, value_unit;  ///< as in VolumeGrid
  SamplePacking encoding = SamplePacking::kRaw;
  bool big_endian = false;
  std::string data_file;  ///< empty: the data follow the header
  std::size_t line_skip = 0;
  std::int64_t byte_skip = 0;    ///< -1: the data are the file's last bytes
  std::size_t header_bytes = 0;  ///< size of the header with its empty line
  /// The names of the segments of a segmentation of 3D Slicer (.seg.nrrd), by their labels.
  std::map<std::int64_t, std::string> segments{};
  /// The colours of these, as ImageHeader has them.
  std::map<std::int64_t, std::array<double, 3>> colours{};
  /// The segments themselves if they lie in several layers, which are the components; labels are then their
  /// places in this list, from 1 on.
  std::vector<LayerSegment> layered{};
};

/// Reads a header. Throws Error with `name` and the line unless the text begins with a complete header of
/// that kind. The number of bytes of all values does not overflow.
NrrdHeader parse_nrrd_header(std::string_view text, const std::string& name);

/// Reads the header at the beginning of the file `path` as that of an image; sizes of files are not checked.
ImageHeader nrrd_image(std::string_view text, const std::filesystem::path& path);

}  // namespace adamas::io
