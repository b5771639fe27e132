#include "isosurface/compression/value_symbols.h"

#include "core/base/assert.h"

namespace adamas {

namespace {

/// Calls visit(row, step) with the first of a row's own points and how far they lie apart.
template <class Visit>
void for_each_own_row(const PageShape& shape, Visit visit) {
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const bool some = !shape.complete && ((j | k) & 1) == 0;
      if (!some || shape.count.i > 1) visit(LatticePoint{some ? 1 : 0, j, k}, some ? 2 : 1);
    }
  }
}

}  // namespace

template <class Word>
void ValueSummary::add_errors(const PageShape& shape, const ValueFields<Word>& fields) {
  using Lanes = RowLanes<std::uint8_t, PageGrid::kSide>;
  // Bits of the points that count, by whether all of a row's do.
  std::array<std::array<std::uint8_t, PageGrid::kSide>, 2> own{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count.i); ++i) {
    own[1][i] = 255;
    own[0][i] = (i & 1) != 0 || shape.complete ? 255 : 0;
  }
  Lanes::Part any{}, all = ~any;
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const auto counted = Lanes::load(own[static_cast<std::size_t>((j | k) & 1)].data());
      const auto codes = Lanes::load(fields.errors.at({0, j, k}));
      any |= codes & counted;
      all &= codes | ~counted;
    }
  }
  for (std::size_t n = 0; n < PageGrid::kSide; ++n) {
    any_error = static_cast<std::uint8_t>(any_error | any[n]);
    all_errors = static_cast<std::uint8_t>(all_errors & all[n]);
  }
}

template <class Word>
void ValueSummary::add_ranges(const PageShape& shape, const ValueFields<Word>& fields) {
  for_each_own_row(shape, [&](LatticePoint first, std::int32_t step) {
    const Word* words = fields.values[0].at(first);
    for (std::int32_t n = 0; !any_word && first.i + n < shape.count.i; n += step)
      any_word = words[n] != ValueFields<Word>::kUnknown;
  });
}

template <class Word>
ValueSymbols<Word>::ValueSymbols(const ErrorGeometry& geometry, const PageShape& shape,
                                 const Surroundings<Word>& around, const Page<Word>& page)
    : shape_(shape), fields_(std::make_unique_for_overwrite<ValueFields<Word>>()) {
  fields_->load(shape, around, page);
  fields_->load_values(shape, page);
  collect(geometry, {true, true});
  // Of what is not as foreseen all is coded.
  const ValueTrust trust{!summary_.any_sure_error_other, !summary_.any_sure_range_other};
  if (!trust.errors || !trust.ranges) collect(geometry, trust);
  leave_out_what_modes_tell();
}

template <class Word>
void ValueSymbols<Word>::collect(const ErrorGeometry& geometry, ValueTrust trust) {
  summary_.any_other = false;
  stages_.clear();
  range_stages_.clear();
  extras_.clear();
  if (shape_.complete) {
    walk_complete_values<Word>(*fields_, shape_, *this);
  } else {
    walk_values<Word>(*fields_, geometry, shape_, trust, *this);
  }
  summary_.add_errors(shape_, *fields_);
  summary_.add_ranges(shape_, *fields_);
}

template <class Word>
template <class T>
bool ValueSymbols<Word>::any_other(int phase, const ValueStage& stage, const PaddedGrid<T>& found,
                                   const PaddedGrid<T>& predicted) const {
  std::vector<bool> coded(PaddedGrid<T>::kPoints, false);
  for (std::size_t n = 0; n < stage.size; ++n) coded[stage.places[n]] = true;
  bool any = false;
  for_each_row(shape_, phase, [&](LatticePoint first) {
    const std::size_t place = PaddedGrid<T>::place(first);
    for (std::int32_t n = 0; n < row_count(shape_, first); ++n) {
      const std::size_t at = place + 2 * static_cast<std::size_t>(n);
      any = any || (!coded[at] && found[at] != predicted[at]);
    }
  });
  return any;
}

template <class Word>
void ValueSymbols<Word>::errors(int phase, const ValueStage& stage) {
  Stage& made = stages_.emplace_back();
  made.contexts.assign(stage.contexts.begin(), stage.contexts.begin() + stage.size);
  made.symbols.resize(stage.size);
  for (std::size_t n = 0; n < stage.size; ++n) {
    const std::uint8_t code = fields_->errors[stage.places[n]];
    ADAMAS_ASSERT(code < ValueContexts<Word>::kErrorSymbols);
    made.symbols[n] = static_cast<std::uint8_t>((code - fields_->predicted[stage.places[n]]) & 63);
  }
  summary_.any_sure_error_other =
      summary_.any_sure_error_other || any_other(phase, stage, fields_->errors, fields_->predicted);
}

template <class Word>
void ValueSymbols<Word>::range(int phase, std::size_t side, const ValueStage& stage) {
  range_stages_.push_back(stages_.size());
  Stage& made = stages_.emplace_back();
  made.contexts.assign(stage.contexts.begin(), stage.contexts.begin() + stage.size);
  made.symbols.resize(stage.size);
  for (std::size_t n = 0; n < stage.size; ++n) {
    const std::size_t place = stage.places[n];
    const auto token = RangeToken<Word>::of(fields_->values[side][place], fields_->known[side][place],
                                            fields_->bound(side, place));
    summary_.any_other = summary_.any_other || token.symbol != RangeToken<Word>::kPredicted;
    made.symbols[n] = token.symbol;
    const int count = RangeToken<Word>::extra_bits(token.symbol);
    if (count > 0) extras_.push_back({token.extra, count});
  }
  const bool other = any_other(phase, stage, fields_->values[side], fields_->known[side]);
  summary_.any_sure_range_other = summary_.any_sure_range_other || other;
  summary_.any_other = summary_.any_other || other;
}

template <class Word>
void ValueSymbols<Word>::leave_out_what_modes_tell() {
  const bool errors = is_coded(summary_.error_mode()), ranges = is_coded(summary_.range_mode());
  if (!ranges) extras_.clear();
  std::size_t next_range = 0;
  for (std::size_t n = 0; n < stages_.size(); ++n) {
    const bool is_range = next_range < range_stages_.size() && range_stages_[next_range] == n;
    if (is_range) ++next_range;
    if (is_range ? !ranges : !errors) stages_[n] = {};
  }
}

template void ValueSummary::add_errors(const PageShape&, const ValueFields<std::uint8_t>&);
template void ValueSummary::add_errors(const PageShape&, const ValueFields<std::uint16_t>&);
template void ValueSummary::add_errors(const PageShape&, const ValueFields<std::uint32_t>&);
template void ValueSummary::add_ranges(const PageShape&, const ValueFields<std::uint8_t>&);
template void ValueSummary::add_ranges(const PageShape&, const ValueFields<std::uint16_t>&);
template void ValueSummary::add_ranges(const PageShape&, const ValueFields<std::uint32_t>&);
template class ValueSymbols<std::uint8_t>;
template class ValueSymbols<std::uint16_t>;
template class ValueSymbols<std::uint32_t>;

}  // namespace adamas
