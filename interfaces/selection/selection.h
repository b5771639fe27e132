#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/selection/saved_hierarchy.h"

namespace adamas::interfaces {

/// The errors and the size that a mesh is chosen for. Without errors the whole mesh that was saved is chosen.
struct SelectionTargets {
  std::optional<double> interface_error;
  std::vector<std::optional<double>> field_errors;  ///< one for each of the hierarchy's fields, or none
  std::optional<std::size_t> max_tetrahedra;
};

/// A mesh chosen from a saved hierarchy. It starts as the roots, and goes from each choice to the next by
/// splitting and merging diamonds.
class Selection {
 public:
  /// The hierarchy must outlive this object, and be valid.
  explicit Selection(const SavedHierarchy& hierarchy);

  /// The smallest mesh that was certified within the target, if one for the interfaces is given, split on
  /// until the nested errors of fields are within theirs, as far as the hierarchy goes. Where it
  /// would have too many tetrahedra, diamonds are split in the order of their errors in relation to the
  /// targets, or to those that the hierarchy was built for, while there is room. Throws Error where the limit
  /// is below the number of roots.
  void select(const SelectionTargets& targets);

  /// Splits the diamonds that have a 1 and merges the others. Ancestors of split diamonds must be split.
  void choose(const std::vector<char>& split);

  [[nodiscard]] const SavedHierarchy& hierarchy() const { return hierarchy_; }
  /// The number of the mesh's tetrahedra.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Whether the mesh is the whole one that was saved.
  [[nodiscard]] bool is_whole() const { return split_count_ == hierarchy_.diamond_count(); }
  /// Whether the greatest number of tetrahedra has ended the last choice.
  [[nodiscard]] bool budget_spent() const { return budget_spent_; }
  /// The number of tetrahedra that the last choice has made and removed.
  [[nodiscard]] std::size_t changed() const { return changed_; }
  /// The distances of this mesh that were measured when the hierarchy was saved; null where they were not.
  [[nodiscard]] const InterfaceCertificate* certificate() const;
  /// The certified error of the interfaces; where it is not known, the greatest that was estimated in a cell.
  [[nodiscard]] double interface_error() const;
  /// The greatest nested error of a field.
  [[nodiscard]] double field_error(std::size_t field) const;
  /// The cells of the hierarchy's tree that the mesh has, depth first from the roots.
  [[nodiscard]] std::vector<std::uint32_t> cells() const;
  /// The mesh on its own.
  [[nodiscard]] ResampledMesh mesh() const;

 private:
  [[nodiscard]] std::vector<char> diamonds_for(const SelectionTargets& targets);

  const SavedHierarchy& hierarchy_;
  std::vector<std::uint32_t> split_number_;  ///< by cell: its place in `split_cells`, or none
  std::vector<std::uint32_t> diamond_;       ///< by place in `split_cells`: the diamond that splits it
  std::vector<char> split_;                  ///< by diamond: 1 where the mesh has it split
  std::size_t size_, split_count_ = 0, changed_ = 0;
  bool budget_spent_ = false;
};

/// The mesh that a hierarchy was saved with.
ResampledMesh whole_mesh(const SavedHierarchy& hierarchy);

}  // namespace adamas::interfaces
