#include "isosurface/compression/bounds/bounds_symbols.h"

#include "core/base/assert.h"

namespace adamas::isosurface {

namespace {

/// Calls visit(parity, cell, number of points) for each row of the page's own points.
template <class Visit>
void for_each_own_row(const PageShape& shape, Visit visit) {
  for (std::size_t parity = shape.complete ? 0 : 1; parity < 8; ++parity) {
    ParityBox::of(shape.count, static_cast<int>(parity))
        .for_each_row([&](std::size_t cell, std::size_t, int count) { visit(parity, cell, count); });
  }
}

}  // namespace

template <class Word>
void BoundsSummary::add_errors(const PageShape& shape, const BoundsFields<Word>& fields) {
  RowBytes any = 0, all = ~any;
  for_each_own_row(shape, [&](std::size_t parity, std::size_t cell, int count) {
    const RowBytes codes = load_row(fields.errors[parity].data() + cell), counted = first_bytes(count);
    any |= codes & counted;
    all &= codes | ~counted;
  });
  for (int n = 0; n < 64; n += 8) {
    any_error = static_cast<std::uint8_t>(any_error | (any >> n & 255));
    all_errors = static_cast<std::uint8_t>(all_errors & all >> n);
  }
}

template <class Word>
void BoundsSummary::add_ranges(const PageShape& shape, const BoundsFields<Word>& fields) {
  for_each_own_row(shape, [&](std::size_t parity, std::size_t cell, int count) {
    const Word* words = fields.ranges[0][parity].data() + cell;
    for (int n = 0; !any_word && n < count; ++n) any_word = words[n] != BoundsFields<Word>::kUnknown;
  });
  equal_ranges = any_other;
  if (!equal_ranges) return;
  const std::array<Word, 2> first = first_range(shape, fields);
  for_each_own_row(shape, [&](std::size_t parity, std::size_t cell, int count) {
    for (std::size_t side = 0; side < 2; ++side) {
      const Word* words = fields.ranges[side][parity].data() + cell;
      for (int n = 0; equal_ranges && n < count; ++n) equal_ranges = words[n] == first[side];
    }
  });
}

template <class Word>
std::array<Word, 2> first_range(const PageShape& shape, const BoundsFields<Word>& fields) {
  std::array<Word, 2> first{BoundsFields<Word>::kUnknown, BoundsFields<Word>::kUnknown};
  bool found = false;
  for_each_own_row(shape, [&](std::size_t parity, std::size_t cell, int) {
    if (!found) first = {fields.ranges[0][parity][cell], fields.ranges[1][parity][cell]};
    found = true;
  });
  return first;
}

template <class Word>
BoundsSymbols<Word>::BoundsSymbols(const OwnErrorGeometry& geometry, const RangeRounding<Word>& rounding,
                                   const PageShape& shape, const Surroundings<Word>& around,
                                   const Page<Word>& page)
    : shape_(shape), fields_(std::make_unique_for_overwrite<BoundsFields<Word>>()) {
  fields_->rounding = rounding;
  fields_->load(shape, around, page);
  fields_->load_bounds(shape, page);
  collect(geometry, {true, true});
  // Of what is not as foreseen all is coded.
  const Omissions omitted{!summary_.any_determined_error_other, !summary_.any_determined_range_other};
  if (!omitted.errors || !omitted.ranges) collect(geometry, omitted);
  leave_out_what_modes_tell();
}

template <class Word>
void BoundsSymbols<Word>::collect(const OwnErrorGeometry& geometry, Omissions omitted) {
  summary_.any_other = false;
  stages_.clear();
  range_stages_.clear();
  if (shape_.complete) {
    walk_complete_bounds<Word>(*fields_, shape_, *this);
  } else {
    walk_bounds<Word>(*fields_, geometry, shape_, omitted, *this);
  }
  summary_.add_errors(shape_, *fields_);
  summary_.add_ranges(shape_, *fields_);
}

template <class Word>
template <class T, class Symbol>
bool BoundsSymbols<Word>::add(const BoundsStage& stage, const ParityCells<T>& found,
                              const ParityCells<T>& expected, Symbol symbol) {
  Stage& made = stages_.emplace_back();
  made.base = stage.base;
  made.contexts.assign(stage.contexts.begin(),
                       stage.contexts.begin() + static_cast<std::ptrdiff_t>(stage.size));
  made.symbols.reserve(stage.size);
  bool any_other = false;
  const RowBytes* coded = stage.coded.data();
  stage.box.for_each_row([&](std::size_t first, std::size_t, int count) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if ((*coded >> 8 * i & 1) != 0) {
        made.symbols.push_back(symbol(first + i));
      } else {
        any_other = any_other || found[first + i] != expected[first + i];
      }
    }
    ++coded;
  });
  return any_other;
}

template <class Word>
void BoundsSymbols<Word>::errors(const BoundsStage& stage) {
  const auto& found = fields_->errors[static_cast<std::size_t>(stage.parity)];
  const auto& expected = fields_->predicted[static_cast<std::size_t>(stage.parity)];
  summary_.any_determined_error_other |= add(stage, found, expected, [&](std::size_t cell) {
    ADAMAS_ASSERT(found[cell] < BoundsContexts<Word>::kErrorSymbols);
    return static_cast<std::uint8_t>((found[cell] - expected[cell]) & 63);
  });
}

template <class Word>
void BoundsSymbols<Word>::range(std::size_t side, const BoundsStage& stage) {
  range_stages_.push_back(stages_.size());
  const auto& found = fields_->ranges[side][static_cast<std::size_t>(stage.parity)];
  const auto& expected = fields_->known[side];
  const bool other = add(stage, found, expected, [&](std::size_t cell) {
    const auto token = RangeToken<Word>::of(found[cell], expected[cell], fields_->limits[side][cell],
                                            fields_->rounding.bits);
    summary_.any_other = summary_.any_other || token.symbol != RangeToken<Word>::kPredicted;
    const int count = RangeToken<Word>::extra_bits(token.symbol);
    if (count > 0) stages_.back().extras.push_back({token.extra, count});
    return token.symbol;
  });
  summary_.any_determined_range_other |= other;
  summary_.any_other |= other;
}

template <class Word>
void BoundsSymbols<Word>::leave_out_what_modes_tell() {
  const bool errors = is_coded(summary_.error_mode()), ranges = is_coded(summary_.range_mode());
  std::size_t next_range = 0;
  for (std::size_t n = 0; n < stages_.size(); ++n) {
    const bool is_range = next_range < range_stages_.size() && range_stages_[next_range] == n;
    if (is_range) ++next_range;
    if (is_range ? !ranges : !errors) stages_[n] = {};
  }
}

template std::array<std::uint8_t, 2> first_range(const PageShape&, const BoundsFields<std::uint8_t>&);
template std::array<std::uint16_t, 2> first_range(const PageShape&, const BoundsFields<std::uint16_t>&);
template std::array<std::uint32_t, 2> first_range(const PageShape&, const BoundsFields<std::uint32_t>&);
template void BoundsSummary::add_errors(const PageShape&, const BoundsFields<std::uint8_t>&);
template void BoundsSummary::add_errors(const PageShape&, const BoundsFields<std::uint16_t>&);
template void BoundsSummary::add_errors(const PageShape&, const BoundsFields<std::uint32_t>&);
template void BoundsSummary::add_ranges(const PageShape&, const BoundsFields<std::uint8_t>&);
template void BoundsSummary::add_ranges(const PageShape&, const BoundsFields<std::uint16_t>&);
template void BoundsSummary::add_ranges(const PageShape&, const BoundsFields<std::uint32_t>&);
template class BoundsSymbols<std::uint8_t>;
template class BoundsSymbols<std::uint16_t>;
template class BoundsSymbols<std::uint32_t>;

}  // namespace adamas::isosurface
