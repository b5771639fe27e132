#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/export.h"
#include "adamas/file_summary.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/read_input.h"
#include "adamas/reconstruct.h"
#include "adamas/volume.h"
#include "adamas/volume_input.h"

namespace adamas ADAMAS_API {

// This header summarises the content of files for `adamas info`. FileSummary (`adamas/file_summary.h`) has
// what files of all kinds have in common, the structs below what files of one kind have besides;
// `adamas/volume_store.h` has the facts of stores.

/// A material and its volume.
struct MaterialVolume {
  std::string name;
  double volume = 0;  ///< volume in the cube of the unit of length
};

/// A field of data on a grid or of a resampled mesh.
struct FieldFacts {
  std::string name, unit;
  int components = 1;
  bool per_material = false;  ///< whether each material has its own values
  double min = 0, max = 0;    ///< range of all values; for vectors on a grid, of their lengths
  double max_error = 0;       ///< the greatest error in a resampled mesh, in the field's unit
};

/// Summary of data of several materials on a grid.
struct MaterialDataSummary {
  std::vector<MaterialVolume> materials;
  /// The least and the greatest sum of the volume fractions of a site, as they were read; none for labels.
  std::optional<std::array<double, 2>> fraction_sums;
  std::vector<FieldFacts> fields;
};

/// Reads data of several materials on a grid or a mesh and summarises them. Notes tell of repairs of volume
/// fractions beyond round-off. Throws Error as read_input() does.
MaterialDataSummary summarize_materials(const InputOptions& options,
                                        Progress& progress = SilentProgress::instance());

/// Summary of a mesh that `adamas resample` has written.
struct MeshSummary {
  std::string source;  ///< the name of the input that was resampled
  std::size_t bodies = 0, interfaces = 0;
  /// Levels of tetrahedra, and the number of tetrahedra of each.
  std::vector<std::pair<int, std::size_t>> levels;
  std::vector<MaterialVolume> materials;
  std::vector<FieldFacts> fields;
};

/// Reads a mesh (.vtu) and summarises it; none for another than a resampled mesh. Throws Error where the file
/// cannot be used.
std::optional<MeshSummary> summarize_mesh(const std::filesystem::path& path);

/// Summary of a saved hierarchy of meshes.
struct HierarchySummary {
  std::size_t tree_tetrahedra = 0, leaves = 0, diamonds = 0;
  double interface_error_target = 0;  ///< the error that it was built for, in units of length
  MeshSummary finest;                 ///< the mesh that it was saved with
};

/// Returns whether a file is a hierarchy that `adamas resample` has saved; false where there is no file.
bool is_hierarchy_file(const std::filesystem::path& path);

/// Reads a saved hierarchy and summarises it. Throws Error where the file cannot be used.
HierarchySummary summarize_hierarchy(const std::filesystem::path& path,
                                     Progress& progress = SilentProgress::instance());

/// Summary of given interfaces and of their defects.
struct NetworkSummary {
  std::vector<std::string> materials;
  std::vector<InterfaceArea> interfaces;
  std::string unsound;  ///< the reason why they cannot be used; empty where they can, and the numbers below
                        ///< are valid then
  std::size_t degenerate_triangles = 0;  ///< triangles without area
  std::size_t junction_edges = 0;        ///< edges with more than two triangles
  std::size_t open_border_edges = 0;     ///< edges with one triangle
  std::size_t flipped_edges = 0;         ///< edges round which materials do not match
  std::size_t intersections = 0;         ///< pairs of triangles that intersect
};

/// Reads given interfaces and checks them. Throws Error where the file cannot be used.
NetworkSummary summarize_interfaces(const InputOptions& options);

/// Summary of a volume of one number per sample.
struct VolumeSummary {
  FileSummary file;
  VolumeGrid grid;
  std::string conversion;     ///< how samples differ from the numbers in the file; empty where they do not
  bool loses_digits = false;  ///< whether different numbers may have become equal by the conversion
};

/// Reads the volume of a file and summarises it, if the file is to be read as a volume: where `volume` says
/// so, and where no other reader knows the file or any option about places; otherwise none. `grid_wanted`:
/// options say that the file is data on a grid with materials. No output may overwrite the files of the
/// volume then. Throws Error where the file cannot be used, and Error (kUsage) for options that do not go
/// together.
std::optional<VolumeSummary> summarize_volume(const VolumeInput& volume, bool grid_wanted, OutputSet& outputs,
                                              Progress& progress = SilentProgress::instance());

}  // namespace adamas
