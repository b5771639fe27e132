#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/ownership/cell_ownership.h"
#include "interfaces/source/ghost_values.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::interfaces {

/// Error of one field at one native data element.
struct ElementError {
  double error;
  std::uint32_t element;
  ElementKind kind;
  bool displaced;  ///< the mesh gives its place to another material
  bool reducible;  ///< small enough cells come as near to the value as is wanted
};

/// Errors of one field at the native data elements of a cell.
struct FieldError {
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  double max = 0;
  double reducible = 0;  ///< the greatest of those that smaller cells lower
  double sum = 0;
  std::array<std::uint32_t, kElementKinds> counts{};  ///< by kind
  std::uint32_t displaced = 0;                        ///< of those counted
  /// Elements that do not count: without a value in the input, or minorities of which the mesh has no part
  /// that near.
  std::uint32_t without_value = 0;
  std::uint32_t worst = kNowhere;  ///< a native element with the greatest error, where that is not 0

  void add(const ElementError& at) {
    if (at.error > max) max = at.error, worst = at.element;
    if (at.reducible) reducible = std::max(reducible, at.error);
    sum += at.error;
    ++counts[static_cast<std::size_t>(at.kind)];
    displaced += at.displaced ? 1 : 0;
  }
  void add(const FieldError& other) {
    if (other.max > max) max = other.max, worst = other.worst;
    reducible = std::max(reducible, other.reducible);
    sum += other.sum;
    for (std::size_t kind = 0; kind < kElementKinds; ++kind) counts[kind] += other.counts[kind];
    displaced += other.displaced;
    without_value += other.without_value;
  }
  /// Elements that count.
  [[nodiscard]] std::size_t count() const { return std::size_t{counts[0]} + counts[1] + counts[2]; }
  /// The mean error; 0 without elements.
  [[nodiscard]] double mean() const { return count() > 0 ? sum / static_cast<double>(count()) : 0; }
};

/// Errors of one field at all native elements, and at those in cells with an interface.
struct FieldFigures {
  FieldError all, at_interfaces;
};

/// A cell with what is needed to evaluate fields in it.
struct CellView {
  Tetrahedron frame;
  CellOwnership owners;  ///< candidates that own a part
  std::array<const VertexRecord*, 4> vertices;
  std::vector<OwnedTetrahedron> parts;  ///< the cell divided by owner
};
/// Calls back for every cell that may meet a box and hold a material, with views that stay.
using CellsInBox = std::function<void(const Box3&, MaterialId, const std::function<void(const CellView&)>&)>;

/// Difference between the input and the linear approximation of each field at the native elements of a cell,
/// of the element's own material (docs/method.md, Errors); vectors by length. Returns the displaced elements,
/// which are left out: those whose place the mesh gives to another material.
std::vector<std::uint32_t> measure_field_errors(const ResamplingSource& source, const CellView& cell,
                                                std::span<const std::uint32_t> elements,
                                                std::span<FieldError> errors);

/// What an element counts as where the mesh has no part of its material that near.
enum class NoPartNear {
  kCountsAsRange,  ///< as much as the field's range or the value itself; minorities have no value then
  kHasNoValue,     ///< nothing: the element is one of those without a value
};

/// The same for displaced elements (D 3.6): the least over the element's own material's part of the mesh in
/// the box of that half-width round it. The box is searched from the inside outwards, until the errors of all
/// fields are within `limits`.
void measure_displaced_errors(const ResamplingSource& source, const CellView& cell,
                              std::span<const std::uint32_t> displaced, double half_width,
                              const CellsInBox& cells_in_box, std::span<const double> limits,
                              std::span<FieldError> errors, NoPartNear no_part = NoPartNear::kCountsAsRange);

}  // namespace adamas::interfaces
