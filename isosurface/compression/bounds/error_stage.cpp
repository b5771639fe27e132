#include "isosurface/compression/bounds/error_stage.h"

#include <algorithm>
#include <utility>

#include "core/base/simd.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {
namespace {

using Codes = ParityCells<std::uint8_t>;

constexpr std::uint8_t kMostCode = 63;
constexpr int kRoomClasses = ErrorStages<std::uint8_t>::kRoomClasses;

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
    Numbers part = code == 0 ? Numbers{} + (1 + kRoomClasses) : Numbers{} + 1;
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
  stage.begin(parity, ParityBox::of(shape.count, parity));
  with_wide_lanes([&](auto bytes) {
    Codes parts;
    if (phase_of(parity) == 2 && shape.lod > 0) {
      with_parity(parity, [&](auto of) {
        if constexpr (phase_of(of()) == 2)
          find_coarse_edge_contexts<of(), bytes()>(fields.errors, fields.cube_error_room, parts);
      });
      stage.add_rows<bytes() == 32>({}, [&](std::size_t cell, RowBytes) {
        const RowBytes context = load_row(parts.data() + cell), open = bytes_not_zero(context);
        return std::pair((context + kEachByte * (kCoarseEdges - 1)) & open, left_out ? open : ~RowBytes{0});
      });
      return;
    }
    with_parity(parity, [&](auto of) {
      predict<of(), bytes()>(fields.errors, fields.cube_error_room, fields.predicted[of()], parts);
    });
    // Numbers that are not integers were computed in another precision.
    const bool is_finest = shape.lod == 0, are_exact = is_finest && sizeof(Word) < sizeof(float);
    // Parts begin with 1, as do the contexts of points that are not determined.
    const int base = (phase_of(parity) * 2 + (is_finest ? 0 : 1)) * 2 * 2 * kRoomClasses;
    constexpr int kMissing = 2 * kRoomClasses;
    const DeterminedPoints points(shape, parity, DeterminedPoints::Of::kErrors);
    stage.add_rows<bytes() == 32>(points, [&](std::size_t cell, RowBytes have_all) {
      const RowBytes part = load_row(parts.data() + cell);
      const RowBytes open = bytes_not_zero(part) & (are_exact ? ~have_all : ~RowBytes{0});
      const RowBytes contexts =
          part + kEachByte * static_cast<RowBytes>(base) + (~have_all & kEachByte * kMissing);
      return std::pair(contexts & open, left_out ? open : ~RowBytes{0});
    });
  });
}

ADAMAS_INSTANTIATE_FOR_WORDS(ErrorStages);

}  // namespace adamas::isosurface
