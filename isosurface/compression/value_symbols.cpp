#include "isosurface/compression/value_symbols.h"

#include "core/base/assert.h"

namespace adamas {

template <class Word>
ValueSymbols<Word>::ValueSymbols(const PageShape& shape, const Surroundings<Word>& around,
                                 const Page<Word>& page) {
  collect(shape, around, page, true);
  // Of a page that is not what was foreseen all is coded.
  if (summary_.range_mode() == RangeMode::kCoded) collect(shape, around, page, false);
  leave_out_what_modes_tell();
}

template <class Word>
void ValueSymbols<Word>::collect(const PageShape& shape, const Surroundings<Word>& around,
                                 const Page<Word>& page, bool trust) {
  summary_ = {};
  stages_.clear();
  range_stages_.clear();
  extras_.clear();
  if (shape.complete) {
    walk_complete_values<Word>(shape, page, *this);
  } else {
    walk_values<Word>(shape, around, page, trust, *this);
  }
}

template <class Word>
void ValueSymbols<Word>::errors(const ValueStage<std::uint8_t>& stage,
                                const typename Page<Word>::template Points<std::uint8_t>& codes) {
  Stage& made = stages_.emplace_back();
  made.contexts.assign(stage.contexts.begin(), stage.contexts.begin() + stage.size);
  made.symbols.resize(stage.size);
  for (std::size_t n = 0; n < stage.size; ++n) {
    const std::uint8_t code = codes[stage.places[n]];
    ADAMAS_ASSERT(code < ValueContexts<Word>::kErrorSymbols);
    summary_.add_error(code);
    made.symbols[n] = static_cast<std::uint8_t>((code - stage.predicted[n]) & 63);
  }
}

template <class Word>
void ValueSymbols<Word>::range(const ValueStage<Word>& stage, std::size_t side,
                               const typename Page<Word>::template Points<Word>& words) {
  range_stages_.push_back(stages_.size());
  Stage& made = stages_.emplace_back();
  made.contexts.assign(stage.contexts.begin(), stage.contexts.begin() + stage.size);
  made.symbols.resize(stage.size);
  for (std::size_t n = 0; n < stage.size; ++n) {
    const Word value = seen_from(side, words[stage.places[n]]);
    const auto token = RangeToken<Word>::of(value, stage.predicted[n], stage.bound[n]);
    summary_.add_range(value, stage.predicted[n], ValueContexts<Word>::is_sure(stage.contexts[n]));
    made.symbols[n] = token.symbol;
    const int count = RangeToken<Word>::extra_bits(token.symbol);
    if (count > 0) extras_.push_back({token.extra, count});
  }
  for (std::size_t n = 0; n < stage.segment_count; ++n) {
    const auto& [place, count, whole_row] = stage.segments[n];
    for (std::size_t m = place; m < place + 2u * count; m += 2) {
      summary_.add_range(seen_from(side, words[m]), stage.sure[m], true);
    }
  }
}

template <class Word>
void ValueSymbols<Word>::leave_out_what_modes_tell() {
  const ErrorMode errors = summary_.error_mode();
  const RangeMode ranges = summary_.range_mode();
  const bool coded = ranges == RangeMode::kCoded || ranges == RangeMode::kCodedButSure;
  if (!coded) extras_.clear();
  std::size_t next_range = 0;
  for (std::size_t n = 0; n < stages_.size(); ++n) {
    Stage& stage = stages_[n];
    const bool is_range = next_range < range_stages_.size() && range_stages_[next_range] == n;
    if (is_range) ++next_range;
    if (is_range ? !coded : errors != ErrorMode::kCoded) {
      stage = {};
    }
  }
}

template class ValueSymbols<std::uint8_t>;
template class ValueSymbols<std::uint16_t>;
template class ValueSymbols<std::uint32_t>;

}  // namespace adamas
