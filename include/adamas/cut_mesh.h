#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/certified_distance.h"
#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/meshes.h"
#include "adamas/probe.h"
#include "adamas/progress.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// Options that say how a mesh is cut along its interfaces.
struct CutMeshOptions {
  /// The greatest distance of the faces between materials from the mesh's interfaces: a length, or a part of
  /// the domain's diagonal. None: half of the interface error wanted.
  std::optional<ErrorTarget> error{};
  /// Bodies share no points, as for contact; otherwise they share them, and the mesh has no cracks.
  bool split_bodies = false;
};

/// Describes a cut mesh and its differences from the mesh that was cut.
struct CutMeshReport {
  std::size_t tetrahedra = 0;
  std::size_t vertices = 0;                   ///< number of points, before those of bodies are split
  double dihedral_min = 0, dihedral_max = 0;  ///< angles between faces of a tetrahedron, in degrees
  InterfaceDistances to_mesh;                 ///< distances from the interfaces of the mesh that was cut
  /// Distances from the interfaces of the input; none where these are not known.
  std::optional<InterfaceDistances> to_input;

  /// A body that is lost or torn, or has other holes or handles than before.
  struct Body {
    std::size_t body = 0;      ///< its number
    std::size_t material = 0;  ///< the number of its material
    double volume = 0;         ///< volume in the mesh that was cut, in the cube of the unit of length
    /// Topology in the mesh that was cut, and afterwards; a lost body has no pieces.
    BodyTopology topology_mesh, topology;
  };
  std::vector<Body> changed_bodies;  ///< such bodies, the greatest first
  /// The greatest volume difference of a body, in the cube of the unit of length.
  double volume_difference = 0;
};

/// A mesh that was cut along its interfaces: each tetrahedron lies in one body, and materials are blocks, as
/// solvers need it.
class CutMesh {
 public:
  CutMesh(CutMesh&&) noexcept;
  CutMesh& operator=(CutMesh&&) noexcept;
  ~CutMesh();

  [[nodiscard]] const CutMeshReport& report() const;
  /// The tetrahedra and their materials; points are split where the options asked for it.
  [[nodiscard]] MaterialTetrahedra tetrahedra() const;

  /// The library itself uses the members below.
  struct Contents;
  explicit CutMesh(std::unique_ptr<Contents> contents);
  [[nodiscard]] const Contents& contents() const { return *contents_; }

 private:
  std::unique_ptr<Contents> contents_;
};

/// Cuts a mesh along its interfaces, without slivers, and measures the result (docs/method.md, Cut meshes).
/// AdaptiveMesh::cut_mesh() does not measure. Throws Error (kUsage) for an error that is not positive or not
/// less than the domain's diagonal, and Cancelled where the progress says so.
CutMesh cut_mesh(const AdaptiveMesh& mesh, const CutMeshOptions& options = {},
                 Progress& progress = SilentProgress::instance());

/// Computes the volumes of the materials and the integrals of their fields over a cut mesh.
std::vector<MaterialTotals> material_totals(const CutMesh& mesh);

}  // namespace adamas
