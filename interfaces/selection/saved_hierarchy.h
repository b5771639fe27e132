#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/cell_errors/field_error.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/interface_comparison.h"

namespace adamas::interfaces {

class Resampler;

/// A hierarchy without its input: every tetrahedron of the tree, the data of its vertices, and the measured
/// errors. Each mesh that splits and merges can reach from it is a choice of its cells (Selection).
struct SavedHierarchy {
  /// The cells are all tetrahedra of the tree: the roots, then two children for each entry of `split_cells`.
  ResampledMesh tree;
  std::uint32_t root_count = 0;
  /// The cells that are split, diamond by diamond, ancestors first: the children of `split_cells[i]` are the
  /// cells `root_count + 2 i` and `root_count + 2 i + 1`.
  std::vector<std::uint32_t> split_cells;
  /// Diamond d splits `split_cells[first_cells[d] .. first_cells[d + 1])` at the vertex `new_vertices[d]`.
  std::vector<std::uint32_t> first_cells{0}, new_vertices;

  /// For each diamond, the interface error below which a mesh must have it split. It is certified
  /// (certify_selections()) or, in files without such errors, estimated. The errors are nested.
  std::vector<double> interface_errors;
  /// The measured distances of meshes, the coarsest first. Each mesh has the diamonds above its certificate's
  /// error split; the last is the whole mesh, which need not be better. Older files have none.
  std::vector<InterfaceCertificate> certificates;
  /// Nested errors of the diamonds (NestedErrors): estimates for the interfaces and for each field.
  std::vector<double> interface_estimates;
  std::vector<std::vector<double>> field_errors;
  /// The errors of each field in every cell by itself (field_errors_of_tree()), for any mesh of which it may
  /// be a cell; the worst native elements are not stored.
  std::vector<std::vector<FieldError>> measured;

  /// The interface error and the errors of fields for which the hierarchy was built.
  double interface_target = 0;
  std::vector<std::optional<double>> field_targets;
  /// The least spacing of the input's grid; 0 if it has none.
  double voxel = 0;
  /// The volumes of the materials in the input; empty if they are not known.
  IdVector<MaterialId, double> input_volumes;

  [[nodiscard]] std::size_t diamond_count() const { return new_vertices.size(); }
  /// Returns the number of tetrahedra that a diamond splits.
  [[nodiscard]] std::uint32_t member_count(std::size_t diamond) const {
    return first_cells[diamond + 1] - first_cells[diamond];
  }
  /// Returns the diamond that splits each entry of `split_cells`.
  [[nodiscard]] std::vector<std::uint32_t> diamonds_of_split_cells() const;
  /// Returns the first child of an entry of `split_cells`; the second child is the next cell.
  [[nodiscard]] std::uint32_t first_child(std::size_t split_cell) const {
    return root_count + 2 * static_cast<std::uint32_t>(split_cell);
  }
  /// Throws Error that names `name` and the first broken law: those of the tree's cells and vertices; parents
  /// come before children; children are halves of their parents; nested errors do not grow; numbers are
  /// finite and not below 0.
  void validate(const std::string& name) const;
  /// Throws as validate() does where a law of the tree's cells and vertices is broken; errors may be left
  /// out.
  void validate_tree(const std::string& name) const;

 private:
  void check_numbers(const std::string& name) const;
};

/// Returns the hierarchy of a resampler that has refined, with all data that its meshes need. Throws
/// Cancelled if the progress requests it.
SavedHierarchy take_hierarchy(const Resampler& resampler, Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
