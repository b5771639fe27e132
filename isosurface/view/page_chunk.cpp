#include "isosurface/view/page_chunk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>
#include <utility>

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;
constexpr std::size_t kPlaces =
    static_cast<std::size_t>(DiamondStencil::edge_place({0, 0, DiamondStencil::kEdgeSide}));
static_assert(kPlaces <= 0xffff);

LatticePoint in_page(LatticePoint q) { return {q.i & (kSide - 1), q.j & (kSide - 1), q.k & (kSide - 1)}; }

/// The first diamond of a cell.
LatticePoint first_of_cell(unsigned cell) {
  const auto c = static_cast<std::int32_t>(cell);
  return PageChunk::kCellSide * LatticePoint{c % 4, c / 4 % 4, c / 16};
}

/// What of a mask lies in some cells.
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

/// The ends of the edges that may be on a page, in ascending order, counted from the page's first point.
struct EdgesOfPage {
  struct Edge {
    std::array<std::int8_t, 3> first, second;
  };
  std::vector<Edge> edges{kPlaces};

  EdgesOfPage() {
    constexpr std::int32_t kEdges = DiamondStencil::kEdgeSide, kHalf = 8;
    // Diamonds on all pages are like those on this one, as far as their edges do not reach beyond the points
    // round it.
    constexpr LatticePoint kBlock{1, 1, 1};
    for (std::int32_t place = 0; place < static_cast<std::int32_t>(kPlaces); ++place) {
      // The sum of its ends; the edge is the split edge of the diamond at its middle.
      const LatticePoint sum{place % kEdges - 2, place / kEdges % kEdges - 2, place / (kEdges * kEdges) - 2};
      auto ends = Diamond(kHalf * (2 * kSide * kBlock + sum)).split_edge();
      if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
      Edge& edge = edges[static_cast<std::size_t>(place)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto from_first = [axis](LatticePoint p) {
          return static_cast<std::int8_t>(p[static_cast<int>(axis)] / (2 * kHalf) - kSide);
        };
        edge.first[axis] = from_first(ends[0]);
        edge.second[axis] = from_first(ends[1]);
      }
    }
  }
};

std::array<LatticePoint, 2> ends_of_edge(PageChunk::EdgePlace place) {
  static const EdgesOfPage kAll;
  const EdgesOfPage::Edge& edge = kAll.edges[place];
  return {LatticePoint{edge.first[0], edge.first[1], edge.first[2]},
          LatticePoint{edge.second[0], edge.second[1], edge.second[2]}};
}

}  // namespace

template <class Sample>
ChunkMaker<Sample>::ChunkMaker(const ChunkSource<Sample>& source, SharedPool<PageChunk>& free,
                               StoredGradients* gradients)
    : source_(source),
      diamonds_(source.diamonds),
      surface_(source.surface),
      page_(diamonds_),
      normals_(diamonds_.pages(), gradients),
      free_(free),
      numbers_(kPlaces) {}

template <class Sample>
EdgePoint ChunkMaker<Sample>::edge_point(const PageChunk& chunk, const PageChunk::Part& part,
                                         std::size_t n) const {
  const auto [first, second] = ends_of_edge(part.edges[n]);
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
  neighbours_[0] = {.lod = lod, .block = block};
  // A page has eight next finer ones, except that the coarsest page has all coarser LODs too.
  neighbours_[1] = {.lod = lod - 1, .block = (lod > diamonds_.grid().top() ? 1 : 2) * block};
  chunk->split = *source_.split_of(lod, block);
  if (before == nullptr) cells = ~std::uint64_t{0};
  page_.load(lod, block, before == nullptr ? chunk->split : in_cells(chunk->split, cells));
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
      for (; bits != 0; bits &= bits - 1) add_diamond({std::countr_zero(bits), j, k}, chunk);
    }
  }
}

template <class Sample>
void ChunkMaker<Sample>::find_split(std::size_t n, Neighbours& neighbours) {
  neighbours.known |= 1u << n;
  neighbours.split[n] = source_.split_of(neighbours.lod, neighbours.block + step_around(static_cast<int>(n)));
}

template <class Sample>
inline bool ChunkMaker<Sample>::is_split(LatticePoint child, bool finer) {
  Neighbours& of = neighbours_[finer ? 1 : 0];
  const auto n =
      static_cast<std::size_t>((child.i >> 4) + 1 + 3 * ((child.j >> 4) + 1) + 9 * ((child.k >> 4) + 1));
  if ((of.known >> n & 1) == 0) find_split(n, of);
  return of.split[n] != nullptr && of.split[n]->has(in_page(child));
}

template <class Sample>
void ChunkMaker<Sample>::add_diamond(LatticePoint q, PageChunk& chunk) {
  const DiamondStencil& stencil = DiamondStencil::at(q);
  const DiamondStencil::Members above = page_.above(stencil, q);
  const unsigned slots = page_.slots(stencil, q);
  // Children of phase 2 are points of the next finer LOD.
  const bool finer = stencil.phase == 2;
  for (unsigned crossed = stencil.crossed[above]; crossed != 0;) {
    const auto c = static_cast<std::size_t>(std::countr_zero(crossed)) / 2;
    const unsigned halves = crossed & 3u << 2 * c;
    crossed &= ~halves;
    if (is_split((finer ? 2 : 1) * q + stencil.children[c], finer)) continue;
    if (!page_.is_inside() && !is_in_data(page_.diamond(q).child(static_cast<int>(c)))) continue;
    for (std::size_t n = 2 * c; n < 2 * c + 2; ++n) {
      const DiamondStencil::Half& half = stencil.halves[n];
      if ((halves >> n & 1) != 0 && (slots >> half.slot & 1) != 0) add_half(stencil, q, half, above, chunk);
    }
  }
}

template <class Sample>
bool ChunkMaker<Sample>::is_in_data(LatticePoint p) const {
  return diamonds_.domain().contains(p) && !is_beyond(Diamond(p), diamonds_.last_sample());
}

template <class Sample>
void ChunkMaker<Sample>::add_half(const DiamondStencil& stencil, LatticePoint q,
                                  const DiamondStencil::Half& half, DiamondStencil::Members above,
                                  PageChunk& chunk) const {
  unsigned bits = 0;
  for (std::size_t v = 0; v < 4; ++v) bits |= (above >> half.vertices[v] & 1) << v;
  bool is_cut = false;
  if (std::is_floating_point_v<Sample> || !page_.is_inside()) {
    std::array<LatticePoint, 4> in_lattice;
    for (std::size_t v = 0; v < 4; ++v) {
      const LatticePoint p = q + stencil.offsets[half.vertices[v]];
      if (std::is_floating_point_v<Sample> && !std::isfinite(page_.value(p))) return;
      in_lattice[v] = page_.in_lattice(p);
    }
    const LatticePoint last = diamonds_.last_sample();
    if (is_beyond(in_lattice, last)) return;
    is_cut = reaches_beyond(in_lattice, last);
  }
  const TetrahedronContour& contour = kTetrahedronContours[bits];
  const std::int32_t middle = DiamondStencil::edge_place(2 * (q + LatticePoint{1, 1, 1}));
  for (std::size_t n = 0; n < contour.triangle_count; ++n) {
    std::array<EdgePlace, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c)
      triangle[c] = static_cast<EdgePlace>(middle + half.edges[contour.triangles[n][c]]);
    (is_cut ? chunk.border : chunk.inside).triangles.push_back(triangle);
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
  const auto [first, second] = ends_of_edge(place);
  const double least = surface_.least_parameter;
  return std::clamp(edge_parameter(page_.value(first), page_.value(second), surface_.isovalue), least,
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
            [&](std::size_t n) { return normals_.of(edge_point(chunk, chunk.inside, n)); });
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
    const auto [a, b] = ends_of_edge(chunk.inside.edges[n]);
    return EdgeEnds({a - kCorner, b - kCorner},
                    {static_cast<float>(page_.value(a)), static_cast<float>(page_.value(b))},
                    normals_.at_ends({in_lattice(chunk, a), in_lattice(chunk, b), 0}));
  });
}

template class ChunkMaker<std::uint8_t>;
template class ChunkMaker<std::uint16_t>;
template class ChunkMaker<std::int16_t>;
template class ChunkMaker<float>;

}  // namespace adamas::isosurface
