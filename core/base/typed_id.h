#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/assert.h"

namespace adamas::inline core {

/// A 32-bit index whose type says what it counts. There is no conversion between ids of different tags.
template <class Tag>
struct TypedId {
  static constexpr std::uint32_t kInvalidValue = 0xffffffffu;
  std::uint32_t value = kInvalidValue;

  constexpr TypedId() = default;
  constexpr explicit TypedId(std::size_t v) : value(static_cast<std::uint32_t>(v)) {
    ADAMAS_ASSERT(v <= kInvalidValue);
  }
  [[nodiscard]] constexpr bool valid() const { return value != kInvalidValue; }
  constexpr auto operator<=>(const TypedId&) const = default;
};

/// Vertex of a tetrahedral mesh.
using VertexId = TypedId<struct VertexTag>;
using TetrahedronId = TypedId<struct TetrahedronTag>;
using DiamondId = TypedId<struct DiamondTag>;
/// A material, as the user names them.
using MaterialId = TypedId<struct MaterialTag>;
/// A connected part of a material's region.
using BodyId = TypedId<struct BodyTag>;
/// An interface between two bodies.
using InterfaceId = TypedId<struct InterfaceTag>;

/// A vector indexed by one kind of id.
template <class Id, class T>
class IdVector : public std::vector<T> {
 public:
  using std::vector<T>::vector;
  using typename std::vector<T>::reference;
  using typename std::vector<T>::const_reference;
  reference operator[](Id id) { return std::vector<T>::operator[](id.value); }
  const_reference operator[](Id id) const { return std::vector<T>::operator[](id.value); }
  /// The id that the next push_back will get.
  [[nodiscard]] Id next_id() const { return Id(this->size()); }
};

}  // namespace adamas::inline core
