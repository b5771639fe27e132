#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

// This header has functions for files of other programs, which docs/file_formats.md lists. All calls throw
// Error, with the file's name, where a file is missing, corrupt, of an unknown format, or cannot be written
// in full. A written file gets its name when it is whole, and equal contents give equal bytes.

/// The kind of data in a file.
enum class InputKind : std::uint8_t {
  kGrid,      ///< data on a grid, an image or a volume
  kMesh,      ///< tetrahedra, or a saved hierarchy
  kCells,     ///< the cells of a simulation: polyhedra of any kind
  kPolygons,  ///< polygons or lines, which may have materials on both sides
  kNetwork,   ///< triangles between labelled regions
  kSurface    ///< polygons without materials
};

/// Options that say how a file is read as multi-material data. FILE-or-ARRAY names an array of the main file,
/// or else a file on the same grid that holds one array. A file may be a pattern of pictures too, TIFF or
/// PNG, one plane in each (match_stack), as "labels_*.tif".
struct MaterialDataOptions {
  /// Materials and their volume fractions: NAME, FILE-or-ARRAY. Where neither these nor `fraction_array` are
  /// given, every array whose name contains "volume fraction" is a material, or one for each of its
  /// components.
  std::vector<std::pair<std::string, std::string>> fractions;
  /// FILE-or-ARRAY of several components, each the volume fractions of a material.
  std::string fraction_array;
  /// The names of these materials; if empty, the file's names of the components, or NAME_1, NAME_2, ...
  /// by the name of the array.
  std::vector<std::string> fraction_names;
  std::optional<double> fraction_scale;  ///< what a volume fraction of 1 is stored as (255, 100); none: 1
  std::string rest;                      ///< one more material, of what the others leave of 1
  /// FILE-or-ARRAY of whole numbers that name the material of a site. Where neither it nor `fractions` is
  /// given and no array is a volume fraction, an array "labels" of a file with material names is taken.
  std::string labels;
  /// Names of labels by their numbers, before those that a file has.
  std::map<std::int64_t, std::string> label_names;
  /// Further fields: NAME, FILE-or-ARRAY.
  std::vector<std::pair<std::string, std::string>> fields;
  /// Fields, by name, whose values are amounts per cell: they are divided by their material's volume there,
  /// and are zero where it has none.
  std::vector<std::string> extensive;
  /// The height of the cells that are made of a mesh of two dimensions; none: such meshes are refused.
  std::optional<double> extrude;
  /// Whether a mesh of two dimensions is turned round the axis of y: x is the distance from it. Cells become
  /// 48 sectors of rings, whose volumes are those of the rings.
  bool axisymmetric = false;
  /// The number of a time, from 0 on, of a file of cells with several (mesh_times()); none: the last one.
  std::optional<std::uint64_t> time;
  /// Of a pattern of pictures: the distances of samples, and the place of the first one.
  std::optional<Vec3> stack_spacing, stack_origin;
  /// x0, x1, y0, y1, z0, z1: only the sites in this box are kept.
  std::optional<std::array<double, 6>> region;
  /// The centering of the values, whatever the files say.
  std::optional<Centering> centering;
  /// If nothing is a material, all of the grid is one, kPlainMaterial, with all arrays as fields.
  bool plain = false;
  /// Receives, in one line each, assumptions about what the files do not say.
  std::function<void(const std::string&)> note;
};

/// Sets the path of the program adamas-reader, which is installed with adamas::io: readers of libraries that
/// may crash on corrupt files (VTK's, libtiff's, HDF5's, CGAL's) run in it. The path holds whatever the
/// environment variable ADAMAS_READER_PROGRAM says, which has the same effect; it is looked for again where
/// the path is empty. Programs that do not lie beside it or in the folder bin of the same prefix call this
/// once, before anything is read. In CMake the path is $<TARGET_FILE:adamas::reader>.
void set_reader_program(const std::filesystem::path& program);

/// Says which data sets of files of HDF5 are a mesh or a grid, for files that no program's layout is known
/// of: texts "KEY=DATASET" with the keys of docs/your_data.md (nodes, cells, base, x, y, z, boxes, steps,
/// times). The layout holds for all files of HDF5 that are read afterwards, until another one is set; none:
/// files are read as they are. It is not set while other threads read files. Throws Error (kUsage) for other
/// texts.
void set_hdf5_layout(const std::vector<std::string>& layout);

/// Reads volume fractions or labels, and fields, on an image or a rectilinear grid: `.vti`, `.vtr`, `.vtk`,
/// `.nrrd`, `.mha`, `.nii`, `.tif` and others.
OwnedGridData read_grid_data(const std::filesystem::path& path, const MaterialDataOptions& options = {},
                             Progress& progress = SilentProgress::instance());

/// Reads a volume of one value per sample into memory: the formats above and `.h5`. Sample types that volumes
/// do not have become int16 or float. `array`: the name of the array in a file with several.
Volume read_volume(const std::filesystem::path& path, const std::string& array = {},
                   Progress& progress = SilentProgress::instance());

/// Writes `.vti`, `.nrrd`, `.nhdr`, `.mha`, `.mhd`, `.nii`, `.nii.gz` or `.raw`. Throws Error too where
/// `samples` does not have grid.bytes() bytes.
void write_volume(const std::filesystem::path& path, const VolumeGrid& grid,
                  std::span<const std::byte> samples);

/// Reads interfaces with their materials: `.vtp` and `.ply` from write_mesh(), `.arec`, `.txt`.
InterfaceTriangles read_interfaces(const std::filesystem::path& path);

/// Reads a surface: `.ply`, `.vtp`, `.obj`, `.off` or `.stl`. Normals and values come back from a `.ply` that
/// write_mesh() wrote, and from a `.vtp`; coordinates are as accurate as write_mesh() writes them. Equal
/// points of an `.stl` become one. Polygons are divided into triangles.
TriangleSurface read_surface(const std::filesystem::path& path);

/// Reads tetrahedra and their materials, such as those of a cut mesh: `.vtu`.
MaterialTetrahedra read_tetrahedra(const std::filesystem::path& path);

/// Reads points from lines "x,y,z" with semicolons, commas or blanks between the numbers. Further columns,
/// empty lines, lines that begin with '#', and names of columns in the first line are ignored. Errors name
/// the line. Lines with both semicolons and commas are refused, since the commas would be decimal ones.
std::vector<Vec3> read_points(const std::filesystem::path& path);

/// Writes a text as it is.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Writes interfaces: `.vtp`, `.ply`, `.obj`, `.off`, `.stl`, `.arec` or `.txt`.
void write_mesh(const std::filesystem::path& path, const InterfaceTriangles& mesh);
/// Writes a surface: `.ply`, `.stl`, `.obj`, `.vtp`, `.glb` or `.gltf`.
void write_mesh(const std::filesystem::path& path, const TriangleSurface& mesh,
                Progress& progress = SilentProgress::instance());
/// Writes tetrahedra and their materials: `.vtu`, `.vtkhdf`, `.msh` or `.exo`.
void write_mesh(const std::filesystem::path& path, const MaterialTetrahedra& mesh);
/// Writes tetrahedra and all their arrays: `.vtu` or `.vtkhdf`. AdaptiveMesh::view() becomes the file of
/// `adamas resample`.
void write_mesh(const std::filesystem::path& path, const TetrahedraView& mesh);

}  // namespace adamas
