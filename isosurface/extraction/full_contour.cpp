#include "isosurface/extraction/full_contour.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/parallel.h"

namespace adamas {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

bool in_file_order(LatticePoint a, LatticePoint b) {
  return std::array{a.k, a.j, a.i} < std::array{b.k, b.j, b.i};
}

}  // namespace

template <class Sample>
FullContour<Sample>::FullContour(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter,
                                 const SplitLimits& limits)
    : diamonds_(diamonds), isovalue_(isovalue), least_parameter_(least_parameter), limits_(limits) {
  find_blocks(diamonds_.grid().top(), {0, 0, 0});
  std::sort(blocks_.begin(), blocks_.end(), in_file_order);
}

template <class Sample>
bool FullContour<Sample>::is_wanted(int lod, LatticePoint block) const {
  const PageGrid& grid = diamonds_.grid();
  const LatticePoint count = grid.blocks(lod), last = grid.last();
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t begin = block[axis] * (kSide << lod), end = begin + (kSide << lod);
    if (block[axis] >= count[axis] || begin >= last[axis]) return false;
    // Triangles outside the region, as far as they have to do with those inside.
    constexpr double kMargin = 3;
    if (limits_.region &&
        (end < (*limits_.region)[0][axis] - kMargin || begin > (*limits_.region)[1][axis] + kMargin))
      return false;
  }
  return diamonds_.side({lod, block}) == StoredDiamonds<Sample>::Side::kBoth;
}

template <class Sample>
void FullContour<Sample>::find_blocks(int lod, LatticePoint block) {
  if (!is_wanted(lod, block)) return;
  if (lod == 0) {
    blocks_.push_back(block);
    return;
  }
  for (int child = 0; child < 8; ++child)
    find_blocks(lod - 1, 2 * block + LatticePoint{child & 1, child >> 1 & 1, child >> 2});
}

template <class Sample>
bool FullContour<Sample>::is_worthwhile() {
  if (diamonds_.grid().top() == 0) return false;
  const auto with_errors = std::count_if(blocks_.begin(), blocks_.end(), [this](LatticePoint block) {
    return diamonds_.greatest_class({0, block}) > 0;
  });
  return 2 * static_cast<std::size_t>(with_errors) > blocks_.size();
}

template <class Sample>
std::optional<Contour> FullContour<Sample>::run(Progress& progress) {
  // Slabs of pages are parts of their own, so that sums of numbers do not depend on threads.
  std::vector<std::size_t> slabs{0};
  for (std::size_t n = 1; n <= blocks_.size(); ++n) {
    if (n == blocks_.size() || blocks_[n].k != blocks_[n - 1].k) slabs.push_back(n);
  }
  const std::int32_t sample = diamonds_.lattice_step(0);
  const Domain& domain = diamonds_.domain();
  JoinedSurface surface(sample, {domain.box().min, domain.position(diamonds_.last_sample())});
  PageCells<Sample> cells(diamonds_, isovalue_, least_parameter_);
  SurfaceSlab slab;
  for (std::size_t s = 0; s + 1 < slabs.size(); ++s) {
    const std::int32_t first = kSide * blocks_[slabs[s]].k;
    slab.clear(first, first + kSide);
    for (std::size_t n = slabs[s]; n < slabs[s + 1]; ++n) {
      if (!cells.add(blocks_[n], slab)) return {};
    }
    slab.find_coinciding(sample);
    const double part = static_cast<double>(slabs[s + 1]) / static_cast<double>(blocks_.size());
    progress.step("extracting", part);
    surface.append(slab, part);
  }
  crossed_cells_ = surface.crossed_cells();
  take_apart(surface, cells, progress);
  Contour result = surface.finish();
  if (limits_.region) remove_unused_points(result);
  return result;
}

template <class Sample>
void FullContour<Sample>::take_apart(JoinedSurface& surface, PageCells<Sample>& cells, Progress& progress) {
  typename PageCells<Sample>::Apart apart;
  for (;;) {
    progress.step("extracting", 1);
    const std::vector<JoinedSurface::Patch> patches = surface.take_apart();
    if (patches.empty()) return;
    for (const JoinedSurface::Patch& patch : patches) *apart.insert(patch.vertex).first |= patch.points;
    const std::vector<CellOfPage> again = cells_round(patches);
    LatticeMap<bool> corners;
    for (const CellOfPage& c : again) {
      for (int n = 0; n < 8; ++n)
        corners.insert(kSide * c.block + c.cell + LatticePoint{n & 1, n >> 1 & 1, n >> 2});
    }
    SurfaceSlab more;
    more.shared = surface.numbers_near(corners);
    const auto first_new = static_cast<std::uint32_t>(surface.edge_points().size());
    std::vector<LatticePoint> of_page;
    for (std::size_t n = 0; n < again.size();) {
      const LatticePoint block = again[n].block;
      of_page.clear();
      for (; n < again.size() && again[n].block == block; ++n) of_page.push_back(again[n].cell);
      cells.add_again(block, of_page, apart, first_new, more);
    }
    surface.add(more);
  }
}

template <class Sample>
std::vector<typename FullContour<Sample>::CellOfPage> FullContour<Sample>::cells_round(
    const std::vector<JoinedSurface::Patch>& patches) const {
  const LatticePoint last = diamonds_.grid().last();
  std::vector<CellOfPage> found;
  for (const JoinedSurface::Patch& patch : patches) {
    for (int corner = 0; corner < 8; ++corner) {
      const LatticePoint c = patch.vertex - LatticePoint{corner & 1, corner >> 1 & 1, corner >> 2};
      if (std::min({c.i, c.j, c.k}) < 0 || c.i >= last.i || c.j >= last.j || c.k >= last.k) continue;
      const LatticePoint block{c.i / kSide, c.j / kSide, c.k / kSide};
      found.push_back({block, c - kSide * block});
    }
  }
  const auto before = [](const CellOfPage& a, const CellOfPage& b) {
    return a.block != b.block ? in_file_order(a.block, b.block) : in_file_order(a.cell, b.cell);
  };
  std::sort(found.begin(), found.end(), before);
  const auto same = [](const CellOfPage& a, const CellOfPage& b) {
    return a.block == b.block && a.cell == b.cell;
  };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

template class FullContour<std::uint8_t>;
template class FullContour<std::uint16_t>;
template class FullContour<std::int16_t>;
template class FullContour<float>;

}  // namespace adamas
