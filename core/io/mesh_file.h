#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/mesh_set.h"
#include "core/io/grid_file.h"

namespace adamas::io {

/// The cells of a mesh as a file has them, in one piece: points of several blocks at one place are one.
struct MeshFile {
  std::string kind;  ///< "VTK XML unstructured grid", ...
  std::vector<Vec3> points;
  /// The faces of the cells, as PolyhedralMesh::make() takes them.
  std::vector<std::uint32_t> face_points, face_ends, cell_ends;
  bool flat = false;  ///< whether cells have no volume: each is one face, in the plane of x and y
  std::vector<GridArray> arrays;
  std::vector<std::string> blocks;          ///< the names of the blocks, if there are several
  std::vector<std::int32_t> block_of_cell;  ///< the block of each cell then; else empty
  std::vector<std::string> material_names;  ///< as in GridFile
  std::vector<MeshSet> sets;                ///< side sets and node sets
  std::vector<double> times;                ///< all that the file has; empty where it states none
  std::string remark;                       ///< what else the file holds and is not read; usually empty

  void add_remark(const std::string& text) { remark += (remark.empty() ? "" : "; ") + text; }
};

/// The programs whose meshes are read of HDF5.
enum class Hdf5Origin : std::uint8_t {
  kNone,
  kSilo,
  kMesh,  ///< Truchas, FLASH, AMR of VTKHDF, or any that set_hdf5_layout() has described
  kVtk,   ///< an unstructured grid of VTKHDF
};

/// Finds which program wrote a file of HDF5, by names that stand near its beginning or its end.
Hdf5Origin hdf5_origin(const std::filesystem::path& path);

/// Whether a file has cells of a simulation although its ending may be of another kind, by its header: a
/// legacy VTK file (.vtk) of a structured or unstructured grid, HDF5 of Silo, and a .vtu that adamas has not
/// written as a resampled mesh.
bool is_mesh_by_header(const std::filesystem::path& path);

/// Reads the cells of a mesh: .vtu, .pvtu, .vts, .pvts, .vtm, legacy .vtk, VTKHDF, ExodusII, CGNS, Silo, and
/// the cases of OpenFOAM (a file NAME.foam in the case's folder). Of several times, that with the number
/// `time` is read, or else the last one. Cells of two dimensions beside others of three are left out, and so
/// are collapsed cells and copies of cells of other pieces; points at one place are one. The libraries may
/// crash on a corrupt file, so they run in a child process (read_in_child).
MeshFile read_mesh_file(const std::filesystem::path& path, std::optional<std::uint64_t> time = {});
/// Reads a file as read_mesh_file does, but in this process.
MeshFile read_mesh_with_vtk(const std::filesystem::path& path, std::optional<std::uint64_t> time = {});
/// Finds the times of a file in this process (mesh_times()).
std::vector<double> mesh_times_with_vtk(const std::filesystem::path& path);
/// Reads a file of Silo in this process: the first mesh of several blocks or, if there is none, the first
/// with materials. Mixed zones become volume fractions, and variables with values for them fields per
/// material.
MeshFile read_silo_mesh(const std::filesystem::path& path);

/// Reads, in this process, a mesh as set_hdf5_layout() has described it or, without that, a mesh of Truchas,
/// at a time as read_mesh_file does, blocks of FLASH, or overlapping AMR of VTKHDF.
MeshFile read_hdf5_mesh(const std::filesystem::path& path, std::optional<std::uint64_t> time = {});
std::vector<double> hdf5_mesh_times(const std::filesystem::path& path);

/// Throws the Error that a file of `count` times, or of none, has no number `time`.
[[noreturn]] void fail_for_time(const std::string& name, std::size_t count, std::uint64_t time);
/// What is said where the last time is read since none was chosen.
std::string last_time_remark(std::size_t count, double time);

/// Makes prisms of this height of the cells of a flat mesh. Throws Error, which begins with `name`, if they
/// enclose no volume.
void extrude(const std::string& name, MeshFile& file, double height);
/// Turns the cells of a flat mesh round the axis of y into sectors of rings. Rings are polygons whose areas
/// are those of circles, so that volumes are exact. Throws Error, which begins with `name`, if a point lies
/// at x < 0.
void revolve(const std::string& name, MeshFile& file);

}  // namespace adamas::io
