#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/fields/ghost_values.h"
#include "interfaces/ownership/cell_ownership.h"
#include "interfaces/source.h"

namespace adamas {

/// Errors of one field at the native data elements of a cell.
struct FieldError {
  double max = 0;
  double sum = 0;
  std::size_t count = 0;

  void add(double error) {
    max = std::max(max, error);
    sum += error;
    ++count;
  }
  void add(const FieldError& other) {
    max = std::max(max, other.max);
    sum += other.sum;
    count += other.count;
  }
};

/// Difference between the input and the cell's linear approximation of each field at the native elements in
/// the cell (SPEC 2.5, D 3.6): of the element's own material; where the cell gives the element's place to
/// another material, the least over its own material's part of the cell in the box of half-width `warp` round
/// it. Vectors by length.
void measure_field_errors(const ResamplingSource& source, const Tetrahedron& cell,
                          const CellOwnership& ownership, const std::array<const VertexRecord*, 4>& vertices,
                          std::span<const std::uint32_t> elements, double warp, std::span<FieldError> errors);

}  // namespace adamas
