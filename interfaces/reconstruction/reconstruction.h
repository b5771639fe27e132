#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/label_interfaces.h"
#include "interfaces/reconstruction/lost_bodies.h"
#include "interfaces/reconstruction/material_lattice.h"
#include "interfaces/reconstruction/region_parts.h"
#include "interfaces/reconstruction/volume_agreement.h"

namespace adamas::interfaces {

struct ReconstructionOptions {
  /// Smooths labels: interfaces pass through the staircase of voxel faces, within half a voxel of it along
  /// each axis, and each material has the volume of its voxels (smooth_label_values()). An error for
  /// fractions.
  bool smooth_labels = false;
  /// Known properties of fractions.
  FractionOptions fractions{};
};

/// Throws Error (kUsage) if an option is out of range.
void check_range(const FractionOptions& options);

/// Material interfaces reconstructed from volume fractions: the surfaces where the greatest of linearly
/// interpolated values changes from one material to another (as in Bonnell et al., Material interface
/// reconstruction, 2003; D 3.4.1), with values for which each mixed cell holds its fractions. Interfaces have
/// no gaps and no overlaps, and meet at triple lines. The connected parts of each material's region, its
/// bodies, are found exactly, on the lattice.
class Reconstruction {
 public:
  /// Throws Error if the options do not suit the data.
  explicit Reconstruction(const MultiMaterialData& data, const ReconstructionOptions& options = {},
                          Progress& progress = SilentProgress::instance());

  /// Extracts interfaces from values as they are: no volumes are corrected, and flakes stay.
  Reconstruction(const MultiMaterialData& data, const SiteValues& values,
                 Progress& progress = SilentProgress::instance());

  [[nodiscard]] const InterfaceMesh& mesh() const { return mesh_; }
  /// The bodies in front of each triangle of the mesh and behind it.
  [[nodiscard]] const std::vector<std::array<BodyId, 2>>& bodies() const { return bodies_; }
  [[nodiscard]] const IdVector<BodyId, MaterialId>& body_materials() const { return body_materials_; }
  /// Move the mesh and the bodies of its triangles out of this object.
  [[nodiscard]] InterfaceMesh take_mesh() { return std::move(mesh_); }
  [[nodiscard]] std::vector<std::array<BodyId, 2>> take_bodies() { return std::move(bodies_); }
  /// Returns the body that owns a point, by the lattice tetrahedron that holds it.
  [[nodiscard]] BodyId body_at(const Vec3& p) const;
  /// Forgets what body_at() does not need of the values from which the interfaces were made.
  void keep_bodies_alone();
  /// Return the volume of each material by the fractions, and the one that the interfaces enclose.
  [[nodiscard]] const IdVector<MaterialId, double>& volume_input() const { return volume_input_; }
  [[nodiscard]] const IdVector<MaterialId, double>& volume_reconstructed() const {
    return volume_reconstructed_;
  }
  /// The agreement of volumes and fractions cell by cell.
  [[nodiscard]] const CellAgreement& agreement() const { return agreement_; }
  /// Returns the findings about the fractions; they are empty for labels.
  [[nodiscard]] const FractionFindings& findings() const { return findings_; }
  /// Returns the volumes that the interfaces are to enclose: those of the input without dispersed parts.
  [[nodiscard]] const IdVector<MaterialId, double>& volume_wanted() const { return volume_wanted_; }
  /// Returns the bodies that the fractions hold and the interfaces do not show.
  [[nodiscard]] const std::vector<LostBody>& lost_bodies() const { return lost_bodies_; }

 private:
  /// The number of a part of a material's region: that of a lattice point in it, or of an inner part.
  using Part = RegionParts::Part;
  struct Layer;

  void extract(const MultiMaterialData& data, Progress& progress);
  void extract_layer(std::uint32_t k, Layer& layer) const;
  void extract_cell(const MaterialLattice::Index& cell, Layer& layer) const;
  void extract_tetrahedron(const MaterialLattice::Index& cell, std::size_t path, double volume,
                           Layer& layer) const;
  bool extract_between_two(const std::array<std::uint32_t, 4>& points,
                           const std::array<std::uint64_t, 4>& ids, const std::array<Vec3, 4>& positions,
                           const OwnershipProblem& problem, double volume, Layer& layer) const;
  [[nodiscard]] Part part_in(const MaterialLattice::Index& cell, std::size_t path,
                             const std::array<std::uint32_t, 4>& corners,
                             const std::vector<OwnershipProblem::Candidate>& owners,
                             std::uint32_t number) const;
  /// Returns the lowest lattice point of the connected region that holds each lattice point.
  [[nodiscard]] std::vector<Part> join_points() const;
  std::vector<VolumeMove> give_flakes_to_neighbours(const MultiMaterialData& data, SiteValues& values,
                                                    const SiteCells& cells, Progress& progress);

  bool take_labels(const MultiMaterialData& data, const ReconstructionOptions& options, Progress& progress);
  /// Reconstructs data with values_, which are corrected.
  void reconstruct(const MultiMaterialData& data, const SiteCells& cells, Progress& progress);

  CellAgreement agreement_;
  std::vector<LostBody> lost_bodies_;
  std::unique_ptr<SiteValues> values_;       ///< null for labels
  std::optional<MaterialLattice> lattice_;   ///< of these values; empty for labels
  std::unique_ptr<LabelInterfaces> labels_;  ///< null for fractions
  InterfaceMesh mesh_;
  std::vector<std::array<BodyId, 2>> bodies_;
  IdVector<BodyId, MaterialId> body_materials_;
  IdVector<MaterialId, double> volume_input_, volume_wanted_, volume_reconstructed_;
  FractionFindings findings_;
  std::uint32_t slots_ = 4;  ///< the count of a tetrahedron's numbers for inner parts
  RegionParts::Bodies part_bodies_;
};

}  // namespace adamas::interfaces
