#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adamas/raw_volume.h"
#include "core/io/grid_file.h"
#include "core/io/segment_layers.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// An array of an image file.
struct ImageArray {
  std::string name;  ///< empty if the format names none; the array then has the file's name
  Centering centering = Centering::kPoints;
  /// The place of its numbers. In the grid of the source only the number of sites along each axis is set.
  VolumeSource source;
  std::string missing = {};  ///< why its numbers cannot be read, as the end of a message; usually empty
  bool other_form = false;   ///< whether that is because of a form that a library may know
  /// Whether all values of a component lie together, one component behind the other.
  bool planar = false;
  std::vector<std::string> component_names = {};  ///< names of components, as in GridArray
  /// The segments of components that are layers of labels, which are read as one component of labels; empty
  /// of other components.
  std::vector<LayerSegment> segments = {};
};

/// The centering of samples along an axis; empty if the header does not state it. If samples are values of
/// cells, the first cell begins `first_face` steps behind the first sample, and each is `cell` steps long.
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
  std::array<std::int64_t, 3> first{};               ///< the index of the first sample
  GridAxes axes;  ///< a step along each axis, and the place of the sample (0, 0, 0)
  /// The positions of all points along each axis if steps along one differ; they replace `axes` then.
  /// Otherwise empty.
  std::array<std::vector<double>, 3> nodes;
  Vec3 spacing{1, 1, 1};  ///< length of steps by the header; 1 if the directions of `axes` include it
  std::string space;      ///< the space of coordinates, as in VolumeGrid
  std::string length_unit, value_unit;  ///< units of coordinates and of values, as in VolumeGrid
  /// The centering of samples, which may be values at points or of the cells round them; empty if the arrays
  /// state it.
  std::optional<std::array<SampleCentering, 3>> centers;
  std::vector<ImageArray> arrays;
  std::string active;           ///< the name of the array that is used if none is named; usually empty
  std::uint64_t times = 1;      ///< number of times; the arrays are those of the first time
  std::uint64_t time_step = 0;  ///< bytes from the beginning of one time to that of the next
  double time_spacing = 1;  ///< the difference of two times, in seconds if the header states a unit of time
  /// The texts of GridFile::material_names, each with a zero byte behind it; their number of bytes is not
  /// set.
  std::optional<VolumeSource> material_names;
  std::map<std::int64_t, std::string> label_names{};  ///< names of labels by their values; usually empty
  /// Colours of labels by their values: red, green and blue from 0 to 1; usually empty.
  std::map<std::int64_t, std::array<double, 3>> label_colours{};
};

/// Makes the header of a file of bare samples.
ImageHeader raw_image(const std::filesystem::path& path, const RawVolume& raw);

/// The source of one array as a volume: the array with the name `array` or, if that is empty, the active or
/// only one. `time` is the number of the time to read, from 0, if there are several. Throws Error if the
/// array has not one number per sample, or no place in space.
VolumeSource volume_of(const ImageHeader& header, const std::string& array,
                       std::optional<std::uint64_t> time);

/// Reads all numbers of a source.
std::vector<double> read_doubles(const VolumeSource& source);

/// Reads all arrays of the file; times become components. Throws Error if arrays are not complete.
GridFile grid_of(const ImageHeader& header, const std::filesystem::path& path,
                 const GridReading& reading = {});

}  // namespace adamas::io
