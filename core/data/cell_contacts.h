#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/data/contact_buffer.h"
#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// The contact polygons of one tetrahedron in little memory: each point and line once, without the digests of
/// their features. A polygon that two functions make alone takes some 70 bytes.
class CellContacts {
 public:
  /// No polygons.
  CellContacts() = default;
  /// The polygons that contact_polygons() has found for this problem, which keep_owners() has reduced.
  /// `vertex_ids` are those of ContactBuffer::add().
  CellContacts(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
               const OwnershipProblem& problem, const std::vector<ContactPolygon>& contacts);
  CellContacts(const CellContacts& other);
  CellContacts(CellContacts&&) noexcept = default;
  CellContacts& operator=(CellContacts other) noexcept {
    block_ = std::move(other.block_);
    return *this;
  }
  ~CellContacts() = default;

  [[nodiscard]] bool empty() const { return block_ == nullptr; }
  [[nodiscard]] std::size_t polygon_count() const;
  [[nodiscard]] std::size_t corner_count() const;
  /// Adds the polygons to a buffer. The vertices are those of the constructor.
  void add_to(ContactBuffer& buffer, const std::array<std::uint64_t, 4>& vertex_ids,
              const std::array<Vec3, 4>& positions) const;
  /// Returns whether both have the same polygons, wherever their corners are. They must be of one
  /// tetrahedron.
  [[nodiscard]] bool has_polygons_of(const CellContacts& other) const;

 private:
  std::unique_ptr<std::byte[]> block_;  ///< a head and arrays; null if there are no polygons
};

}  // namespace adamas::inline core
