#include "isosurface/extraction/lattice_samples.h"

#include <bit>

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

Domain domain_of(const VolumeGrid& volume, int depth) {
  const double side = static_cast<double>(std::int32_t{1} << depth);
  return {Box3{volume.origin, volume.origin + side * volume.spacing}, {1, 1, 1}};
}

/// Three consecutive places along an axis that begin on one page and may end on the next one.
struct ThreePlaces {
  /// Places on their pages, where neighbours along the axis are `stride` apart.
  std::array<std::size_t, 3> offsets;
  std::int32_t in_first;  ///< number of them on the first page

  ThreePlaces(std::int32_t first, std::size_t stride) : in_first(std::min(3, kSide - first % kSide)) {
    for (std::int32_t n = 0; n < 3; ++n)
      offsets[static_cast<std::size_t>(n)] = stride * static_cast<std::size_t>((first + n) % kSide);
  }
  [[nodiscard]] std::size_t is_second(std::int32_t n) const { return n >= in_first ? 1 : 0; }
};

}  // namespace

template <class Sample>
LatticeSamples<Sample>::LatticeSamples(StoredPages<Word>& pages)
    : pages_(&pages),
      grid_(pages.grid()),
      shift_(kRootBits - grid_.depth()),
      domain_(domain_of(pages.file().header().grid, grid_.depth())) {
  for (int lod = 0; lod < static_cast<int>(ends_.size()); ++lod)
    ends_[static_cast<std::size_t>(lod)] =
        (1 << std::min(lod, grid_.top())) * grid_.extent(std::min(lod, grid_.top()));
}

template <class Sample>
typename LatticeSamples<Sample>::Word LatticeSamples<Sample>::word_in_memory(LatticePoint at,
                                                                             const PageId& own) {
  // Pages have the points of coarser LODs too. Points beyond an LOD's last ones have the samples of these.
  for (int lod = own.lod; lod >= 0; --lod) {
    const LatticePoint end = grid_.extent(lod);
    LatticePoint u{at.i >> lod, at.j >> lod, at.k >> lod};
    for (int axis = 0; axis < 3; ++axis) u[axis] = std::min(u[axis], end[axis]);
    const PageSamples<Word>* const page = pages_->held({lod, {u.i / kSide, u.j / kSide, u.k / kSide}});
    if (page != nullptr) return page->samples[PageGrid::place(u, 0)];
  }
  throw PageLost{own, own};
}

template <class Sample>
bool LatticeSamples<Sample>::samples_round(LatticePoint p, std::int32_t step, Block& samples) {
  const int lod = std::countr_zero(static_cast<std::uint32_t>(step)) - shift_;
  if (lod < 0 || lod > grid_.top()) return false;
  const LatticePoint at = in_samples(p), last = grid_.last();
  const LatticePoint first{(at.i >> lod) - 1, (at.j >> lod) - 1, (at.k >> lod) - 1};
  for (int axis = 0; axis < 3; ++axis) {
    if (first[axis] < 0 || first[axis] + 2 > last[axis] >> lod) return false;
  }
  const PageId id{lod, {first.i / kSide, first.j / kSide, first.k / kSide}};
  const bool is_on_one_page = std::max({first.i % kSide, first.j % kSide, first.k % kSide}) <= kSide - 3;
  return is_on_one_page ? block_of_page(id, first, samples) : block_of_pages(id, first, samples);
}

/// Copies the block that begins at a point, in units of the LOD of the page that contains the block.
template <class Sample>
bool LatticeSamples<Sample>::block_of_page(const PageId& id, LatticePoint first, Block& samples) {
  const PageSamples<Word>* page = pages_->held(id);
  if (page == nullptr) return false;
  const Word* from = page->samples.data() + PageGrid::place(first, 0);
  Word* to = samples.data();
  for (int k = 0; k < 3; ++k, from += kSide * kSide - 3 * kSide) {
    for (int j = 0; j < 3; ++j, from += kSide, to += 3) to[0] = from[0], to[1] = from[1], to[2] = from[2];
  }
  return true;
}

/// Copies the samples of a block that begins on a page and ends on the next one along at least one axis.
template <class Sample>
bool LatticeSamples<Sample>::block_of_pages(const PageId& id, LatticePoint first, Block& samples) {
  const ThreePlaces x(first.i, 1), y(first.j, kSide), z(first.k, std::size_t{kSide} * kSide);
  // The pages are indexed by three bits: whether places lie on the second page along each axis.
  std::array<const Word*, 8> pages;
  const LatticePoint reach{x.in_first < 3 ? 1 : 0, y.in_first < 3 ? 1 : 0, z.in_first < 3 ? 1 : 0};
  for (std::int32_t second = 0; second < 8; ++second) {
    const LatticePoint step{second & 1, second >> 1 & 1, second >> 2};
    if (step.i > reach.i || step.j > reach.j || step.k > reach.k) continue;
    const PageSamples<Word>* from = pages_->held({id.lod, id.block + step});
    if (from == nullptr) return false;
    pages[static_cast<std::size_t>(second)] = from->samples.data();
  }
  std::size_t n = 0;
  for (std::int32_t k = 0; k < 3; ++k) {
    for (std::int32_t j = 0; j < 3; ++j) {
      const std::size_t row = y.offsets[static_cast<std::size_t>(j)] + z.offsets[static_cast<std::size_t>(k)];
      const std::size_t second = 2 * y.is_second(j) + 4 * z.is_second(k);
      for (std::int32_t i = 0; i < 3; ++i)
        samples[n++] = pages[second + x.is_second(i)][row + x.offsets[static_cast<std::size_t>(i)]];
    }
  }
  return true;
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(LatticeSamples);

}  // namespace adamas::isosurface
