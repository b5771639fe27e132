#pragma once

#include <cstddef>
#include <cstdint>

#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/extraction/page_mask.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The samples at the members of a page's diamonds, which are the page's points and those one step round the
/// page. Points are in units of the page's LOD, and counted from the page's first one.
template <class Sample>
class PageDiamonds {
 public:
  using Word = typename StoredDiamonds<Sample>::Word;

  explicit PageDiamonds(StoredDiamonds<Sample>& diamonds) : diamonds_(diamonds) {}

  /// Copies the samples at the members of the diamonds of `split`. Throws PageLost.
  void load(int lod, LatticePoint block, const PageMask& split);

  /// Returns whether all diamonds of the page lie inside the data, and none of them on its border.
  [[nodiscard]] bool is_inside() const { return inside_; }
  /// Returns whether all samples of load() are finite.
  [[nodiscard]] bool all_finite() const { return finite_; }

  /// Returns a point in units of samples. in_lattice() returns it as a lattice point.
  [[nodiscard]] LatticePoint in_samples(LatticePoint q) const { return (1 << lod_) * (corner_ + q); }
  [[nodiscard]] LatticePoint in_lattice(LatticePoint q) const { return lattice_step_ * (corner_ + q); }
  [[nodiscard]] Diamond diamond(LatticePoint q) const { return Diamond(in_lattice(q)); }

  [[nodiscard]] double value(LatticePoint q) const {
    return static_cast<double>(from_ordered<Sample>(*words_.at(q)));
  }
  /// Returns the members of a diamond whose samples are not below the isovalue.
  [[nodiscard]] DiamondStencil::Members above(const DiamondStencil& stencil, LatticePoint q) const {
    const Word* at = words_.at(q);
    // With a constant number of members the compiler unrolls the loop.
    if (stencil.phase == 0) return above_of<DiamondStencil::kRing + 6>(stencil, at);
    if (stencil.phase == 1) return above_of<DiamondStencil::kRing + 4>(stencil, at);
    return above_of<DiamondStencil::kRing + 8>(stencil, at);
  }
  /// Returns the number of triangles that a contour has more once the diamond is split.
  [[nodiscard]] int triangles_added(const DiamondStencil& stencil, LatticePoint q) const {
    const DiamondStencil::Members members = above(stencil, q);
    const unsigned in_domain = slots(stencil, q);
    return in_domain == stencil.all_slots() ? stencil.added[members] : stencil.added_in(in_domain, members);
  }
  /// Returns the slots of a diamond's tetrahedra in the domain, as bits.
  [[nodiscard]] unsigned slots(const DiamondStencil& stencil, LatticePoint q) const {
    if (inside_ || diamonds_.domain().boundary_count(in_lattice(q)) == 0) return stencil.all_slots();
    unsigned found = 0;
    for (const int slot : diamond(q).tetrahedra(diamonds_.domain())) found |= 1u << slot;
    return found;
  }

 private:
  template <std::size_t Count>
  [[nodiscard]] DiamondStencil::Members above_of(const DiamondStencil& stencil, const Word* at) const {
    DiamondStencil::Members result = 0;
    for (std::size_t m = 0; m < Count; ++m)
      result |= DiamondStencil::Members{diamonds_.is_above(at[stencil.places[m]])} << m;
    return result;
  }
  /// Copies the points round the page from some of the pages round it, as bits, if they are in memory.
  void get_from_neighbours(std::uint32_t pages);
  /// Copies from the next coarser page the points of a neighbour, at a step from -1 to 1, that belong to
  /// coarser LODs. It is used for neighbours that are not in memory.
  void get_coarser(LatticePoint step);
  /// Returns the split diamonds that may have members on pages that are not in memory.
  [[nodiscard]] PageMask reaching_others(const PageMask& split) const;
  /// Copies these members of a diamond one by one.
  void get_others(LatticePoint q);
  [[nodiscard]] bool is_there(LatticePoint q) const;

  StoredDiamonds<Sample>& diamonds_;
  int lod_ = 0;
  LatticePoint block_{}, corner_{};
  std::int32_t lattice_step_ = 1;
  bool inside_ = false, finite_ = true;
  PaddedGrid<Word> words_;
  /// The pages round this one whose points were copied, as bits by page_around(); and the pages of which only
  /// the points of coarser LODs were copied.
  std::uint32_t known_ = 0, known_coarser_ = 0;
};

}  // namespace adamas::isosurface
