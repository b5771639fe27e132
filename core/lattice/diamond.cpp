#include "core/lattice/diamond.h"

#include "core/lattice/domain.h"

namespace adamas::inline core {

int Diamond::tetrahedron_count(const Domain& domain) const {
  return type().tetrahedron_count >> domain.boundary_count(point_);
}

SmallList<int, 8> Diamond::tetrahedra(const Domain& domain) const {
  SmallList<int, 8> slots;
  const int count = type().tetrahedron_count;
  for (int slot = 0; slot < count; ++slot) {
    if (domain.contains(ring(slot)) && domain.contains(ring((slot + 1) % count))) slots.push_back(slot);
  }
  return slots;
}

SmallList<LatticePoint, 8> Diamond::children(const Domain& domain) const {
  SmallList<LatticePoint, 8> result;
  if (bits_ == 0 && phase() == 2) return result;
  for (int c = 0; c < child_count(); ++c) {
    if (domain.contains(child(c))) result.push_back(child(c));
  }
  return result;
}

SmallList<LatticePoint, 4> Diamond::parents(const Domain& domain) const {
  SmallList<LatticePoint, 4> result;
  for (int c = 0; c < parent_count(); ++c) {
    if (domain.contains(parent(c))) result.push_back(parent(c));
  }
  return result;
}

}  // namespace adamas::inline core
