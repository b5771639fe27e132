#include "isosurface/extraction/full_contour.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <utility>

#include "core/base/parallel.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

bool in_file_order(LatticePoint a, LatticePoint b) {
  return std::array{a.k, a.j, a.i} < std::array{b.k, b.j, b.i};
}

}  // namespace

template <class Sample>
FullContour<Sample>::FullContour(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter,
                                 const SplitLimits& limits, std::size_t most_threads)
    : diamonds_(diamonds),
      isovalue_(isovalue),
      least_parameter_(least_parameter),
      limits_(limits),
      most_threads_(most_threads) {
  find_blocks(diamonds_.grid().top(), {0, 0, 0});
  std::sort(blocks_.begin(), blocks_.end(), in_file_order);
  find_slabs();
}

template <class Sample>
bool FullContour<Sample>::is_wanted(int lod, LatticePoint block) const {
  const PageGrid& grid = diamonds_.grid();
  const LatticePoint count = grid.blocks(lod), last = grid.last();
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t begin = block[axis] * (kSide << lod), end = begin + (kSide << lod);
    if (block[axis] >= count[axis] || begin >= last[axis]) return false;
    // The mesh outside the region is needed as far as triangles inside depend on it.
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
  for (unsigned child = 0; child < 8; ++child) find_blocks(lod - 1, 2 * block + corner_offset(child));
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
void FullContour<Sample>::find_slabs() {
  for (std::size_t n = 0; n < blocks_.size(); ++n) {
    if (n == 0 || blocks_[n].k != blocks_[n - 1].k) slabs_.push_back(n);
  }
  slabs_.push_back(blocks_.size());
}

template <class Sample>
void FullContour<Sample>::make_workers() {
  // Each thread also reads a slab on both sides of its own, and the first thread joins all slabs.
  constexpr std::size_t kLeastSlabs = 3;
  constexpr double kPartOfFirst = 0.9;
  const std::size_t slabs = slabs_.size() - 1;
  const std::size_t threads = std::clamp<std::size_t>(slabs / kLeastSlabs, 1, most_threads_);
  const double pages =
      static_cast<double>(blocks_.size()) / (static_cast<double>(threads) - 1 + kPartOfFirst);
  std::size_t first = 0;
  for (StoredPages<OrderedWord<Sample>>* of_thread : diamonds_.pages().for_threads(threads)) {
    workers_.push_back(std::make_unique<Worker>(*of_thread, isovalue_, least_parameter_));
    Worker& worker = *workers_.back();
    worker.first = first;
    const double part = static_cast<double>(workers_.size()) - 1 + kPartOfFirst;
    const auto next =
        std::lower_bound(slabs_.begin(), slabs_.end() - 1, static_cast<std::size_t>(pages * part));
    worker.last = workers_.size() == threads ? slabs : static_cast<std::size_t>(next - slabs_.begin());
    first = worker.last;
  }
}

template <class Sample>
std::optional<Contour> FullContour<Sample>::run(Progress& progress) {
  JoinedSurface surface(diamonds_.lattice_step(0), diamonds_.data_box());
  make_workers();
  const auto part = [this](std::size_t n) {
    return static_cast<double>(slabs_[n + 1]) / static_cast<double>(blocks_.size());
  };
  // The first thread appends its slabs immediately. Those of the others wait for the slabs before.
  std::vector<SurfaceSlab> waiting(slabs_.size() - 1);
  std::atomic<bool> is_finite = true;
  parallel_for(workers_.size(), 1, [&](std::size_t t) {
    Worker& worker = *workers_[t];
    SurfaceSlab reused;
    for (std::size_t n = worker.first; n < worker.last && is_finite; ++n) {
      SurfaceSlab& slab = t == 0 ? reused : waiting[n];
      if (!add_slab(n, worker, slab)) is_finite = false;
      if (t != 0) continue;
      surface.append(slab, part(n));
      progress.step("extracting", static_cast<double>(n + 1) / static_cast<double>(worker.last));
    }
  });
  if (!is_finite) return {};
  for (std::size_t n = workers_[0]->last; n < waiting.size(); ++n)
    surface.append(std::exchange(waiting[n], {}), part(n));
  crossed_cells_ = surface.crossed_cells();
  while (surface.has_suspects()) take_apart(surface, progress);
  Contour result = surface.finish();
  if (limits_.region) remove_unused_points(result);
  return result;
}

template <class Sample>
bool FullContour<Sample>::add_slab(std::size_t n, Worker& worker, SurfaceSlab& slab) const {
  const std::int32_t first = kSide * blocks_[slabs_[n]].k, sample = diamonds_.lattice_step(0);
  slab.clear(first, first + kSide);
  for (std::size_t block = slabs_[n]; block < slabs_[n + 1]; ++block) {
    if (!worker.cells.add(blocks_[block], slab)) return false;
  }
  const std::vector<PointsOfVertex> patches = slab.take_apart(sample, worker.coincidences);
  for (const PointsOfVertex& patch : patches) *worker.apart.insert(patch.vertex).first |= patch.points;
  const std::vector<CellOfPage> cells = cells_round(patches);
  slab.share(corners_of(cells), sample);
  const auto first_new = static_cast<std::uint32_t>(slab.edge_points.size());
  for_each_page(cells, [&](LatticePoint block, std::span<const LatticePoint> of_page) {
    worker.cells.add_again(block, of_page, worker.apart, first_new, slab);
  });
  return true;
}

template <class Sample>
void FullContour<Sample>::take_apart(JoinedSurface& surface, Progress& progress) {
  progress.step("extracting", 1);
  const auto worker_of = [this](std::int32_t k) -> Worker& {
    const auto has_slab = [&](const std::unique_ptr<Worker>& w) {
      return k <= blocks_[slabs_[w->last] - 1].k;
    };
    return **std::find_if(workers_.begin(), workers_.end() - 1, has_slab);
  };
  const std::vector<PointsOfVertex> patches = surface.take_apart(workers_[0]->coincidences);
  const std::vector<CellOfPage> cells = cells_round(patches);
  const LatticeMap<bool> corners = corners_of(cells);
  for (const PointsOfVertex& patch : patches) {
    // Threads share the patches next to a plane between them.
    for (const std::int32_t k : {patch.vertex.k - 1, patch.vertex.k})
      *worker_of(k / kSide).apart.insert(patch.vertex).first |= patch.points;
  }
  SurfaceSlab addition = surface.addition(corners);
  const std::uint32_t first_new = addition.first_edge;
  for_each_page(cells, [&](LatticePoint block, std::span<const LatticePoint> of_page) {
    Worker& worker = worker_of(block.k);
    worker.cells.add_again(block, of_page, worker.apart, first_new, addition);
  });
  surface.add(addition);
}

template <class Sample>
template <class Visit>
void FullContour<Sample>::for_each_page(const std::vector<CellOfPage>& cells, const Visit& visit) {
  std::vector<LatticePoint> of_page;
  for (std::size_t n = 0; n < cells.size();) {
    const LatticePoint block = cells[n].block;
    of_page.clear();
    for (; n < cells.size() && cells[n].block == block; ++n) of_page.push_back(cells[n].cell);
    visit(block, std::span<const LatticePoint>(of_page));
  }
}

template <class Sample>
LatticeMap<bool> FullContour<Sample>::corners_of(const std::vector<CellOfPage>& cells) {
  LatticeMap<bool> corners;
  for (const CellOfPage& c : cells) {
    for (unsigned n = 0; n < 8; ++n) corners.insert(kSide * c.block + c.cell + corner_offset(n));
  }
  return corners;
}

template <class Sample>
std::vector<typename FullContour<Sample>::CellOfPage> FullContour<Sample>::cells_round(
    const std::vector<PointsOfVertex>& patches) const {
  const LatticePoint last = diamonds_.grid().last();
  std::vector<CellOfPage> found;
  for (const PointsOfVertex& patch : patches) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      const LatticePoint c = patch.vertex - corner_offset(corner);
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

}  // namespace adamas::isosurface
