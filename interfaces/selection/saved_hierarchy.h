#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/cell_errors/field_error.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/interface_comparison.h"

namespace adamas::interfaces {

class Resampler;

/// A hierarchy on its own, without its input: every tetrahedron of the tree, leaf or not, what its vertices
/// know, and the errors that were measured. Any mesh that split and merge can reach from it is a choice of
/// its cells (Selection).
struct SavedHierarchy {
  /// The cells are all tetrahedra of the tree: the roots, then two children for each entry of `split_cells`.
  ResampledMesh tree;
  std::uint32_t root_count = 0;
  /// The cells that are split, diamond by diamond, ancestors first: the children of `split_cells[i]` are the
  /// cells `root_count + 2 i` and the next.
  std::vector<std::uint32_t> split_cells;
  /// Diamond d splits `split_cells[first_cells[d] .. first_cells[d + 1])` at the vertex `new_vertices[d]`.
  std::vector<std::uint32_t> first_cells{0}, new_vertices;

  /// For each diamond, the error of the interfaces below which a mesh needs it split: certified
  /// (certify_selections), or, in files that have no such errors, estimated. The errors are nested.
  std::vector<double> interface_errors;
  /// The measured distances of meshes, the coarsest first. Each mesh is that of the diamonds above one of
  /// these errors, which is the certificate's; the last is the whole mesh, which may be no better. Older
  /// files have none.
  std::vector<InterfaceCertificate> certificates;
  /// Nested errors of the diamonds (NestedErrors): estimates of the interfaces, and of each field.
  std::vector<double> interface_estimates;
  std::vector<std::vector<double>> field_errors;
  /// Errors of each field in every cell by itself, whatever mesh it may be a cell of (field_errors_of_tree);
  /// the worst native elements are not known any more.
  std::vector<std::vector<FieldError>> measured;

  /// The interface error and the errors of fields that the hierarchy was built for.
  double interface_target = 0;
  std::vector<std::optional<double>> field_targets;
  /// Least spacing of the input's grid; 0 where it has none.
  double voxel = 0;
  /// Volumes of the materials in the input; none where they are not known.
  IdVector<MaterialId, double> input_volumes;

  [[nodiscard]] std::size_t diamond_count() const { return new_vertices.size(); }
  /// The number of tetrahedra that a diamond splits.
  [[nodiscard]] std::uint32_t member_count(std::size_t diamond) const {
    return first_cells[diamond + 1] - first_cells[diamond];
  }
  /// The diamond that splits each entry of `split_cells`.
  [[nodiscard]] std::vector<std::uint32_t> diamonds_of_split_cells() const;
  /// The first child of an entry of `split_cells`; the second is the next cell.
  [[nodiscard]] std::uint32_t first_child(std::size_t split_cell) const {
    return root_count + 2 * static_cast<std::uint32_t>(split_cell);
  }
  /// Throws Error that names `name` and the first broken law: those of the tree's cells and vertices,
  /// parents before children, children that are their parents' halves, nested errors that do not grow,
  /// numbers that are finite and not below 0.
  void validate(const std::string& name) const;

 private:
  void check_numbers(const std::string& name) const;
};

/// The hierarchy of a resampler that has refined, and what any mesh of it needs. Throws Cancelled where the
/// progress says so.
SavedHierarchy take_hierarchy(const Resampler& resampler, Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
