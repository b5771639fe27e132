#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/fields/ghost_values.h"
#include "interfaces/ownership/cell_ownership.h"
#include "interfaces/source.h"

namespace adamas {

/// Errors of one field at the native data elements of a cell.
struct FieldError {
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  double max = 0;
  double sum = 0;
  std::size_t count = 0;
  std::uint32_t worst = kNowhere;  ///< a native element with the greatest error, where that is not 0

  void add(double error, std::uint32_t element) {
    if (error > max) max = error, worst = element;
    sum += error;
    ++count;
  }
  void add(const FieldError& other) {
    if (other.max > max) max = other.max, worst = other.worst;
    sum += other.sum;
    count += other.count;
  }
  /// 0 without elements.
  [[nodiscard]] double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
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

/// The same for displaced elements (D 3.6): the least over the element's own material's part of the mesh in
/// the box of that half-width round it. The box is searched from the inside outwards, until the errors of
/// all fields are within `limits`.
void measure_displaced_errors(const ResamplingSource& source, const CellView& cell,
                              std::span<const std::uint32_t> displaced, double half_width,
                              const CellsInBox& cells_in_box, std::span<const double> limits,
                              std::span<FieldError> errors);

}  // namespace adamas
