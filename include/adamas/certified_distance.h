#pragma once

#include <cstddef>
#include <optional>

#include "adamas/export.h"
#include "adamas/geometry.h"

namespace adamas ADAMAS_API {

/// The measured two-sided distance between two sets of interfaces; it is infinite where only one of them is
/// empty.
struct CertifiedDistance {
  /// Upper bound: no point of either set is farther from the other, in units of length.
  double certified = 0;
  double found = 0;  ///< lower bound: the distance that is attained at `place`
  Vec3 place;        ///< numbers that are not finite where it is not known, as of a hierarchy from a file
};

/// The distances between two networks of interfaces of the same materials.
struct InterfaceDistances {
  CertifiedDistance interfaces;    ///< of all interfaces together
  CertifiedDistance per_material;  ///< the greatest of the materials' boundaries
  std::size_t worst_material = 0;  ///< the number of the material with that boundary
  /// The distance of the lines where three materials or more meet; none where there are no such lines, or
  /// where they are not known because interfaces are open.
  std::optional<CertifiedDistance> junctions;
};

}  // namespace adamas
