#include "tests/support/indexed_hierarchy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "core/base/error.h"
#include "core/lattice/forced_split.h"
#include "tests/support/mesh_laws.h"

namespace adamas::test {

namespace {

/// Returns the slots of those of the diamond's tetrahedra that lie in the domain.
std::uint8_t slots_in(const Diamond& diamond, const Domain& domain) {
  unsigned bits = 0;
  for (const int slot : diamond.tetrahedra(domain)) bits |= 1u << slot;
  return static_cast<std::uint8_t>(bits);
}

/// Returns the slots of the tetrahedra of child `c` that come from splitting a diamond with these tetrahedra.
std::uint8_t halves(const DiamondType& type, int c, std::uint8_t tetrahedra) {
  unsigned bits = 0;
  for (const DiamondType::ChildTetrahedron& half : type.child_tetrahedra[static_cast<std::size_t>(c)])
    bits |= (tetrahedra >> half.slot & 1u) << half.child_slot;
  return static_cast<std::uint8_t>(bits);
}

}  // namespace

IndexedHierarchy::IndexedHierarchy(const Domain& domain, int levels)
    : domain_(domain), levels_(levels), shift_(kRootBits - 1 - levels) {
  const auto roots = domain.roots();
  const int bits = std::bit_width(static_cast<unsigned>(std::max({roots[0], roots[1], roots[2]})));
  if (levels < 0 || levels > domain.depth() || levels + 1 + bits > PackedPoint::kBits)
    fail("hierarchy: expected from 0 to {} levels, found {}",
         std::min(domain.depth(), PackedPoint::kBits - 1 - bits), levels);
  const std::int32_t side = std::int32_t{1} << kRootBits;
  for (int k = 0; k < roots[2]; ++k) {
    for (int j = 0; j < roots[1]; ++j) {
      for (int i = 0; i < roots[0]; ++i) {
        const LatticePoint centre{side * i + side / 2, side * j + side / 2, side * k + side / 2};
        diamonds_.insert(key(centre)).first->tetrahedra = slots_in(Diamond(centre), domain_);
        tetrahedron_count_ += 6;
      }
    }
  }
}

/// Prefetches the diamonds that a split or a merge looks at, which are scattered over memory.
void IndexedHierarchy::prefetch(LatticePoint p) const {
  const Diamond diamond(p);
  for (int c = 0; c < diamond.parent_count(); ++c) diamonds_.prefetch(key(diamond.parent(c)));
  for (int c = 0; c < diamond.child_count(); ++c) diamonds_.prefetch(key(diamond.child(c)));
}

void IndexedHierarchy::split(LatticePoint p, std::vector<LatticePoint>& done) {
  if (!can_split(p)) return;
  prefetch(p);
  forced_split(*this, p, [&](LatticePoint q) {
    split_complete(q);
    done.push_back(q);
  });
}

void IndexedHierarchy::split_complete(LatticePoint p) {
  const Diamond diamond(p);
  const DiamondType& type = diamond.type();
  State& state = *diamonds_.find(key(p));
  const std::uint8_t tetrahedra = state.tetrahedra;
  ADAMAS_ASSERT(std::popcount(tetrahedra) == diamond.tetrahedron_count(domain_));
  state.tetrahedra = 0;
  state.split = true;
  tetrahedron_count_ += static_cast<std::size_t>(std::popcount(tetrahedra));
  for (int c = 0; c < type.child_count; ++c) {
    const std::uint8_t made = halves(type, c, tetrahedra);
    if (made != 0) diamonds_.insert(key(diamond.child(c))).first->tetrahedra |= made;
  }
  for (const LatticePoint parent : diamond.parents(domain_)) ++diamonds_.find(key(parent))->split_children;
}

bool IndexedHierarchy::merge(LatticePoint p) {
  if (!can_merge(p)) return false;
  prefetch(p);
  const Diamond diamond(p);
  const DiamondType& type = diamond.type();
  const std::uint8_t tetrahedra = slots_in(diamond, domain_);
  for (int c = 0; c < type.child_count; ++c) {
    const std::uint8_t made = halves(type, c, tetrahedra);
    if (made == 0) continue;
    const PackedPoint child = key(diamond.child(c));
    State& state = *diamonds_.find(child);
    state.tetrahedra = static_cast<std::uint8_t>(state.tetrahedra & ~made);
    if (state.tetrahedra == 0) diamonds_.erase(child);
  }
  State& state = *diamonds_.find(key(p));
  state.tetrahedra = tetrahedra;
  state.split = false;
  tetrahedron_count_ -= static_cast<std::size_t>(std::popcount(tetrahedra));
  for (const LatticePoint parent : diamond.parents(domain_)) --diamonds_.find(key(parent))->split_children;
  return true;
}

void IndexedHierarchy::validate_diamond(LatticePoint p, const State& state) const {
  const auto require = [p](bool law, const char* name) {
    if (!law) throw std::logic_error(fmt::format("diamond ({}, {}, {}): {}", p.i, p.j, p.k, name));
  };
  require(domain_.contains(p) && !is_root_corner(domain_, p), "no diamond's point");
  const Diamond diamond(p);
  const unsigned whole = slots_in(diamond, domain_);
  unsigned expected = 0;
  const auto parents = diamond.parents(domain_);
  bool complete = true;
  for (const LatticePoint parent : parents) {
    if (!is_split(parent)) {
      complete = false;
      continue;
    }
    const Diamond up(parent);
    const std::uint8_t there = slots_in(up, domain_);
    for (int c = 0; c < up.child_count(); ++c) {
      if (up.child(c) == p) expected |= halves(up.type(), c, there);
    }
  }
  if (parents.empty()) expected = whole;
  require(complete == (expected == whole), "not as complete as its parents");
  if (state.split) {
    require(complete, "split before its parents");
    require(state.tetrahedra == 0, "split, but with tetrahedra in the mesh");
    require(can_split(p), "split beyond the last level");
  } else {
    require(expected != 0, "kept for nothing");
    require(state.tetrahedra == expected, "without a tetrahedron that a parent gave it");
  }
  int split_children = 0;
  for (const LatticePoint child : diamond.children(domain_))
    split_children += can_split(child) && is_split(child) ? 1 : 0;
  require(state.split_children == split_children, "with a wrong number of split children");
}

void IndexedHierarchy::validate() const {
  diamonds_.for_each(
      [this](PackedPoint packed, const State& state) { validate_diamond(unpack(packed, shift_), state); });
  std::size_t count = 0;
  MeshLaws laws(domain_, [this](LatticePoint p) { return trailing_zeros(p) >= shift_ && is_split(p); });
  for_each_tetrahedron([&](const Diamond& diamond, int slot) {
    laws.add(diamond, diamond.tetrahedron(slot));
    ++count;
  });
  laws.check_volume();
  if (count != tetrahedron_count_)
    throw std::logic_error(
        fmt::format("hierarchy: {} tetrahedra, but {} counted", count, tetrahedron_count_));
}

std::uint64_t IndexedHierarchy::checksum() const {
  std::uint64_t sum = tetrahedron_count_;
  for_each_tetrahedron(
      [&sum](const Diamond& diamond, int slot) { sum += tetrahedron_checksum(diamond.tetrahedron(slot)); });
  return sum;
}

}  // namespace adamas::test
