#include "isosurface/view/chunk_maker.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "core/base/parallel.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;
static_assert(DiamondStencil::kEdgePlaces <= 0xffff);

LatticePoint first_of_cell(unsigned cell) {
  const auto c = static_cast<std::int32_t>(cell);
  return PageChunk::kCellSide * LatticePoint{c % 4, c / 4 % 4, c / 16};
}

/// Returns the diamonds of a mask that lie in some cells.
PageMask in_cells(const PageMask& mask, std::uint64_t cells) {
  PageMask found;
  for (; cells != 0; cells &= cells - 1) {
    const LatticePoint first = first_of_cell(static_cast<unsigned>(std::countr_zero(cells)));
    for (std::int32_t n = 0; n < PageChunk::kCellSide * PageChunk::kCellSide; ++n) {
      const auto row = static_cast<std::size_t>(first.j + n % 4 + kSide * (first.k + n / 4));
      found.rows[row] = static_cast<std::uint16_t>(found.rows[row] | (mask.rows[row] & 0xfu << first.i));
    }
  }
  return found;
}

}  // namespace

template <class Sample>
ChunkMaker<Sample>::ChunkMaker(const ChunkSource<Sample>& source, SharedPool<PageChunk>& free,
                               StoredGradients* gradients)
    : source_(source),
      diamonds_(source.diamonds),
      surface_(source.surface),
      mesh_(diamonds_, source.split_of),
      normals_(diamonds_.pages(), gradients),
      free_(free),
      numbers_(std::size_t{DiamondStencil::kEdgePlaces}) {}

template <class Sample>
EdgePoint ChunkMaker<Sample>::edge_point(const PageChunk& chunk, const PageChunk::Part& part,
                                         std::size_t n) const {
  const auto [first, second] = DiamondStencil::ends_of_edge(part.edges[n]);
  const double parameter = part.parameters.empty()
                               ? chunk.shown.ends[n].parameter(surface_.isovalue, surface_.least_parameter)
                               : part.parameters[n];
  return {in_lattice(chunk, first), in_lattice(chunk, second), parameter};
}

template <class Sample>
std::unique_ptr<PageChunk> ChunkMaker<Sample>::empty_chunk(int lod, LatticePoint block) {
  std::unique_ptr<PageChunk> chunk = free_.take();
  if (chunk == nullptr) chunk = std::make_unique<PageChunk>();
  chunk->lod = lod;
  chunk->block = block;
  for (PageChunk::Part* part : {&chunk->inside, &chunk->border}) {
    part->triangles.clear();
    part->edges.clear();
    part->parameters.clear();
  }
  chunk->shown.points.clear();
  chunk->shown.normals.clear();
  chunk->shown.triangles.clear();
  chunk->shown.ends.clear();
  return chunk;
}

template <class Sample>
std::unique_ptr<PageChunk> ChunkMaker<Sample>::make(int lod, LatticePoint block, const PageChunk* before,
                                                    std::uint64_t cells) {
  std::unique_ptr<PageChunk> chunk = empty_chunk(lod, block);
  chunk->split = *source_.split_of(lod, block);
  if (before == nullptr) cells = ~std::uint64_t{0};
  mesh_.load(lod, block, before == nullptr ? chunk->split : in_cells(chunk->split, cells));
  add_cells(before, cells, *chunk);
  const auto first_cell = before == nullptr ? 0u : static_cast<unsigned>(std::countr_zero(cells));
  show(before, first_cell, *chunk);
  const PageChunk::Part* const border = before == nullptr ? nullptr : &before->border;
  const std::size_t same =
      number(border, first_cell, chunk->border, [](std::size_t, const std::array<std::uint32_t, 3>&) {});
  take_over(border == nullptr ? nullptr : &border->parameters, same, chunk->border.parameters,
            [&](std::size_t n) { return parameter(chunk->border.edges[n]); });
  chunk->missing = normals_.take_missing();
  return chunk;
}

template <class Sample>
void ChunkMaker<Sample>::add_cells(const PageChunk* before, std::uint64_t cells, PageChunk& chunk) {
  const auto copy = [](const PageChunk::Part& from, unsigned first, unsigned end, PageChunk::Part& to) {
    const auto shift = static_cast<std::uint32_t>(to.triangles.size()) - from.begins[first];
    to.triangles.insert(to.triangles.end(), from.triangles.begin() + from.begins[first],
                        from.triangles.begin() + from.begins[end]);
    for (unsigned cell = first; cell < end; ++cell) to.begins[cell] = from.begins[cell] + shift;
  };
  const auto begin_of = [](PageChunk::Part& part) {
    return static_cast<std::uint32_t>(part.triangles.size());
  };
  for (unsigned cell = 0; cell < PageChunk::kCells;) {
    if ((cells >> cell & 1) != 0) {
      chunk.inside.begins[cell] = begin_of(chunk.inside);
      chunk.border.begins[cell] = begin_of(chunk.border);
      add_cell(cell++, chunk);
    } else {
      const unsigned end = cell + static_cast<unsigned>(std::min(std::countr_zero(cells >> cell),
                                                                 static_cast<int>(PageChunk::kCells - cell)));
      copy(before->inside, cell, end, chunk.inside);
      copy(before->border, cell, end, chunk.border);
      cell = end;
    }
  }
  chunk.inside.begins[PageChunk::kCells] = begin_of(chunk.inside);
  chunk.border.begins[PageChunk::kCells] = begin_of(chunk.border);
}

template <class Sample>
void ChunkMaker<Sample>::add_cell(unsigned cell, PageChunk& chunk) {
  constexpr std::int32_t kCell = PageChunk::kCellSide;
  const LatticePoint first = first_of_cell(cell);
  for (std::int32_t k = first.k; k < first.k + kCell; ++k) {
    for (std::int32_t j = first.j; j < first.j + kCell; ++j) {
      unsigned bits = chunk.split.rows[static_cast<std::size_t>(j + kSide * k)] & 0xfu << first.i;
      for (; bits != 0; bits &= bits - 1) {
        mesh_.for_each_triangle({std::countr_zero(bits), j, k},
                                [&](const typename PageMesh<Sample>::EdgePlaces& edges, bool is_cut) {
                                  std::array<EdgePlace, 3> triangle;
                                  for (std::size_t c = 0; c < 3; ++c)
                                    triangle[c] = static_cast<EdgePlace>(edges[c]);
                                  (is_cut ? chunk.border : chunk.inside).triangles.push_back(triangle);
                                });
      }
    }
  }
}

template <class Sample>
template <class AddTriangle>
std::size_t ChunkMaker<Sample>::number(const PageChunk::Part* before, unsigned first_cell,
                                       PageChunk::Part& part, AddTriangle&& triangle) {
  numbers_of_old_.clear();
  if (part.triangles.empty()) {
    part.edges_before.fill(0);
    return 0;
  }
  const std::size_t same = first_cell == 0 ? 0 : before->edges_before[first_cell];
  if (before != nullptr) {
    part.edges.assign(before->edges.begin(), before->edges.begin() + static_cast<std::ptrdiff_t>(same));
    std::copy_n(before->edges_before.begin(), first_cell, part.edges_before.begin());
    for (std::size_t n = 0; n < same; ++n) numbers_[part.edges[n]].now = static_cast<std::uint16_t>(n);
    for (std::size_t n = same; n < before->edges.size(); ++n)
      numbers_[before->edges[n]].before = static_cast<std::uint16_t>(n);
  }
  for (unsigned cell = first_cell; cell < PageChunk::kCells; ++cell) {
    part.edges_before[cell] = static_cast<std::uint32_t>(part.edges.size());
    for (std::size_t t = part.begins[cell]; t < part.begins[cell + 1]; ++t) {
      std::array<std::uint32_t, 3> numbers;
      for (std::size_t c = 0; c < 3; ++c) {
        const EdgePlace place = part.triangles[t][c];
        Numbers& of_place = numbers_[place];
        if (of_place.now == kNone) {
          of_place.now = static_cast<std::uint16_t>(part.edges.size());
          part.edges.push_back(place);
          numbers_of_old_.push_back(of_place.before);
        }
        numbers[c] = of_place.now;
      }
      triangle(t, numbers);
    }
  }
  for (const EdgePlace place : part.edges) numbers_[place] = {};
  if (before != nullptr) {
    for (const EdgePlace place : before->edges) numbers_[place] = {};
  }
  return same;
}

template <class Sample>
double ChunkMaker<Sample>::parameter(EdgePlace place) const {
  const auto [first, second] = DiamondStencil::ends_of_edge(place);
  const double least = surface_.least_parameter;
  return std::clamp(
      edge_parameter(mesh_.samples().value(first), mesh_.samples().value(second), surface_.isovalue), least,
      1 - least);
}

template <class Sample>
template <class Value, class Make>
void ChunkMaker<Sample>::take_over(const std::vector<Value>* before, std::size_t same,
                                   std::vector<Value>& values, Make&& make) {
  values.resize(same + numbers_of_old_.size());
  if (same > 0) std::copy_n(before->begin(), same, values.begin());
  for (std::size_t n = same; n < values.size(); ++n) {
    const std::uint16_t old = numbers_of_old_[n - same];
    values[n] = old == kNone ? make(n) : (*before)[old];
  }
}

template <class Sample>
void ChunkMaker<Sample>::show(const PageChunk* before, unsigned first_cell, PageChunk& chunk) {
  SurfaceChunk& shown = chunk.shown;
  shown.triangles.resize(chunk.inside.triangles.size());
  if (first_cell > 0)
    std::copy_n(before->shown.triangles.begin(), before->inside.begins[first_cell], shown.triangles.begin());
  const std::size_t same = number(
      before == nullptr ? nullptr : &before->inside, first_cell, chunk.inside,
      [&](std::size_t n, const std::array<std::uint32_t, 3>& triangle) { shown.triangles[n] = triangle; });
  if (source_.form == SurfaceForm::kEdgeEnds) {
    show_ends(before, same, chunk);
  } else {
    show_points(before, same, chunk);
  }
}

template <class Sample>
void ChunkMaker<Sample>::show_points(const PageChunk* before, std::size_t same, PageChunk& chunk) {
  SurfaceChunk& shown = chunk.shown;
  take_over(before == nullptr ? nullptr : &before->inside.parameters, same, chunk.inside.parameters,
            [&](std::size_t n) { return parameter(chunk.inside.edges[n]); });
  take_over(before == nullptr ? nullptr : &before->shown.points, same, shown.points,
            [&](std::size_t n) { return position(edge_point(chunk, chunk.inside, n)); });
  take_over(before == nullptr ? nullptr : &before->shown.normals, same, shown.normals,
            [&](std::size_t n) { return normals_.normal(edge_point(chunk, chunk.inside, n)); });
}

template <class Sample>
void ChunkMaker<Sample>::show_ends(const PageChunk* before, std::size_t same, PageChunk& chunk) {
  SurfaceChunk& shown = chunk.shown;
  constexpr LatticePoint kCorner{-1, -1, -1};
  const Domain& domain = diamonds_.domain();
  const LatticePoint first = in_lattice(chunk, {0, 0, 0});
  shown.corner = domain.position(in_lattice(chunk, kCorner));
  shown.step = domain.position(first) - shown.corner;
  shown.least_parameter = surface_.least_parameter;
  take_over(before == nullptr ? nullptr : &before->shown.ends, same, shown.ends, [&](std::size_t n) {
    const auto [a, b] = DiamondStencil::ends_of_edge(chunk.inside.edges[n]);
    return EdgeEnds(
        {a - kCorner, b - kCorner},
        {static_cast<float>(mesh_.samples().value(a)), static_cast<float>(mesh_.samples().value(b))},
        normals_.at_ends({in_lattice(chunk, a), in_lattice(chunk, b), 0}));
  });
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(ChunkMaker);

template <class Sample>
ChunkMakers<Sample>::ChunkMakers(const ChunkSource<Sample>& source, StoredGradients* gradients)
    : source_(source), first_(source_, free_, gradients) {}

template <class Sample>
void ChunkMakers<Sample>::set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* gradients) {
  first_.normals().set_pages(pages, gradients);
  others_.for_each([&](ChunkMaker<Sample>& maker) { maker.normals().set_pages(pages, gradients); });
}

template <class Sample>
void ChunkMakers<Sample>::make(std::span<Job> jobs, const Progress& progress) {
  // The pages of a batch are in memory together, if there is room.
  constexpr std::size_t kBatch = 256, kLeast = 8;
  for (; !jobs.empty(); jobs = jobs.subspan(std::min(kBatch, jobs.size()))) {
    const std::span<Job> batch = jobs.first(std::min(kBatch, jobs.size()));
    if (thread_limit() > 1 && batch.size() >= kLeast) make_in_memory(batch);
    for (Job& job : batch) {
      progress.check();
      if (job.chunk == nullptr)
        job.chunk = first_.make(job.page->lod, job.page->block, job.before, job.page->changed);
    }
  }
}

template <class Sample>
void ChunkMakers<Sample>::make_in_memory(std::span<Job> jobs) {
  StoredPages<OrderedWord<Sample>>& pages = source_.diamonds.pages();
  const bool loads = pages.loads();
  for (const Job& job : jobs) {
    if (loads && job.page->lod <= pages.grid().top()) pages.samples({job.page->lod, job.page->block});
  }
  StoredGradients* const gradients = first_.normals().stored();
  const auto set_loading = [&](bool is_to_load) {
    pages.set_loading(is_to_load);
    if (gradients != nullptr) gradients->set_loading(is_to_load);
  };
  set_loading(false);
  constexpr std::size_t kGrain = 4;
  parallel_chunks(jobs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<ChunkMaker<Sample>> maker = others_.take();
    if (maker == nullptr) maker = std::make_unique<ChunkMaker<Sample>>(source_, free_, gradients);
    for (Job& job : jobs.subspan(begin, end - begin)) {
      try {
        job.chunk = maker->make(job.page->lod, job.page->block, job.before, job.page->changed);
      } catch (const PageLost&) {
        continue;
      }
      if (loads && !job.chunk->missing.empty()) recycle(std::move(job.chunk));
    }
    others_.give(std::move(maker));
  });
  set_loading(loads);
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(ChunkMakers);

}  // namespace adamas::isosurface
