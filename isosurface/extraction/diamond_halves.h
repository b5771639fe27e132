#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/diamond_type.h"

namespace adamas {

/// One of the two tetrahedra into which a split bisects a tetrahedron.
struct TetrahedronHalf {
  std::uint8_t child;  ///< the child diamond it belongs to
  std::uint8_t slot;   ///< there
  /// Its vertices: 0 to 3 are those of the tetrahedron that is bisected, 4 the split vertex.
  std::array<std::uint8_t, 4> vertices;
};

/// What DiamondType::child_tetrahedra says, by the tetrahedron that is bisected.
class DiamondHalves {
 public:
  /// `end`: 0 for the half with the beginning of the split edge, 1 for that with its end.
  static const TetrahedronHalf& of(int type, int slot, int end) {
    static const DiamondHalves all;
    return all.halves_[static_cast<std::size_t>(type)][static_cast<std::size_t>(slot)]
                      [static_cast<std::size_t>(end)];
  }

 private:
  DiamondHalves() {
    for (std::size_t t = 0; t < kDiamondTypes.size(); ++t) {
      const DiamondType& type = kDiamondTypes[t];
      for (std::uint8_t child = 0; child < type.child_count; ++child) {
        for (const DiamondType::ChildTetrahedron& half : type.child_tetrahedra[child])
          halves_[t][half.slot][half.end] = {child, half.child_slot, half.vertices};
      }
    }
  }

  std::array<std::array<std::array<TetrahedronHalf, 2>, 8>, kDiamondTypeCount> halves_{};
};

}  // namespace adamas
