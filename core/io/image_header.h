#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/raw_volume.h"
#include "core/io/grid_file.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// An array of an image file.
struct ImageArray {
  std::string name;  ///< empty where the format names none: the array has the file's name then
  Centering centering = Centering::kPoints;
  /// The place of its numbers. Only the numbers of sites along the axes are set in the grid of the source.
  VolumeSource source;
  std::string missing = {};  ///< why its numbers cannot be read, as the end of a message; mostly empty
  bool other_form = false;   ///< the reason is a form that a library may know
  /// Whether all values of a component lie together, one component behind the other.
  bool planar = false;
  std::vector<std::string> component_names = {};  ///< names of components, as of GridArray
};

/// The centering of samples along an axis; nothing where the header does not state it. Where samples are
/// values of cells, the first cell begins `first_face` steps behind the first sample, and each is `cell`
/// steps long.
struct SampleCentering {
  std::optional<Centering> stated;
  double first_face = -0.5, cell = 1;
};

/// The header of an image file of any format: the place of its axes, and that of its arrays. A volume is one
/// of these arrays, read plane by plane; a grid is all of them, read whole.
struct ImageHeader {
  std::string kind;                                  ///< "NRRD", "VTK XML image"
  std::string name;                                  ///< the file's name, for messages
  std::array<std::uint64_t, 3> dimensions{1, 1, 1};  ///< numbers of samples, or of points, along the axes
  std::array<std::int64_t, 3> first{};               ///< the index of the first of them
  GridAxes axes;  ///< a step along each axis, and the place of the sample (0, 0, 0)
  /// The positions of all points along each axis where steps along one differ; they replace `axes` then. Else
  /// empty.
  std::array<std::vector<double>, 3> nodes;
  Vec3 spacing{1, 1, 1};  ///< length of steps by the header; 1 where their directions have it
  std::string space;      ///< the space of coordinates, as of VolumeGrid
  /// The centering of samples, which may be values at points or of the cells round them; nothing where the
  /// arrays state it.
  std::optional<std::array<SampleCentering, 3>> centers;
  std::vector<ImageArray> arrays;
  std::string active;           ///< the name of the array that is shown where none is named; mostly empty
  std::uint64_t times = 1;      ///< number of times; the arrays are those of the first
  std::uint64_t time_step = 0;  ///< bytes from the beginning of one time to that of the next
  double time_spacing = 1;      ///< between two times, in seconds where the header states a unit of time
  /// The texts of GridFile::material_names, with a zero behind each; their number of bytes is not set.
  std::optional<VolumeSource> material_names;
};

/// Makes the header of a file of bare samples.
ImageHeader raw_image(const std::filesystem::path& path, const RawVolume& raw);

/// The source of one array as a volume: that of the name `array` or, where it is empty, the active or the
/// only one. `time` is the number of the time to read, from 0 on, where there are several. Throws Error where
/// the array has not one number per sample, or no place in space.
VolumeSource volume_of(const ImageHeader& header, const std::string& array,
                       std::optional<std::uint64_t> time);

/// Reads all numbers of a source.
std::vector<double> read_doubles(const VolumeSource& source);

/// Reads all arrays of the file; times become components. Throws Error where arrays are not whole.
GridFile grid_of(const ImageHeader& header, const std::filesystem::path& path);

}  // namespace adamas::io
