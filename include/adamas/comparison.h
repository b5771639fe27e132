#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

/// The meshes of a comparison (adamas/compare.h) and how they are made.
enum class MeshKind {
  kOwn,               ///< the resampled mesh
  kOwnCut,            ///< its cells cut along the interfaces
  kTetGen,            ///< TetGen with the resampled mesh's interfaces
  kTetGenUntouched,   ///< TetGen with the input's interfaces
  kMesh3,             ///< Mesh_3, its sizing matched to the resampled mesh's measured distance
  kMesh3Optimised,    ///< the mesh of kMesh3, then perturbed and exuded, as Mesh_3 does by default
  kTetGenSimplified,  ///< TetGen with the input's interfaces, simplified to the interface error
  kMesh3Simplified,   ///< Mesh_3, matched as well, with the input's interfaces simplified to half of it
  kMesh3Labels,       ///< Mesh_3, matched as well, from the labelled image itself
};

/// Returns the name of such a mesh: "TetGen (our interfaces)", for example.
std::string mesh_name(MeshKind kind);

/// A row of a comparison: a mesh and its figures, or why there is none. Figures are 0 or none where there is
/// no mesh.
struct ComparisonRow {
  MeshKind kind = MeshKind::kOwn;
  /// The error that was wanted of the resampled mesh of this group, a length.
  std::optional<double> interface_error{};
  std::string failure{};   ///< why there is no mesh; empty where there is one
  std::string switches{};  ///< the switches of the generator
  std::string note{};      ///< further facts
  std::size_t trials = 0;  ///< number of element sizes that were tried
  /// Whether there is a mesh whose distance differs from that of the resampled mesh by at most
  /// kSizingTolerance.
  bool matched = false;

  std::size_t tetrahedra = 0, vertices = 0;
  double seconds = 0;  ///< time for the mesh, without its fields
  /// The part of `seconds` that the resampled mesh took for certifying the distance.
  double certifying_seconds = 0;
  double field_seconds = 0;  ///< time for the fields at the vertices
  std::size_t peak_memory_bytes = 0;
  double dihedral_min = 0, dihedral_max = 0;  ///< angles in degrees
  double condition_number = 0;                ///< estimated condition number of a heat conduction problem
  /// Upper bounds of the greatest distance of a point of the mesh's interfaces from the input's, and of a
  /// point of the input's interfaces from the mesh's, in units of length.
  double distance_to_input = 0, distance_from_input = 0;
  /// The greatest errors of all fields, each as a part of the range of its field: at all places where the
  /// input states values, and in cells with an interface; none where there are no such places.
  std::optional<double> field_max_error{}, field_mean_error{};
  std::optional<double> field_interface_max_error{}, field_interface_mean_error{};
  /// The greatest relative difference of a material's volume from that in the input.
  std::optional<double> volume_error{};
  std::vector<ResampleReport::Field> fields{};
  std::vector<ResampleReport::Material> materials{};
  std::vector<UnreachedError> unreached{};  ///< errors that were wanted of the resampled mesh

  /// Returns the greater of both distances.
  [[nodiscard]] double distance() const { return std::max(distance_to_input, distance_from_input); }
};

}  // namespace adamas
