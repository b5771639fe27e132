#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/lattice/diamond_type.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/compression/entropy/bit_stream.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

/// Returns the two samples whose mean predicts the sample at p (the dissertation (D), section 4.11): the ends
/// of the split edge of its diamond. A coordinate beyond the data is mirrored at p, where there always is a
/// sample, and a coarser one: an LOD depends on coarser LODs only. Coordinates count samples; p has one that
/// is not 0, and `dimensions` are those of the data.
constexpr std::array<LatticePoint, 2> predictors(LatticePoint p,
                                                 const std::array<std::int32_t, 3>& dimensions) {
  const int bits = trailing_zeros(p);
  const LatticePoint d = split_direction({p.i >> bits, p.j >> bits, p.k >> bits});
  std::array<LatticePoint, 2> ends{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t half = d[axis] * (std::int32_t{1} << bits);
    const bool both = p[axis] + (half < 0 ? -half : half) < dimensions[static_cast<std::size_t>(axis)];
    const std::int32_t below = half < 0 ? half : -half;
    ends[0][axis] = p[axis] + (both ? -half : below);
    ends[1][axis] = p[axis] + (both ? half : below);
  }
  return ends;
}

/// Returns the prediction from two samples, as words.
constexpr std::uint32_t predicted(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((std::uint64_t{a} + b) / 2);
}

/// The kind of a coded page, in the two lowest bits of its first byte.
enum class PageKind : std::uint8_t {
  kRaw = 0,        ///< the page's own samples as they are, the least byte first
  kSmooth = 1,     ///< nothing follows: all samples are as predicted
  kResiduals = 2,  ///< the residuals' code
  kUnranked = 3    ///< as kRaw, in a volume with ranks where some sample of the page has none
};

inline std::size_t own_points(const PageShape& shape) {
  const auto box = [](std::int32_t i, std::int32_t j, std::int32_t k) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(j) * static_cast<std::size_t>(k);
  };
  const LatticePoint n = shape.count;
  return box(n.i, n.j, n.k) - (shape.complete ? 0 : box((n.i + 1) / 2, (n.j + 1) / 2, (n.k + 1) / 2));
}

/// Returns the places of all points of a page in hierarchical z-order.
inline const std::array<std::uint16_t, PageGrid::kPoints>& places_in_order() {
  static const auto kPlaces = [] {
    constexpr ZOrder kOrder(4);
    std::array<std::uint16_t, PageGrid::kPoints> places{};
    for (std::uint64_t index = 0; index < kOrder.size(); ++index)
      places[index] = static_cast<std::uint16_t>(PageGrid::place(kOrder.point(index), 0));
    return places;
  }();
  return kPlaces;
}

/// Calls f(q, index) for the page's own points, in hierarchical z-order of 16^3 points; `index` is the place
/// in this order.
template <class F>
void for_each_own_point(const PageShape& shape, F&& f) {
  constexpr std::size_t kCoarser = PageGrid::kPoints / 8;
  const auto& places = places_in_order();
  const bool is_whole = shape.count == LatticePoint{PageGrid::kSide, PageGrid::kSide, PageGrid::kSide};
  for (std::size_t index = shape.complete ? 0 : kCoarser; index < places.size(); ++index) {
    const LatticePoint q{places[index] & 15, places[index] >> 4 & 15, places[index] >> 8};
    if (is_whole || shape.owns(q)) f(q, std::uint64_t{index});
  }
}

template <class Word>
void take_coarser(const typename Surroundings<Word>::template Points<Word>& around,
                  PagePoints<Word>& samples) {
  for (std::int32_t k = 0; k < PageGrid::kSide; k += 2) {
    for (std::int32_t j = 0; j < PageGrid::kSide; j += 2) {
      const Word* from = around.data() + surrounding_place({0, j, k});
      Word* to = samples.data() + PageGrid::place({0, j, k}, 0);
      for (int i = 0; i < PageGrid::kSide / 2; ++i) to[2 * i] = from[i];
    }
  }
}

/// Returns the prediction of a point of a complete page from points that come before it in hierarchical
/// z-order.
template <class Word>
Word predicted_inside(LatticePoint q, const PageShape& shape, const PagePoints<Word>& samples) {
  if (q == LatticePoint{0, 0, 0}) return 0;
  const auto [a, b] = predictors(q, {shape.count.i, shape.count.j, shape.count.k});
  return static_cast<Word>(predicted(samples[PageGrid::place(a, 0)], samples[PageGrid::place(b, 0)]));
}

template <class Word>
void write_raw(const PageShape& shape, const PagePoints<Word>& samples, std::vector<std::byte>& out,
               PageKind kind = PageKind::kRaw) {
  out.push_back(static_cast<std::byte>(kind));
  for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
    const Word sample = samples[PageGrid::place(q, 0)];
    for (std::size_t b = 0; b < sizeof(Word); ++b)
      out.push_back(static_cast<std::byte>(sample >> 8 * b & 0xff));
  });
}

/// Reads the bytes of a raw page behind its kind. Returns false where it has another size.
template <class Word>
bool read_raw(std::span<const std::byte> bytes, const PageShape& shape, PagePoints<Word>& samples) {
  if (bytes.size() != own_points(shape) * sizeof(Word)) return false;
  const std::byte* next = bytes.data();
  for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
    std::uint32_t sample = 0;
    for (std::size_t b = 0; b < sizeof(Word); ++b) sample |= std::to_integer<std::uint32_t>(*next++) << 8 * b;
    samples[PageGrid::place(q, 0)] = static_cast<Word>(sample);
  });
  return true;
}

}  // namespace adamas::isosurface
