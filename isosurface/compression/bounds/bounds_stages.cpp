#include "isosurface/compression/bounds/bounds_stages.h"

#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/base/simd.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

using Codes = ParityCells<std::uint8_t>;

constexpr std::uint8_t kMostCode = 63;

/// Returns the number of children on the page's LOD: centres have children along all axes, faces along two,
/// edges none.
constexpr std::size_t child_count(int parity) {
  return phase_of(parity) == 2 ? 0 : static_cast<std::size_t>(2 * (3 - phase_of(parity)));
}
constexpr CellNeighbour child(int parity, std::size_t number) {
  LatticePoint step{};
  std::size_t found = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if ((parity >> axis & 1) != 0 && found++ == number / 2) step[axis] = number % 2 == 0 ? -1 : 1;
  }
  return cell_neighbour(parity, step);
}

/// Limits predictions to the greatest possible error, and raises them to the errors of all children on the
/// page. Finds also a part of each context, from 1 on; it is 0 where a child has the greatest possible error.
template <int Parity, std::size_t Bytes>
[[gnu::always_inline]] inline void predict(const AllCells<std::uint8_t>& errors, const Codes& cube_room,
                                           Codes& predicted, Codes& parts) {
  using Lanes = Simd<std::uint8_t, Bytes>;
  using Numbers = typename Lanes::Numbers;
  for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
    Numbers least{};
    [&]<std::size_t... N>(std::index_sequence<N...>) {
      ((least = Lanes::greater(
            least, Lanes::load(errors[child(Parity, N).parity].data() + n + child(Parity, N).offset))),
       ...);
    }
    (std::make_index_sequence<child_count(Parity)>());
    const Numbers most = kMostCode - greatest_of_cubes<Parity, Lanes>(cube_room.data() + n);
    const Numbers code = Lanes::greater(Lanes::lesser(Lanes::load(predicted.data() + n), most), least);
    const Numbers room = Lanes::greater(most, code) - code;
    Numbers part = code == 0 ? Numbers{} + (1 + ErrorStages<std::uint8_t>::kRoomClasses) : Numbers{} + 1;
    for (const std::uint8_t from : {1, 2, 4, 7, 13, 25}) part += room >= from ? Numbers{} + 1 : Numbers{};
    Lanes::store(code, predicted.data() + n);
    Lanes::store(least >= most ? Numbers{} : part, parts.data() + n);
  }
}

/// Returns a quarter of the sum of the errors at four steps from the points.
template <int Parity, std::size_t Bytes>
[[gnu::always_inline]] inline typename Simd<std::uint8_t, Bytes>::Numbers mean_of_four(
    const AllCells<std::uint8_t>& errors, std::size_t cell, int axis_a, int axis_b) {
  using Lanes = Simd<std::uint8_t, Bytes>;
  typename Lanes::Numbers sum{};
  for (int n = 0; n < 4; ++n) {
    LatticePoint step{};
    step[axis_a] = (n & 1) == 0 ? -1 : 1;
    step[axis_b] = (n & 2) == 0 ? -1 : 1;
    const CellNeighbour near = cell_neighbour(Parity, step);
    sum += Lanes::load(errors[near.parity].data() + cell + near.offset);
  }
  return sum >> 2;
}

/// Returns the mean of known errors round edges of a coarse LOD: for edges along an axis those of edges along
/// the axes before it with which they share a cell; for those along the first axis those of their ends on the
/// coarser LOD.
template <int Parity, std::size_t Bytes>
[[gnu::always_inline]] inline typename Simd<std::uint8_t, Bytes>::Numbers mean_round_edges(
    const AllCells<std::uint8_t>& errors, std::size_t cell) {
  using Lanes = Simd<std::uint8_t, Bytes>;
  if constexpr (Parity == 1) {
    constexpr CellNeighbour kBefore = cell_neighbour(1, {-1, 0, 0}), kAfter = cell_neighbour(1, {1, 0, 0});
    return (Lanes::load(errors[0].data() + cell + kBefore.offset) +
            Lanes::load(errors[0].data() + cell + kAfter.offset)) >>
           1;
  } else if constexpr (Parity == 2) {
    return mean_of_four<Parity, Bytes>(errors, cell, 0, 1);
  } else {
    return (mean_of_four<Parity, Bytes>(errors, cell, 0, 2) +
            mean_of_four<Parity, Bytes>(errors, cell, 1, 2)) >>
           1;
  }
}

/// Finds the contexts of edges of a coarse LOD, whose errors are predicted as 0: from 1 on; 0 where they can
/// have no error.
template <int Parity, std::size_t Bytes>
[[gnu::always_inline]] inline void find_coarse_edge_contexts(const AllCells<std::uint8_t>& errors,
                                                             const Codes& cube_room, Codes& contexts) {
  using Lanes = Simd<std::uint8_t, Bytes>;
  using Numbers = typename Lanes::Numbers;
  constexpr int kLimitClasses = ErrorStages<std::uint8_t>::kLimitClasses;
  constexpr int kMeanClasses = ErrorStages<std::uint8_t>::kMeanClasses;
  for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
    const Numbers most = kMostCode - greatest_of_cubes<Parity, Lanes>(cube_room.data() + n);
    constexpr std::uint8_t kFirst = 16 - kLimitClasses;
    const Numbers limit = Lanes::greater(most >> 2, Numbers{} + kFirst) - kFirst;
    const Numbers mean = mean_round_edges<Parity, Bytes>(errors, n) >> 3;
    Lanes::store(most == 0 ? Numbers{} : limit * kMeanClasses + mean + 1, contexts.data() + n);
  }
}

}  // namespace

template <class Word>
void ErrorStages<Word>::make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool left_out,
                             BoundsStage& stage) {
  stage.begin(parity, ParityBox::for_parity(shape.count, parity));
  with_wide_lanes([&](auto bytes) {
    Codes parts;
    if (phase_of(parity) == 2 && shape.lod > 0) {
      with_parity(parity, [&](auto constant) {
        if constexpr (phase_of(constant()) == 2)
          find_coarse_edge_contexts<constant(), bytes()>(fields.errors, fields.cube_error_room, parts);
      });
      stage.add_rows<bytes() == 32>({}, [&](std::size_t cell, RowBytes) {
        const RowBytes context = load_row(parts.data() + cell), open = bytes_not_zero(context);
        return std::pair((context + kEachByte * (kCoarseEdges - 1)) & open, left_out ? open : ~RowBytes{0});
      });
      return;
    }
    with_parity(parity, [&](auto constant) {
      predict<constant(), bytes()>(fields.errors, fields.cube_error_room, fields.predicted[constant()],
                                   parts);
    });
    // Numbers that are not integers were computed in another precision.
    const bool is_finest = shape.lod == 0, are_exact = is_finest && sizeof(Word) < sizeof(float);
    // Parts begin with 1, as do the contexts of points that are not determined.
    const int base = (phase_of(parity) * 2 + (is_finest ? 0 : 1)) * 2 * 2 * kRoomClasses;
    constexpr int kMissing = 2 * kRoomClasses;
    const DeterminedPoints points(shape, parity, DeterminedPoints::Bound::kErrors);
    stage.add_rows<bytes() == 32>(points, [&](std::size_t cell, RowBytes have_all) {
      const RowBytes part = load_row(parts.data() + cell);
      const RowBytes open = bytes_not_zero(part) & (are_exact ? ~have_all : ~RowBytes{0});
      const RowBytes contexts =
          part + kEachByte * static_cast<RowBytes>(base) + (~have_all & kEachByte * kMissing);
      return std::pair(contexts & open, left_out ? open : ~RowBytes{0});
    });
  });
}

namespace {

/// The neighbours of a point: the samples in and on its diamond that may be known, and the children on the
/// page's LOD.
struct Neighbours {
  std::size_t sample_count = 0, child_count = 0;
  std::array<CellNeighbour, 11> samples{};
  std::array<CellNeighbour, 6> children{};
};

constexpr Neighbours neighbours(int parity) {
  const int phase = phase_of(parity);
  // The axis that distinguishes edges or faces from each other: edges lie along it, faces across it.
  const int distinct = phase == 2 ? parity : 7 - parity;
  const int own = distinct == 4 ? 2 : distinct == 2 ? 1 : 0;
  Neighbours result;
  for (int code = 0; code < 27; ++code) {
    const LatticePoint d{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
    const int length = d.i * d.i + d.j * d.j + d.k * d.k;
    const bool in_plane = d[own] == 0, on_axis = length == 1 && !in_plane;
    if (phase == 0 ? length == 3 || length == 0 : in_plane || on_axis)
      result.samples[result.sample_count++] = cell_neighbour(parity, d);
    if (phase == 0 ? length == 1 : phase == 1 && length == 1 && in_plane)
      result.children[result.child_count++] = cell_neighbour(parity, d);
  }
  return result;
}

using Bits = ParityCells<std::uint8_t>;

#if defined(__x86_64__)
/// Replaces bytes by the numbers of their bits, 32 at a time.
[[gnu::target("avx2")]] inline void to_bit_widths(std::uint8_t* bytes) {
  const __m256i of_low =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4));
  const __m256i of_high =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 5, 6, 6, 7, 7, 7, 7, 8, 8, 8, 8, 8, 8, 8, 8));
  const __m256i half = _mm256_set1_epi8(15);
  for (std::size_t n = kFirstCell; n < kEndOfCells; n += sizeof(__m256i)) {
    auto* const at = reinterpret_cast<__m256i*>(bytes + n);
    const __m256i all = _mm256_loadu_si256(at);
    const __m256i high = _mm256_shuffle_epi8(of_high, _mm256_and_si256(_mm256_srli_epi16(all, 4), half));
    const __m256i low = _mm256_shuffle_epi8(of_low, _mm256_and_si256(all, half));
    _mm256_storeu_si256(at, _mm256_max_epu8(high, low));
  }
}
#else
inline void to_bit_widths(std::uint8_t*) {}
#endif

/// The steps of making stages, for `Bytes` bytes of numbers at a time.
template <class Word, int Parity, std::size_t Bytes>
class RangeLanes {
 public:
  using Lanes = Simd<Word, Bytes>;
  using Numbers = typename Lanes::Numbers;
  /// Whether put_bits() stores numbers as they are, and to_bit_widths() counts their bits later.
  static constexpr bool kBitsFollow = sizeof(Word) == 1 && Bytes == 32;

  /// Finds the least known word of each point, rounded.
  [[gnu::always_inline]] static inline void find_known(const AllCells<Word>& samples,
                                                       const AllCells<Word>& ranges,
                                                       const RangeRounding<Word>& rounding, std::size_t side,
                                                       ParityCells<Word>& known) {
    for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
      const auto at = [n](const AllCells<Word>& cells, CellNeighbour near) {
        return Lanes::load(cells[near.parity].data() + n + near.offset);
      };
      Numbers least = at(samples, kNear.samples[0]);
      [&]<std::size_t... N>(std::index_sequence<N...>) {
        ((least = Lanes::lesser(least, at(samples, kNear.samples[N]))), ...);
      }
      (std::make_index_sequence<kNear.sample_count>());
      [&]<std::size_t... N>(std::index_sequence<N...>) {
        ((least = Lanes::lesser(least, at(ranges, kNear.children[N]))), ...);
      }
      (std::make_index_sequence<kNear.child_count>());
      Lanes::store(round(least, rounding, side), known.data() + n);
    }
  }

  /// Finds the limits of a side, and the number of bits of the room to them, in levels.
  [[gnu::always_inline]] static inline void find_limits(const ParityCells<Word>& cube_limits,
                                                        const ParityCells<Word>& known, int level_bits,
                                                        ParityCells<Word>& limits, Bits& bits) {
    for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
      const Numbers most = Lanes::load(known.data() + n);
      const Numbers limit = Lanes::lesser(greatest_of_cubes<Parity, Lanes>(cube_limits.data() + n), most);
      Lanes::store(limit, limits.data() + n);
      put_bits((most - limit) >> level_bits, bits.data() + n);
    }
  }

  /// Finds the number of bits of the difference between the least and the greatest known sample, in levels.
  [[gnu::always_inline]] static inline void find_spread(const ParityCells<Word>& low,
                                                        const ParityCells<Word>& inverted_high,
                                                        int level_bits, Bits& bits) {
    for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
      const Numbers least = Lanes::load(low.data() + n);
      const Numbers greatest = Lanes::greater(~Lanes::load(inverted_high.data() + n), least);
      put_bits((greatest - least) >> level_bits, bits.data() + n);
    }
  }

 private:
  static constexpr Neighbours kNear = neighbours(Parity);

  /// Returns RangeRounding::round of each number.
  [[gnu::always_inline]] static inline Numbers round(Numbers ends, const RangeRounding<Word>& rounding,
                                                     std::size_t side) {
    const Numbers rounded =
        Lanes::greater(ends >> rounding.bits << rounding.bits, Numbers{} + rounding.least[side]);
    if constexpr (!RangeRounding<Word>::kKeepsUnknown) return rounded;
    return ends == RangeRounding<Word>::kUnknown ? ends : rounded;
  }

  /// Stores std::bit_width of each number.
  [[gnu::always_inline]] static inline void put_bits(Numbers numbers, std::uint8_t* to) {
    using Narrow [[gnu::vector_size(Lanes::kCount)]] = std::uint8_t;
    if constexpr (kBitsFollow) {
      std::memcpy(to, &numbers, sizeof numbers);
      return;
    }
    Numbers bits{};
    for (unsigned n = 0; n < 8 * sizeof(Word); ++n) {
      // This is a variable, since with sanitizers the expression would have a wider type.
      const auto from = static_cast<Word>(Word{1} << n);
      bits += numbers >= from ? Numbers{} + 1 : Numbers{};
    }
    const Narrow narrow = __builtin_convertvector(bits, Narrow);
    std::memcpy(to, &narrow, sizeof narrow);
  }
};

/// Finds contexts by the room to the limit and by the probable distance of the samples inside from the
/// interpolation, relative to the limit: by error and by the number of bits that the samples' spread has more
/// than the room.
template <class Word, std::size_t Bytes>
[[gnu::always_inline]] inline void find_contexts(int base, const Bits& errors, const Bits& spread_bits,
                                                 const Bits& room_bits, Bits& contexts) {
  using Lanes = Simd<std::uint8_t, Bytes>;
  using Numbers = typename Lanes::Numbers;
  constexpr std::uint8_t kErrorClasses = RangeStages<Word>::kErrorClasses;
  constexpr int kStep = std::countr_zero(sizeof(Word));
  for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
    const Numbers error = Lanes::load(errors.data() + n), room = Lanes::load(room_bits.data() + n);
    // The value is clamped from 1 to 7; 64 is added so that nothing falls below 0.
    constexpr std::uint8_t kShift = 64;
    Numbers error_class = (error >> 2) + Lanes::load(spread_bits.data() + n) - room + (kShift - 10);
    error_class = Lanes::lesser(Lanes::greater(error_class, Numbers{} + (kShift + 1)),
                                Numbers{} + (kShift + kErrorClasses - 1)) -
                  kShift;
    const Numbers context = static_cast<std::uint8_t>(base) + ((room - 1) >> kStep) * kErrorClasses +
                            (error == 0 ? Numbers{} : error_class);
    Lanes::store(room == 0 ? Numbers{} + RangeStages<Word>::kDetermined : context, contexts.data() + n);
  }
}

}  // namespace

template <class Word>
void RangeStages<Word>::make(BoundsFields<Word>& fields, const PageShape& shape, int parity, bool left_out,
                             std::array<BoundsStage, 2>& stages) {
  const int phase = phase_of(parity);
  const bool are_known = phase < 2 || shape.lod == 0;
  const int group = phase < 2 ? 2 : shape.lod == 0 ? 0 : 1;
  for (BoundsStage& stage : stages) stage.begin(parity, ParityBox::for_parity(shape.count, parity));
  with_wide_lanes([&](auto bytes) {
    Bits spread, contexts;
    std::array<Bits, 2> room;
    with_parity(parity, [&](auto constant) {
      using Lanes = RangeLanes<Word, constant(), bytes()>;
      for (std::size_t side = 0; side < 2; ++side) {
        Lanes::find_known(fields.samples[side], fields.ranges[side], fields.rounding, side,
                          fields.known[side]);
        Lanes::find_limits(fields.cube_limits[side], fields.known[side], fields.rounding.bits,
                           fields.limits[side], room[side]);
      }
      Lanes::find_spread(fields.known[0], fields.known[1], fields.rounding.bits, spread);
      if constexpr (Lanes::kBitsFollow) {
        for (Bits* bits : {&room[0], &room[1], &spread}) to_bit_widths(bits->data());
      }
    });
    const DeterminedPoints points(shape, parity, DeterminedPoints::Bound::kRanges);
    for (std::size_t side = 0; side < 2; ++side) {
      find_contexts<Word, bytes()>(1 + group * kRoomClasses * kErrorClasses,
                                   fields.errors[static_cast<std::size_t>(parity)], spread, room[side],
                                   contexts);
      stages[side].template add_rows<bytes() == 32>(points, [&](std::size_t cell, RowBytes have_all) {
        const RowBytes row = load_row(contexts.data() + cell);
        const RowBytes open = bytes_not_zero(row) & (are_known ? ~have_all : ~RowBytes{0});
        return std::pair(row & open, left_out ? open : ~RowBytes{0});
      });
    }
  });
}

ADAMAS_INSTANTIATE_FOR_WORDS(ErrorStages);
ADAMAS_INSTANTIATE_FOR_WORDS(RangeStages);

}  // namespace adamas::isosurface
