#include "isosurface/compression/error_stage.h"

#include <cstring>

#include "isosurface/compression/row_lanes.h"
#include "isosurface/compression/wide_lanes.h"

namespace adamas {
namespace {

using Codes = PaddedGrid<std::uint8_t>;

constexpr std::uint8_t kRoomClasses = ErrorStages<std::uint8_t>::kRoomClasses;
/// Stands for a context where a child's error is as great as the point's may be.
constexpr std::uint8_t kDetermined = 255;

/// What is predicted of the points of a row, from the own errors that stand there: not more than they may be,
/// and not less than any child on the page. For each a part of its context too.
void predict(const Codes& errors, const Codes& most_errors, LatticePoint first, int phase,
             std::uint8_t* predicted, std::uint8_t* contexts) {
  using Lanes = RowLanes<std::uint8_t, PageGrid::kSide>;
  static_assert(Lanes::kParts == 1);
  const LatticePoint row{0, first.j, first.k};
  Lanes children(errors.at({-1, -1, -1}));
  for (int axis = 0; phase < 2 && axis < 3; ++axis) {
    if ((first[axis] & 1) == 0) continue;
    LatticePoint step{};
    step[axis] = 1;
    children.take_greatest(errors.at(row - step));
    children.take_greatest(errors.at(row + step));
  }
  std::array<std::uint8_t, PageGrid::kSide> greatest_child;
  children.store(greatest_child.data());
  Lanes lanes(predicted);
  lanes.take_least(most_errors.at(row));
  lanes.take_greatest(greatest_child.data());
  std::array<std::uint8_t, PageGrid::kSide> codes;
  lanes.store(codes.data());
  // The points between them belong to a later phase.
  copy_every_other(codes.data(), predicted, static_cast<std::size_t>(first.i));

  using Part = Lanes::Part;
  const Part code = Lanes::load(codes.data()), most = Lanes::load(most_errors.at(row)),
             floor = Lanes::load(greatest_child.data());
  const Part room = most > code ? most - code : Part{};
  Part context = code == 0 ? Part{} + kRoomClasses : Part{};
  for (const std::uint8_t least : {1, 2, 4, 7, 13, 25}) context += room >= least ? Part{} + 1 : Part{};
  context = floor >= most ? Part{} + kDetermined : context;
  std::memcpy(contexts, &context, sizeof context);
}

}  // namespace

template <class Word>
void ErrorStages<Word>::make(ValueFields<Word>& fields, const PageShape& shape, int phase, bool trust,
                             bool take, ValueStage& stage) {
  with_wide_lanes([&](auto) {
    Codes& contexts = fields.error_contexts;
    for_each_row(shape, phase, [&](LatticePoint first) {
      const LatticePoint row{0, first.j, first.k};
      predict(fields.errors, fields.most_errors, first, phase, fields.predicted.at(row), contexts.at(row));
      if (take) copy_points(shape, first, fields.predicted, fields.errors);
    });
    // Samples that are not whole numbers are worked with in another precision.
    const bool is_finest = shape.level == 0, are_exact = is_finest && sizeof(Word) < sizeof(float);
    const int base = 1 + (phase * 2 + (is_finest ? 0 : 1)) * 2 * 2 * kRoomClasses;
    constexpr int kMissing = 2 * kRoomClasses;
    with_points(shape, phase, PhasePoints::Of::kErrors, [&](const PhasePoints& points) {
      const bool some = trust && are_exact;
      const auto list = some ? points.open() : points.all();
      std::size_t size = 0;
      for (std::size_t n = 0; n < list.size(); ++n) {
        const std::uint8_t part = contexts[list[n]];
        const bool misses = some || !points.sure()[n];
        const bool is_sure = part == kDetermined || (are_exact && !misses);
        stage.places[size] = list[n];
        stage.contexts[size] =
            static_cast<std::uint16_t>(is_sure ? kSure : base + (misses ? kMissing : 0) + part);
        size += is_sure && trust ? 0 : 1;
      }
      stage.size = size;
    });
  });
}

template class ErrorStages<std::uint8_t>;
template class ErrorStages<std::uint16_t>;
template class ErrorStages<std::uint32_t>;

}  // namespace adamas
