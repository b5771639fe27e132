#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "interfaces/fields/ghost_values.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/ownership/cell_ownership.h"

namespace adamas::interfaces {

/// The error of one field at one native data element.
struct ElementError {
  double error;
  std::uint32_t element;
  ElementKind kind;
  bool displaced;  ///< whether the mesh gives its place to another material
  bool reducible;  ///< whether sufficiently small cells approximate the value within any error
};

/// The errors of one field at the native data elements of a cell.
struct FieldError {
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  double max = 0;
  double reducible = 0;  ///< the greatest of the errors that smaller cells reduce
  double sum = 0;
  std::array<std::uint32_t, kElementKinds> counts{};  ///< the numbers of elements that count, by kind
  std::uint32_t displaced = 0;                        ///< the number of counted elements that are displaced
  /// The number of elements that do not count: they have no value in the input, or are minorities of which
  /// the mesh has no part nearby.
  std::uint32_t without_value = 0;
  std::uint32_t worst = kNowhere;  ///< a native element with the greatest error, if that is not 0

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
  /// Returns the number of elements that count.
  [[nodiscard]] std::size_t count() const { return std::size_t{counts[0]} + counts[1] + counts[2]; }
  /// Returns the mean error; 0 without elements.
  [[nodiscard]] double mean() const { return count() > 0 ? sum / static_cast<double>(count()) : 0; }
};

/// The errors of one field at all native elements, and at the elements in cells with an interface.
struct FieldFigures {
  FieldError all, at_interfaces;
};

/// A cell with the data for the evaluation of fields in it.
struct CellView {
  Tetrahedron frame;
  CellOwnership owners;  ///< this has only the candidates that own a part of the cell
  std::array<const VertexRecord*, 4> vertices;
  std::vector<OwnedTetrahedron> parts;  ///< the cell divided by owner
};
/// A function that calls another one for every cell that may meet a box and hold a material. The views stay
/// valid.
using CellsInBox = std::function<void(const Box3&, MaterialId, const std::function<void(const CellView&)>&)>;

/// A cache of views of cells. The thread that needs a view first makes it.
class ViewCache {
 public:
  explicit ViewCache(std::size_t cells) : views_(cells) {}
  ~ViewCache() {
    for (const auto& view : views_) delete view.load();
  }
  ViewCache(const ViewCache&) = delete;
  ViewCache& operator=(const ViewCache&) = delete;

  template <class Make>
  const CellView& get(std::size_t cell, Make&& make) {
    std::atomic<const CellView*>& slot = views_[cell];
    if (const CellView* found = slot.load(std::memory_order_acquire)) return *found;
    auto fresh = std::make_unique<const CellView>(make());
    const CellView* expected = nullptr;
    if (slot.compare_exchange_strong(expected, fresh.get())) return *fresh.release();
    return *expected;
  }

 private:
  std::vector<std::atomic<const CellView*>> views_;
};

/// Adds the errors of each field at the native elements of a cell: the difference between the input and the
/// linear approximation for the element's own material (docs/method.md, Errors), for vectors its length.
/// Leaves out and returns the displaced elements, whose place the mesh gives to another material.
std::vector<std::uint32_t> measure_field_errors(const ResamplingSource& source, const CellView& cell,
                                                std::span<const std::uint32_t> elements,
                                                std::span<FieldError> errors);

/// How an element counts if the mesh has no part of its material nearby.
enum class NoPartNear {
  kCountsAsRange,  ///< its error is the field's range or the value itself; minorities count as without a
                   ///< value
  kHasNoValue,     ///< it counts as an element without a value
};

/// Adds the errors at displaced elements (D 3.6): the least error over the part of the mesh that has the
/// element's own material and lies in the box with this half-width round the element. The box is searched
/// from the inside outwards, until the errors of all fields are within `limits`.
void measure_displaced_errors(const ResamplingSource& source, const CellView& cell,
                              std::span<const std::uint32_t> displaced, double half_width,
                              const CellsInBox& cells_in_box, std::span<const double> limits,
                              std::span<FieldError> errors, NoPartNear no_part = NoPartNear::kCountsAsRange);

}  // namespace adamas::interfaces
