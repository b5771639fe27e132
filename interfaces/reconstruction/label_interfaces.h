#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/label_lattice.h"
#include "interfaces/reconstruction/label_surfaces.h"
#include "interfaces/reconstruction/region_parts.h"

namespace adamas::interfaces {

/// Interfaces and bodies of labels. They are those that MaterialLattice gives for the values of LabelLattice,
/// but they are made from the labels and a few numbers per run of labels, without arrays of values for each
/// site.
class LabelInterfaces {
 public:
  /// Returns null if the labels need more: if sites may not keep their labels, if a material may own a piece
  /// of a tetrahedron alone without smoothing, as small pieces are given to others (find_flakes()), or where
  /// spacings differ so much that small pieces can come about otherwise.
  /// `volumes`: those of materials in the data.
  static std::unique_ptr<LabelInterfaces> make(const MultiMaterialData& data,
                                               const IdVector<MaterialId, double>& volumes, bool smooth,
                                               Progress& progress);

  [[nodiscard]] std::vector<Vec3> take_points() { return std::move(mesh_.points); }
  [[nodiscard]] std::vector<InterfaceTriangle> take_triangles() { return std::move(mesh_.triangles); }
  /// Moves out the bodies in front of each triangle and behind it.
  [[nodiscard]] std::vector<std::array<BodyId, 2>> take_bodies() { return std::move(bodies_); }
  [[nodiscard]] const IdVector<BodyId, MaterialId>& body_materials() const { return part_bodies_.materials; }
  /// Returns the volumes that materials own.
  [[nodiscard]] const IdVector<MaterialId, double>& volumes() const { return volumes_; }
  /// Returns the body that owns a point, by the lattice tetrahedron that holds it.
  [[nodiscard]] BodyId body_at(const Vec3& p) const;

  /// Makes the interfaces of a lattice with the values that it has, but for volumes(); returns null where it
  /// cannot, and, unless `may_leave_out` is true, where a material may own a piece of a tetrahedron alone.
  static std::unique_ptr<LabelInterfaces> make(const MultiMaterialData& data, LabelLattice&& lattice,
                                               bool may_leave_out, Progress& progress);
  /// Finds the bodies of a lattice in whose tetrahedra no material owns a piece alone; makes no triangles.
  static std::unique_ptr<LabelInterfaces> without_triangles(const MultiMaterialData& data,
                                                            LabelLattice&& lattice);
  [[nodiscard]] const LabelLattice& lattice() const { return lattice_; }
  /// Returns the number of tetrahedra in which a material may own a piece alone. Their triangles are behind
  /// all others.
  [[nodiscard]] std::size_t left_out() const { return left_out_.size(); }

 private:
  explicit LabelInterfaces(const MultiMaterialData& data, LabelLattice&& lattice)
      : source_(data.source), lattice_(std::move(lattice)) {}

  bool extract(const MultiMaterialData& data, bool may_leave_out, Progress& progress);
  [[nodiscard]] RegionParts parts_of_runs() const;
  /// A feature and the number of its point.
  using Place = std::pair<LatticeFeature, std::uint32_t>;
  /// The surfaces in some layers of cells, and the places in the planes below and above them.
  struct Slab {
    LabelSurfaces surfaces;
    std::vector<Place> low, high;
  };
  [[nodiscard]] std::vector<Place> places_in_plane(const LabelSurfaces& surfaces, std::uint32_t k) const;
  void append(const Slab& slab, std::vector<Place>& below);
  bool add_left_out(const MultiMaterialData& data, RegionParts& parts);
  bool name_parts(const LatticeTetrahedron& left_out, const LabelLattice::Tetrahedron& tetrahedron,
                  OwnershipProblem& problem, RegionParts& parts);
  template <class Known>
  bool append_left_out(const InterfaceMesh& found, Known&& known_point);
  [[nodiscard]] std::uint32_t run_of(const LabelLattice::Index& point) const;
  [[nodiscard]] std::uint64_t inner_key(const LatticeTetrahedron& tetrahedron, std::size_t slot) const;

  std::string source_;
  LabelLattice lattice_;
  InterfaceMesh mesh_;
  std::vector<std::array<BodyId, 2>> bodies_;
  IdVector<MaterialId, double> volumes_;
  RegionParts::Bodies part_bodies_;
  std::vector<LatticeTetrahedron> left_out_;
  /// The points on features of tetrahedra that are left out.
  std::unordered_map<LatticeFeature, std::uint32_t> points_beside_;
  std::unordered_map<std::uint64_t, RegionParts::Part> inner_parts_;  ///< by inner_key()
};

}  // namespace adamas::interfaces
