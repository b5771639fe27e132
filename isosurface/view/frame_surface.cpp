// What can be asked of the last frame: its surface as a whole and at the border of the data, its mesh in a
// plane, and its error at a place.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "isosurface/contour/contour_clip.h"
#include "isosurface/view/joined_edges.h"
#include "isosurface/view/mesh_cells.h"
#include "isosurface/view/paged_frames.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

namespace {

std::array<std::uint32_t, 3> renumbered(const std::array<std::uint32_t, 3>& triangle,
                                        const std::vector<std::uint32_t>& numbers) {
  return {numbers[triangle[0]], numbers[triangle[1]], numbers[triangle[2]]};
}

}  // namespace

template <class Sample>
const SurfaceChunk* PagedFrames<Sample>::chunk(std::uint64_t id) {
  if (apart_ && apart_->shown.id == id) return &apart_->shown;
  if (id == kRoot || id == kBorder) return nullptr;
  const ViewedPage* const page = pages_.find(static_cast<int>(id >> kLodBits),
                                             ZOrder::deinterleave(id & ((std::uint64_t{1} << kLodBits) - 1)));
  return page == nullptr || page->chunk == nullptr ? nullptr : &page->chunk->shown;
}

template <class Sample>
bool PagedFrames<Sample>::is_split(LatticePoint p) {
  const int lod = diamonds_.lod(p);
  if (lod < 0 || lod >= diamonds_.lods()) return false;
  const auto [page, q] = pages_.find(p);
  return page != nullptr && page->chunk != nullptr && page->chunk->split.has(q);
}

template <class Sample>
std::vector<std::vector<Vec3>> PagedFrames<Sample>::cells_in(const Plane& plane) {
  if (!isovalue_) return {};
  return isosurface::cells_in(diamonds_.root(), diamonds_.domain(), plane, diamonds_.data_box(),
                              [this](LatticePoint p) { return is_split(p); });
}

template <class Sample>
std::optional<double> PagedFrames<Sample>::error_at(const Vec3& place) {
  if (!isovalue_) return std::nullopt;
  const LatticePoint p =
      diamond_at(diamonds_.root(), diamonds_.domain(), place, [this](LatticePoint q) { return is_split(q); });
  try {
    return diamonds_.is_stored(p) ? diamonds_.error(diamonds_.class_if_crossed(p)) : 0;
  } catch (const PageLost&) {
    return std::nullopt;
  }
}

template <class Sample>
Contour PagedFrames<Sample>::border() const {
  Contour contour;
  JoinedEdges edges(contour);
  std::vector<std::uint32_t> numbers;
  for (const ViewedPage* const page : chunks_) {
    const PageChunk& chunk = *page->chunk;
    // The triangles name edges by their places.
    numbers.resize(std::numeric_limits<PageChunk::EdgePlace>::max());
    for (std::size_t n = 0; n < chunk.border.edges.size(); ++n) {
      const EdgePoint point = makers_.first().edge_point(chunk, chunk.border, n);
      numbers[chunk.border.edges[n]] = edges.number(point, makers_.first().position(point));
    }
    for (const auto& places : chunk.border.triangles)
      contour.triangles.push_back({numbers[places[0]], numbers[places[1]], numbers[places[2]]});
  }
  clip_contour(contour, diamonds_.data_box(), diamonds_.spacing());
  return contour;
}

template <class Sample>
Contour PagedFrames<Sample>::contour() const {
  Contour contour;
  JoinedEdges edges(contour);
  std::vector<std::uint32_t> numbers;
  for (const ViewedPage* const page : chunks_) {
    const PageChunk& chunk = *page->chunk;
    numbers.clear();
    for (std::size_t n = 0; n < chunk.inside.edges.size(); ++n) {
      const EdgePoint point = makers_.first().edge_point(chunk, chunk.inside, n);
      numbers.push_back(edges.number(point, makers_.first().position(point)));
    }
    for (const auto& triangle : chunk.shown.triangles)
      contour.triangles.push_back(renumbered(triangle, numbers));
  }
  if (!apart_) return contour;
  const Contour& apart = apart_->contour;
  numbers.clear();
  for (std::size_t n = 0; n < apart.edge_points.size(); ++n)
    numbers.push_back(edges.number(apart.edge_points[n], apart.points[n]));
  for (std::size_t n = apart.edge_points.size(); n < apart.points.size(); ++n) {
    numbers.push_back(static_cast<std::uint32_t>(contour.points.size()));
    contour.points.push_back(apart.points[n]);
  }
  contour.mean_points = apart.mean_points;
  for (const auto& triangle : apart.triangles) contour.triangles.push_back(renumbered(triangle, numbers));
  return contour;
}

template const SurfaceChunk* PagedFrames<std::uint8_t>::chunk(std::uint64_t);
template bool PagedFrames<std::uint8_t>::is_split(LatticePoint);
template std::vector<std::vector<Vec3>> PagedFrames<std::uint8_t>::cells_in(const Plane&);
template std::optional<double> PagedFrames<std::uint8_t>::error_at(const Vec3&);
template Contour PagedFrames<std::uint8_t>::contour() const;
template Contour PagedFrames<std::uint8_t>::border() const;
template const SurfaceChunk* PagedFrames<std::uint16_t>::chunk(std::uint64_t);
template bool PagedFrames<std::uint16_t>::is_split(LatticePoint);
template std::vector<std::vector<Vec3>> PagedFrames<std::uint16_t>::cells_in(const Plane&);
template std::optional<double> PagedFrames<std::uint16_t>::error_at(const Vec3&);
template Contour PagedFrames<std::uint16_t>::contour() const;
template Contour PagedFrames<std::uint16_t>::border() const;
template const SurfaceChunk* PagedFrames<std::int16_t>::chunk(std::uint64_t);
template bool PagedFrames<std::int16_t>::is_split(LatticePoint);
template std::vector<std::vector<Vec3>> PagedFrames<std::int16_t>::cells_in(const Plane&);
template std::optional<double> PagedFrames<std::int16_t>::error_at(const Vec3&);
template Contour PagedFrames<std::int16_t>::contour() const;
template Contour PagedFrames<std::int16_t>::border() const;
template const SurfaceChunk* PagedFrames<float>::chunk(std::uint64_t);
template bool PagedFrames<float>::is_split(LatticePoint);
template std::vector<std::vector<Vec3>> PagedFrames<float>::cells_in(const Plane&);
template std::optional<double> PagedFrames<float>::error_at(const Vec3&);
template Contour PagedFrames<float>::contour() const;
template Contour PagedFrames<float>::border() const;

}  // namespace adamas::isosurface
