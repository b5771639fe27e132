#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/raw_volume.h"

namespace adamas ADAMAS_API {

/// An array of a file. The range is over all components' finite values; min > max where there is none.
struct ArraySummary {
  std::string name;
  std::string type;      ///< "uint8", "float32", "string"
  std::string location;  ///< "cells", "points" or "mesh"
  int components = 1;
  double min = 0, max = 0;
  /// The material whose volume fractions the array holds, by the array's name; none for other arrays.
  std::optional<std::string> fraction_of{};
};

/// A side set or a node set of a mesh.
struct SetSummary {
  std::string name;
  bool of_nodes = false;
  std::size_t size = 0;  ///< the number of sides or of nodes
  /// The area of the sides, in the square of the unit of length; of a mesh of two dimensions their length;
  /// none for a node set.
  std::optional<double> extent{};
};

/// The content of a file of any kind that can be read.
struct FileSummary {
  std::string kind;                    ///< "NRRD", "tetrahedra", "labelled network", ...
  std::array<std::size_t, 3> nodes{};  ///< numbers along the axes of a grid; else zeros
  /// Numbers of points and of cells, which are those of a grid, tetrahedra, polygons, lines or triangles.
  std::size_t points = 0, cells = 0;
  std::size_t blocks = 0;  ///< the number of blocks of a mesh, if it has several; else 0
  Box3 box;                ///< the box of all points
  /// Unit vectors of a grid's axes; they are x, y and z unless the grid could not be laid out along these,
  /// and `origin` is the place of its first node then.
  std::array<Vec3, 3> directions{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin;
  std::string space;  ///< the name of the coordinate space, as VolumeGrid::space; mostly empty
  std::string length_unit, value_unit;  ///< units, as those of VolumeGrid; mostly empty
  std::string remark;                   ///< what else the file holds and is not read; mostly empty
  std::vector<ArraySummary> arrays;
  std::vector<SetSummary> sets;  ///< side sets, then node sets
  bool flat = false;             ///< whether it is a mesh of two dimensions
  std::vector<double> times;     ///< of a file of cells that states some (mesh_times()); else empty
};

/// A series of images in a folder.
struct SeriesSummary {
  std::string name;       ///< its description; the UID where it has none, or one that another series has too
  std::string uid;        ///< its UID
  std::string kind;       ///< its modality: "CT", "MR", "SEG"; mostly not empty
  std::size_t files = 0;  ///< how many files it has
};

/// The series in a folder of DICOM, by their UIDs; empty for other paths. Throws Error, with the file's name,
/// where a file is damaged.
std::vector<SeriesSummary> folder_series(const std::filesystem::path& path);

/// Throws Error where a file to read is missing, a folder, no plain file, unreadable or empty.
void check_readable(const std::filesystem::path& path);

/// Reads a file of any kind and summarises it. `wanted`: the centering of its values, whatever it says;
/// `otherwise`: the centering where the file says nothing; `raw`: what a file without a header holds; `time`:
/// the number of a time of a file of cells (mesh_times()), or else the last one. Throws Error, with the
/// file's name, where the file cannot be used.
FileSummary summarize_file(const std::filesystem::path& path, std::optional<Centering> wanted = {},
                           Centering otherwise = Centering::kPoints, const std::optional<RawVolume>& raw = {},
                           std::optional<std::uint64_t> time = {});

}  // namespace adamas
