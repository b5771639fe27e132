#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/selection/saved_hierarchy.h"

namespace adamas::interfaces {

/// The errors and the size for which a mesh is chosen. Without errors, the whole saved mesh is chosen.
struct SelectionTargets {
  std::optional<double> interface_error;
  std::vector<std::optional<double>> field_errors;  ///< one for each of the hierarchy's fields, or none
  std::optional<std::size_t> max_tetrahedra;
};

/// A mesh chosen from a saved hierarchy. It starts as the roots, and each choice is reached from the previous
/// one by splitting and merging diamonds.
class Selection {
 public:
  /// The hierarchy must outlive this object, and be valid.
  explicit Selection(const SavedHierarchy& hierarchy);

  /// Chooses the smallest mesh that was certified within the target for the interfaces, if one is given, and
  /// refines it until the nested errors of fields are within their targets or the hierarchy ends. If it would
  /// have too many tetrahedra, diamonds are split in the order of their errors relative to the targets, or to
  /// those for which the hierarchy was built, up to the limit. Throws Error if the limit is below the number
  /// of roots.
  void select(const SelectionTargets& targets);

  /// Splits the diamonds marked by 1 and merges the others. Ancestors of split diamonds must be split.
  void choose(const std::vector<char>& split);

  [[nodiscard]] const SavedHierarchy& hierarchy() const { return hierarchy_; }
  /// Returns the number of the mesh's tetrahedra.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns whether the mesh is the whole saved one.
  [[nodiscard]] bool is_whole() const { return split_count_ == hierarchy_.diamond_count(); }
  /// Returns whether the greatest number of tetrahedra has ended the last choice.
  [[nodiscard]] bool budget_spent() const { return budget_spent_; }
  /// Returns the number of tetrahedra that the last choice has created and removed.
  [[nodiscard]] std::size_t changed() const { return changed_; }
  /// Returns the distances of this mesh that were measured when the hierarchy was saved; null if they were
  /// not.
  [[nodiscard]] const InterfaceCertificate* certificate() const;
  /// Returns the certified error of the interfaces; if it is not known, the greatest estimate of a cell.
  [[nodiscard]] double interface_error() const;
  /// Returns the greatest nested error of a field.
  [[nodiscard]] double field_error(std::size_t field) const;
  /// Return the first cell of the hierarchy's tree among the mesh's that has the greatest estimate of the
  /// interfaces' error, and the greatest nested error of a field.
  [[nodiscard]] std::uint32_t worst_interface_cell() const;
  [[nodiscard]] std::uint32_t worst_field_cell(std::size_t field) const;
  /// Returns the cells of the hierarchy's tree that the mesh has, depth first from the roots.
  [[nodiscard]] std::vector<std::uint32_t> cells() const;
  /// Returns the mesh as one that stands alone.
  [[nodiscard]] ResampledMesh mesh() const;

 private:
  [[nodiscard]] double error_of(std::uint32_t cell, std::size_t field) const;
  [[nodiscard]] std::vector<char> diamonds_for(const SelectionTargets& targets);

  const SavedHierarchy& hierarchy_;
  std::vector<std::uint32_t> split_number_;  ///< by cell: its index in `split_cells`, or none
  std::vector<std::uint32_t> diamond_;       ///< by index in `split_cells`: the diamond that splits it
  std::vector<char> split_;                  ///< by diamond: 1 if it is split in the mesh
  std::size_t size_, split_count_ = 0, changed_ = 0;
  bool budget_spent_ = false;
};

/// Returns the mesh with which a hierarchy was saved.
ResampledMesh whole_mesh(const SavedHierarchy& hierarchy);

}  // namespace adamas::interfaces
