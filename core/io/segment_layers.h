#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/io/grid_file.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// A segment of a segmentation of 3D Slicer whose segments lie in several layers, so that they may overlap.
/// It is where the numbers of its layer are `value`.
struct LayerSegment {
  std::string name;       ///< for messages
  std::size_t layer = 0;  ///< a component of the array
  std::int64_t value = 1;
};

/// The greatest number of segments in layers.
inline constexpr std::size_t kMostLayerSegments = 65534;

/// Reads an array whose components are layers as runs of labels: those of segment n, from 0 on, are n + 1,
/// and 0 is where none is. Where segments overlap, the last one has the sample; `remark` tells how many
/// samples that are, and which segments lose how many, and of numbers that belong to no segment. `planar`:
/// whether layers follow each other in the file instead of being components of each sample. Throws Error
/// where numbers are not whole ones of up to 63 bits, and as VolumeReader and unpack_volume do.
WholeRuns read_segment_layers(const VolumeSource& source, bool planar,
                              const std::vector<LayerSegment>& segments, std::string& remark);

}  // namespace adamas::io
