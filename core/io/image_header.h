#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/grid_file.h"
#include "core/io/volume_source.h"

namespace adamas::io {

struct RawVolume;

/// An array of an image file.
struct ImageArray {
  std::string name;  ///< empty where the format names none: it is called like the file then
  Centering centering = Centering::kPoints;
  /// Where its numbers are. Of the grid of the source only the numbers of sites along the axes are set.
  VolumeSource source;
  std::string missing = {};  ///< why its numbers cannot be read, as the end of a message; mostly empty
  bool other_form = false;   ///< that is since they are in a form that a library may know
  /// All values of a component lie together, one component behind the other.
  bool planar = false;
  std::vector<std::string> component_names = {};  ///< as of GridArray
};

/// What the samples along an axis stand for: nothing where the header does not say. As values of cells, the
/// first cell begins `first_face` steps behind the first sample, and each is `cell` steps long.
struct SampleCentering {
  std::optional<Centering> stated;
  double first_face = -0.5, cell = 1;
};

/// What the header of an image file says, of whatever format: where its axes lie, and where its arrays are. A
/// volume is one of these arrays, read plane by plane; a grid is all of them, read whole.
struct ImageHeader {
  std::string kind;                                  ///< "NRRD", "VTK XML image"
  std::string name;                                  ///< the file's, for messages
  std::array<std::uint64_t, 3> dimensions{1, 1, 1};  ///< numbers of samples, or of points, along the axes
  std::array<std::int64_t, 3> first{};               ///< the index of the first of them
  GridAxes axes;  ///< a step along each axis, and the place of the sample (0, 0, 0)
  /// Where steps along an axis differ: the places of all points along each, in place of these; else empty.
  std::array<std::vector<double>, 3> nodes;
  Vec3 spacing{1, 1, 1};  ///< how long the header says that steps are; 1 where their directions say it
  std::string space;      ///< as of VolumeGrid
  /// Of samples, which may be values at points or of the cells round them; nothing where the arrays say
  /// which.
  std::optional<std::array<SampleCentering, 3>> centers;
  std::vector<ImageArray> arrays;
  std::string active;           ///< the name of the array that is shown where none is named; mostly empty
  std::uint64_t times = 1;      ///< how many times there are; the arrays are those of the first, and
  std::uint64_t time_step = 0;  ///< so many bytes lie between the beginnings of one and of the next
  double time_spacing = 1;      ///< between them, in seconds where the header says a unit of time
  /// Texts with a zero behind each, as of GridFile::material_names; how many bytes they are is not set.
  std::optional<VolumeSource> material_names;
};

/// What would be the header of bare samples.
ImageHeader raw_image(const std::filesystem::path& path, const RawVolume& raw);

/// One array of the file as a volume: that of the name `array` or, where it is empty, the active or the only
/// one. Of several times, `time` is the number of the one to read, from 0 on. Throws Error where that is not
/// one number per sample, or no place in space.
VolumeSource volume_of(const ImageHeader& header, const std::string& array,
                       std::optional<std::uint64_t> time);

/// The numbers of a source, read whole.
std::vector<double> read_doubles(const VolumeSource& source);

/// All arrays of the file, read whole; times are components. Throws Error where they are not.
GridFile grid_of(const ImageHeader& header, const std::filesystem::path& path);

}  // namespace adamas::io
