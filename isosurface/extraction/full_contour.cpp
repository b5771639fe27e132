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
  const Domain& domain = diamonds_.domain();
  const std::int32_t sample = diamonds_.lattice_step(0);
  JoinedSurface surface(sample, {domain.box().min, domain.position(diamonds_.last_sample())});
  PageCells<Sample> cells(diamonds_, isovalue_, least_parameter_);
  Apart apart;
  SurfaceSlab slab;
  for (std::size_t n = 0; n < blocks_.size();) {
    std::vector<LatticePoint> blocks;
    for (const std::int32_t k = blocks_[n].k; n < blocks_.size() && blocks_[n].k == k; ++n)
      blocks.push_back(blocks_[n]);
    if (!add_slab(blocks, cells, slab, apart)) return {};
    const double part = static_cast<double>(n) / static_cast<double>(blocks_.size());
    progress.step("extracting", part);
    surface.append(slab, part);
  }
  crossed_cells_ = surface.crossed_cells();
  take_apart(surface, cells, apart, progress);
  Contour result = surface.finish();
  if (limits_.region) remove_unused_points(result);
  return result;
}

template <class Sample>
bool FullContour<Sample>::add_slab(const std::vector<LatticePoint>& blocks, PageCells<Sample>& cells,
                                   SurfaceSlab& slab, Apart& apart) {
  const std::int32_t first = kSide * blocks.front().k, sample = diamonds_.lattice_step(0);
  slab.clear(first, first + kSide);
  for (const LatticePoint block : blocks) {
    if (!cells.add(block, slab)) return false;
  }
  const std::vector<PointsOfVertex> patches = slab.take_apart(sample);
  for (const PointsOfVertex& patch : patches) *apart.insert(patch.vertex).first |= patch.points;
  const std::vector<CellOfPage> again = cells_round(patches);
  slab.share(corners_of(again), sample);
  add_again(again, cells, apart, slab);
  return true;
}

template <class Sample>
void FullContour<Sample>::take_apart(JoinedSurface& surface, PageCells<Sample>& cells, Apart& apart,
                                     Progress& progress) {
  while (surface.has_suspects()) {
    progress.step("extracting", 1);
    const std::vector<PointsOfVertex> patches = surface.take_apart();
    for (const PointsOfVertex& patch : patches) *apart.insert(patch.vertex).first |= patch.points;
    const std::vector<CellOfPage> again = cells_round(patches);
    SurfaceSlab addition = surface.addition(corners_of(again));
    add_again(again, cells, apart, addition);
    surface.add(addition);
  }
}

template <class Sample>
void FullContour<Sample>::add_again(const std::vector<CellOfPage>& cells, PageCells<Sample>& of_pages,
                                    const Apart& apart, SurfaceSlab& slab) {
  const auto first_new = static_cast<std::uint32_t>(slab.first_edge + slab.edge_points.size());
  std::vector<LatticePoint> of_page;
  for (std::size_t n = 0; n < cells.size();) {
    const LatticePoint block = cells[n].block;
    of_page.clear();
    for (; n < cells.size() && cells[n].block == block; ++n) of_page.push_back(cells[n].cell);
    of_pages.add_again(block, of_page, apart, first_new, slab);
  }
}

template <class Sample>
LatticeMap<bool> FullContour<Sample>::corners_of(const std::vector<CellOfPage>& cells) {
  LatticeMap<bool> corners;
  for (const CellOfPage& c : cells) {
    for (int n = 0; n < 8; ++n)
      corners.insert(kSide * c.block + c.cell + LatticePoint{n & 1, n >> 1 & 1, n >> 2});
  }
  return corners;
}

template <class Sample>
std::vector<typename FullContour<Sample>::CellOfPage> FullContour<Sample>::cells_round(
    const std::vector<PointsOfVertex>& patches) const {
  const LatticePoint last = diamonds_.grid().last();
  std::vector<CellOfPage> found;
  for (const PointsOfVertex& patch : patches) {
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
