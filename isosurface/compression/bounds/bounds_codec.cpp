#include "isosurface/compression/bounds/bounds_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "isosurface/compression/bounds/bounds_stages.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/compression/entropy/bit_stream.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {
namespace {

/// The modes in which a page's errors and ranges are coded. The first mode that is possible is taken.
enum class ErrorMode : std::uint8_t {
  kZero,                ///< all errors are 0
  kEqual,               ///< all errors are the same
  kCodedButDetermined,  ///< determined points are as predicted, the others are coded
  kCoded
};
enum class RangeMode : std::uint8_t {
  kEmpty,               ///< all ranges are empty
  kPredicted,           ///< all ranges are as predicted
  kCodedButDetermined,  ///< determined points are as predicted, the others are coded
  kCoded,
  kEqual  ///< all ranges are the same; it is tried before the coded modes
};

constexpr bool is_coded(ErrorMode mode) { return mode >= ErrorMode::kCodedButDetermined; }
constexpr bool is_coded(RangeMode mode) {
  return mode == RangeMode::kCodedButDetermined || mode == RangeMode::kCoded;
}

/// Facts about a page's errors and ranges from which their modes are chosen.
struct BoundsSummary {
  std::uint8_t any_error = 0;    ///< the bits that any code has set
  std::uint8_t all_errors = 63;  ///< the bits that all codes have set
  bool any_word = false;         ///< whether a range is not empty
  bool any_other = false;        ///< whether a range is not as predicted
  /// Whether a determined point is not as predicted.
  bool any_determined_error_other = false, any_determined_range_other = false;
  /// Whether all ranges are the same; it is set only where some range is not as predicted.
  bool equal_ranges = false;

  /// Adds the page's own errors.
  template <class Word>
  void add_errors(const PageShape& shape, const BoundsFields<Word>& fields);
  /// Notes whether its ranges are empty, and whether they are the same.
  template <class Word>
  void add_ranges(const PageShape& shape, const BoundsFields<Word>& fields);

  [[nodiscard]] ErrorMode error_mode() const {
    if (any_error == 0) return ErrorMode::kZero;
    if (any_error == all_errors) return ErrorMode::kEqual;
    return any_determined_error_other ? ErrorMode::kCoded : ErrorMode::kCodedButDetermined;
  }
  [[nodiscard]] RangeMode range_mode() const {
    if (!any_word) return RangeMode::kEmpty;
    if (!any_other) return RangeMode::kPredicted;
    if (equal_ranges) return RangeMode::kEqual;
    return any_determined_range_other ? RangeMode::kCoded : RangeMode::kCodedButDetermined;
  }
};

/// Returns the range of a page's first own point, by side.
template <class Word>
std::array<Word, 2> first_range(const PageShape& shape, const BoundsFields<Word>& fields);

/// The coded symbols of a page's errors and ranges.
template <class Word>
class BoundsSymbols {
 public:
  /// Makes the symbols. The ranges of the page and round it are rounded.
  BoundsSymbols(const OwnErrorGeometry& geometry, const RangeRounding<Word>& rounding, const PageShape& shape,
                const Surroundings<Word>& around, const Page<Word>& page);

  struct Extra {
    std::uint32_t bits;
    int count;
  };
  struct Stage {
    std::size_t base = 0;  ///< the offset of the contexts
    std::vector<std::uint8_t> contexts, symbols;
    std::vector<Extra> extras;  ///< the bits that symbols leave open, in their order
  };

  [[nodiscard]] const BoundsSummary& summary() const { return summary_; }
  /// Returns the range of the page's first own point, by side; it is that of all points where all ranges are
  /// the same.
  [[nodiscard]] std::array<Word, 2> first_range() const {
    return adamas::isosurface::first_range(shape_, *fields_);
  }
  /// Returns the symbols to be coded, by stages.
  [[nodiscard]] const std::vector<Stage>& stages() const { return stages_; }

  // walk_bounds() calls the functions below.
  [[nodiscard]] static bool needs_errors() { return true; }
  [[nodiscard]] static bool needs_ranges() { return true; }
  void errors(const BoundsStage& stage);
  void range(std::size_t side, const BoundsStage& stage);

 private:
  void collect(const OwnErrorGeometry& geometry, LeftOutPoints left_out);
  void leave_out_what_modes_tell();
  /// Adds the stage, with the symbols that symbol(cell) gives of the points that are coded. Returns whether
  /// any other point is not as expected.
  template <class T, class Symbol>
  bool add(const BoundsStage& stage, const ParityCells<T>& found, const ParityCells<T>& expected,
           Symbol symbol);

  PageShape shape_;
  std::unique_ptr<BoundsFields<Word>> fields_;
  BoundsSummary summary_;
  std::vector<Stage> stages_;
  std::vector<std::size_t> range_stages_;  ///< the stages of ranges
};

/// Calls visit(parity, cell, number of points) for each row of the page's own points.
template <class Visit>
void for_each_own_row(const PageShape& shape, Visit visit) {
  for (std::size_t parity = shape.complete ? 0 : 1; parity < 8; ++parity) {
    ParityBox::for_parity(shape.count, static_cast<int>(parity))
        .for_each_row([&](std::size_t cell, std::size_t, int count) { visit(parity, cell, count); });
  }
}

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
  // All points are coded if a determined point is not as expected.
  const LeftOutPoints left_out{!summary_.any_determined_error_other, !summary_.any_determined_range_other};
  if (!left_out.errors || !left_out.ranges) collect(geometry, left_out);
  leave_out_what_modes_tell();
}

template <class Word>
void BoundsSymbols<Word>::collect(const OwnErrorGeometry& geometry, LeftOutPoints left_out) {
  summary_.any_other = false;
  stages_.clear();
  range_stages_.clear();
  if (shape_.complete) {
    walk_complete_bounds<Word>(*fields_, shape_, *this);
  } else {
    walk_bounds<Word>(*fields_, geometry, shape_, left_out, *this);
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
    const auto token = RangeToken<Word>::encode(found[cell], expected[cell], fields_->limits[side][cell],
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

/// The beginning of the bytes of a page's bounds: a byte of modes, errors lowest; the code of all errors, in
/// the mode of equal errors; the words of all ranges, by side, in the mode of equal ranges. If a mode codes
/// points, the bytes of a RansEncoder follow, in which the extra bits of a stage's symbols come after its
/// escaped symbols.
template <class Word>
struct BoundsHead {
  ErrorMode errors{};
  RangeMode ranges{};
  std::uint8_t error = 0;       ///< the error of all points, where errors are equal
  std::array<Word, 2> range{};  ///< the range of all points, by side, where ranges are equal

  void put(std::vector<std::byte>& bytes) const {
    ByteWriter out(bytes);
    out.number(
        static_cast<std::uint8_t>(static_cast<int>(errors) | static_cast<int>(ranges) << kRangeModeAt));
    if (errors == ErrorMode::kEqual) out.number(error);
    if (ranges != RangeMode::kEqual) return;
    for (const Word word : range) out.number(word);
  }

  static BoundsHead take(ByteReader& in) {
    BoundsHead head;
    const auto modes = in.number<std::uint8_t>();
    head.errors = static_cast<ErrorMode>(modes & ((1 << kRangeModeAt) - 1));
    head.ranges = static_cast<RangeMode>(modes >> kRangeModeAt);
    if (head.errors == ErrorMode::kEqual) head.error = in.number<std::uint8_t>();
    if (head.ranges != RangeMode::kEqual) return head;
    for (Word& word : head.range) word = in.number<Word>();
    return head;
  }

  /// Returns whether a page of this shape may begin in this way.
  [[nodiscard]] bool is_possible(const PageShape& shape, const RangeRounding<Word>& rounding) const {
    if (ranges > RangeMode::kEqual) return false;
    const bool any_point = shape.complete || shape.count != LatticePoint{1, 1, 1};
    if (errors == ErrorMode::kEqual &&
        (error == 0 || error >= BoundsContexts<Word>::kErrorSymbols || !any_point))
      return false;
    if (ranges != RangeMode::kEqual) return true;
    return any_point && rounding.round(0, range[0]) == range[0] && rounding.round(1, range[1]) == range[1];
  }

 private:
  static constexpr int kRangeModeAt = 2;
};

/// The number of states of the entropy coder. It is less than for samples, since most pages have few coded
/// symbols. Eight states with wide registers are no faster here, as each stage is short and waits for the one
/// before, and would take seven bytes more of a page, which has 240 on average.
constexpr std::size_t kStates = 4;
/// The number of bits in which RangeRounding::bits is written.
constexpr int kRoundingBits = 5;

/// Finds the tables of symbols in these contexts, whose offset is `base`.
void find_tables(const ContextTables& all, std::size_t base, std::span<const std::uint8_t> contexts,
                 std::uint8_t* tables) {
  const std::uint8_t* const of_contexts = all.tables_of_contexts().data() + base;
  for (std::size_t n = 0; n < contexts.size(); ++n) tables[n] = of_contexts[contexts[n]];
}

/// The decoder's port of walk_bounds().
template <class Word>
class BoundsReader {
 public:
  BoundsReader(const ContextTables& contexts, const RansTables& tables, std::span<const std::byte> bytes,
               const PageShape& shape, ErrorMode error_mode, RangeMode range_mode, BoundsFields<Word>& fields)
      : shape_(shape),
        error_mode_(error_mode),
        range_mode_(range_mode),
        fields_(fields),
        contexts_(contexts),
        decoder_(tables, bytes) {}

  [[nodiscard]] bool needs_errors() const { return is_coded(error_mode_); }
  [[nodiscard]] bool needs_ranges() const {
    return range_mode_ != RangeMode::kEmpty && range_mode_ != RangeMode::kEqual;
  }

  void errors(const BoundsStage& stage) {
    decode(stage);
    if (error_mode_ == ErrorMode::kCoded)
      summary_.any_determined_error_other |= any_determined_symbol(stage, ErrorStages<Word>::kDetermined);
    const auto parity = static_cast<std::size_t>(stage.parity);
    const std::uint8_t* const predicted = fields_.predicted[parity].data();
    std::uint8_t* const errors = fields_.errors[parity].data();
    with_wide_lanes([&](auto bytes) {
      constexpr RowBytes kCode = kEachByte * (BoundsContexts<Word>::kErrorSymbols - 1);
      RowBytes all = 0;
      for_each_row<bytes() == 32>(stage, [&](std::size_t cell, RowBytes symbols, int count) {
        all |= symbols;
        const RowBytes codes = ((symbols & kCode) + load_row(predicted + cell)) & kCode;
        store_row(codes & first_bytes(count), errors + cell);
      });
      good_ = good_ && (all & ~kCode) == 0;
    });
  }

  void range(std::size_t side, const BoundsStage& stage) {
    if (range_mode_ == RangeMode::kPredicted) {
      symbols_.fill(Token::kPredicted);
    } else {
      decode(stage);
    }
    if (range_mode_ == RangeMode::kCoded)
      summary_.any_determined_range_other |= any_determined_symbol(stage, RangeStages<Word>::kDetermined);
    Word* const ranges = fields_.ranges[side][static_cast<std::size_t>(stage.parity)].data();
    with_wide_lanes([&](auto bytes) {
      ParityCells<std::uint8_t> symbols{};
      ParityCells<Word> words;
      RowBytes all = 0;
      for_each_row<bytes() == 32>(stage, [&](std::size_t cell, RowBytes row, int) {
        all |= row;
        store_row(row, symbols.data() + cell);
      });
      summary_.any_other |= all != 0;
      bool any_open = false;
      good_ = good_ && put_near<bytes()>(symbols, side, words, any_open);
      stage.box.for_each_row([&](std::size_t cell, std::size_t, auto count) {
        std::copy_n(words.data() + cell, static_cast<int>(count), ranges + cell);
      });
      if (any_open) put_far(stage.box, symbols, side, ranges);
    });
  }

  /// Returns whether the bytes are those of a coded page.
  [[nodiscard]] bool finish() {
    const bool coded = is_coded(error_mode_) || is_coded(range_mode_);
    if (!good_ || (coded && !decoder_.at_end())) return false;
    summary_.add_errors(shape_, fields_);
    if (needs_ranges()) summary_.add_ranges(shape_, fields_);
    return summary_.error_mode() == error_mode_ &&
           (range_mode_ == RangeMode::kEqual || summary_.range_mode() == range_mode_);
  }

 private:
  using Token = RangeToken<Word>;
  static_assert(Token::kPredicted == 0);

  void decode(const BoundsStage& stage) {
    std::array<std::uint8_t, BoundsStage::kMost> tables;
    find_tables(contexts_, stage.base, {stage.contexts.data(), stage.size}, tables.data());
    if (decoder_.take({tables.data(), stage.size}, symbols_.data())) return;
    good_ = false;
    symbols_.fill(0);
  }

  /// Returns whether any determined point is not as expected, in a stage that codes them.
  bool any_determined_symbol(const BoundsStage& stage, std::uint8_t determined_context) const {
    unsigned any = 0;
    for (std::size_t n = 0; n < stage.size; ++n)
      any |= stage.contexts[n] == determined_context ? symbols_[n] : 0u;
    return any != 0;
  }

  /// Calls visit(cell, symbols, number of points) for each row; points that are not coded have the symbol 0.
  template <bool Wide, class Visit>
  [[gnu::always_inline]] void for_each_row(const BoundsStage& stage, Visit visit) const {
    const std::uint8_t* next = symbols_.data();
    const RowBytes* coded = stage.coded.data();
    stage.box.for_each_row([&](std::size_t cell, std::size_t, auto count) {
      const RowBytes those = *coded++;
      visit(cell, spread_bytes<Wide>(load_row(next), those), count);
      next += bytes_in(those);
    });
  }

  /// Stores the words of symbols without extra bits, at all cells, and finds out whether there are other
  /// symbols. Returns false where such a symbol is not possible.
  template <std::size_t Bytes>
  [[gnu::always_inline]] inline bool put_near(const ParityCells<std::uint8_t>& symbols, std::size_t side,
                                              ParityCells<Word>& words, bool& any_open) const {
    using Lanes = Simd<Word, Bytes>;
    using Numbers = typename Lanes::Numbers;
    using Symbols [[gnu::vector_size(Lanes::kCount)]] = std::uint8_t;
    const Word *const known = fields_.known[side].data(), *const limits = fields_.limits[side].data();
    const RangeRounding<Word> rounding = fields_.rounding;
    const Numbers least = Numbers{} + rounding.least[side], least_level = Numbers{} + rounding.level(side);
    Numbers bad{}, greatest{};
    for (std::size_t n = kFirstCell; n < kEndOfCells; n += Lanes::kCount) {
      Symbols row;
      std::memcpy(&row, symbols.data() + n, sizeof row);
      const Numbers symbol = __builtin_convertvector(row, Numbers);
      const Numbers predicted = Lanes::load(known + n), limit = Lanes::load(limits + n);
      const Numbers from = predicted >> rounding.bits, level = from - (symbol - (Token::kFirst - 1));
      const Numbers before = Lanes::greater(level << rounding.bits, least);
      Lanes::store(symbol == Token::kPredicted ? predicted
                   : symbol == Token::kLimit   ? limit
                                               : before,
                   words.data() + n);
      // Another token would stand for the word otherwise.
      Numbers unlike = (level > from ? ~Numbers{} : Numbers{}) |
                       (level < least_level ? ~Numbers{} : Numbers{}) |
                       (before == limit ? ~Numbers{} : Numbers{});
      if constexpr (RangeRounding<Word>::kKeepsUnknown)
        unlike |= predicted == RangeRounding<Word>::kUnknown ? ~Numbers{} : Numbers{};
      const Numbers wrong = symbol == Token::kLimit  ? (limit == predicted ? ~Numbers{} : Numbers{})
                            : symbol < Token::kFirst ? Numbers{}
                                                     : unlike;
      bad |= symbol < Token::kFirstOpen ? wrong : Numbers{};
      greatest = Lanes::greater(greatest, symbol);
    }
    Word any = 0;
    for (std::size_t n = 0; n < Lanes::kCount; ++n) {
      any = static_cast<Word>(any | bad[n]);
      any_open = any_open || greatest[n] >= Token::kFirstOpen;
    }
    return any == 0;
  }

  /// Returns the highest bit of each byte of a row whose symbol has extra bits.
  static constexpr RowBytes open_symbols(RowBytes row) {
    constexpr RowBytes kGreatest = kEachByte << 7;
    return (((row & ~kGreatest) + kEachByte * (128 - Token::kFirstOpen)) | row) & kGreatest;
  }

  /// Stores the words of symbols with extra bits.
  void put_far(const ParityBox& box, const ParityCells<std::uint8_t>& symbols, std::size_t side,
               Word* ranges) {
    std::array<std::uint16_t, BoundsStage::kMost> cells;
    std::size_t count = 0;
    box.for_each_row([&](std::size_t first, std::size_t, int) {
      for (RowBytes open = open_symbols(load_row(symbols.data() + first)); open != 0; open &= open - 1)
        cells[count++] =
            static_cast<std::uint16_t>(first + static_cast<std::size_t>(std::countr_zero(open)) / 8);
    });
    const Word* const known = fields_.known[side].data();
    const Word* const limits = fields_.limits[side].data();
    const RangeRounding<Word>& rounding = fields_.rounding;
    BitCursor extras = decoder_.bits();
    bool good = true;
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t cell = cells[n];
      const std::uint8_t symbol = symbols[cell];
      const Far far = kFar[std::min(symbol, Token::kBehind)];
      const auto extra = static_cast<std::uint32_t>(extras.take(far.extra_bits));
      const Word predicted = known[cell];
      const bool behind = symbol == Token::kBehind;
      const auto from = static_cast<Word>(predicted >> rounding.bits);
      const auto level = static_cast<Word>(from - (far.lead | extra));
      const Word value = behind ? static_cast<Word>(extra) : rounding.from_level(side, level);
      const bool is_one = behind ? value > predicted || Token::is_unknown(predicted)
                                 : (far.lead | extra) <= from && level >= rounding.level(side) &&
                                       !Token::is_unknown(predicted);
      // Another token would stand for it otherwise.
      good &= symbol <= Token::kBehind && value != predicted && value != limits[cell] && is_one;
      ranges[cell] = value;
    }
    decoder_.bits() = extras;
    good_ = good_ && good;
  }

  /// The value of a symbol with extra bits.
  struct Far {
    std::uint32_t lead = 0;
    std::uint8_t extra_bits = 0;
  };
  static constexpr auto kFar = [] {
    std::array<Far, Token::kSymbols> far{};
    for (std::uint8_t symbol = Token::kFirstOpen; symbol < far.size(); ++symbol)
      far[symbol] = {symbol == Token::kBehind ? 0 : Token::lead(symbol),
                     static_cast<std::uint8_t>(Token::extra_bits(symbol))};
    return far;
  }();

  PageShape shape_;
  ErrorMode error_mode_;
  RangeMode range_mode_;
  BoundsFields<Word>& fields_;
  const ContextTables& contexts_;
  RansDecoder<kStates> decoder_;
  BoundsSummary summary_;
  bool good_ = true;
  std::array<std::uint8_t, BoundsStage::kMost + BoundsStage::kSlack> symbols_;
};

}  // namespace

template <class Word>
BoundsSurvey<Word>::BoundsSurvey(const Vec3& spacing, const RangeRounding<Word>& rounding)
    : geometry_(spacing),
      rounding_(rounding),
      counts_(BoundsContexts<Word>::kCount, BoundsContexts<Word>::kSymbols) {}

template <class Word>
void BoundsSurvey<Word>::add(const PageShape& shape, const Surroundings<Word>& around,
                             const Page<Word>& page) {
  const BoundsSymbols<Word> symbols(geometry_, rounding_, shape, around, page);
  for (const auto& stage : symbols.stages()) {
    for (std::size_t n = 0; n < stage.symbols.size(); ++n)
      counts_.add(stage.base + stage.contexts[n], stage.symbols[n]);
  }
}

template <class Word>
std::vector<std::byte> BoundsCodec<Word>::tables() const {
  std::vector<std::byte> bytes;
  BitWriter out(bytes);
  out.put(static_cast<std::uint64_t>(rounding_.bits), kRoundingBits);
  if (rounding_.bits > 0) {
    for (const Word least : rounding_.least) out.put(least, 8 * sizeof(Word));
  }
  contexts_.write(out);
  out.finish();
  return bytes;
}

template <class Word>
BoundsCodec<Word> BoundsCodec<Word>::parse(std::span<const std::byte> tables, const Vec3& spacing,
                                           std::string_view name) {
  BitReader in(tables);
  RangeRounding<Word> rounding;
  in.refill();
  rounding.bits = static_cast<int>(in.take(kRoundingBits));
  if (rounding.bits > RangeRounding<Word>::kMostBits)
    fail("{}: expected ranges rounded to at most {} bits, found {}", name, RangeRounding<Word>::kMostBits,
         rounding.bits);
  if (rounding.bits > 0) {
    for (Word& least : rounding.least) {
      in.refill();
      least = static_cast<Word>(in.take(8 * sizeof(Word)));
    }
  }
  ContextTables contexts =
      ContextTables::read(in, BoundsContexts<Word>::kCount, BoundsContexts<Word>::kSymbols, name);
  if (!in.at_end()) fail("{}: expected the end after the tables of bounds, found more data", name);
  return BoundsCodec(OwnErrorGeometry(spacing), rounding, std::move(contexts));
}

template <class Word>
void BoundsCodec<Word>::encode(const PageShape& shape, const Surroundings<Word>& around,
                               const Page<Word>& page, std::vector<std::byte>& out) const {
  const BoundsSymbols<Word> symbols(geometry_, rounding_, shape, around, page);
  const ErrorMode errors = symbols.summary().error_mode();
  const RangeMode ranges = symbols.summary().range_mode();
  BoundsHead<Word>{errors, ranges, symbols.summary().any_error, symbols.first_range()}.put(out);
  if (!is_coded(errors) && !is_coded(ranges)) return;
  RansEncoder<kStates> encoder(tables_, 0);
  std::array<std::uint8_t, BoundsStage::kMost> tables;
  for (const auto& stage : symbols.stages()) {
    find_tables(contexts_, stage.base, stage.contexts, tables.data());
    encoder.put(std::span(tables).first(stage.symbols.size()), stage.symbols);
    for (const auto& [bits, count] : stage.extras) encoder.put_bits(bits, count);
  }
  encoder.finish(out);
}

template <class Word>
bool BoundsCodec<Word>::decode(std::span<const std::byte> bytes, const PageShape& shape,
                               const Surroundings<Word>& around, const PageSamples<Word>& samples,
                               PageBounds<Word>& bounds) const {
  ByteReader in(bytes);
  const auto head = BoundsHead<Word>::take(in);
  if (!in.good() || !head.is_possible(shape, rounding_)) return false;
  const ErrorMode errors = head.errors;
  const RangeMode ranges = head.ranges;
  const bool coded = is_coded(errors) || is_coded(ranges);
  if (!coded && !in.rest().empty()) return false;
  BoundsFields<Word> fields;
  fields.rounding = rounding_;
  fields.load(shape, around, samples);
  if (!is_coded(errors)) fields.fill_errors(shape, head.error);
  if (ranges == RangeMode::kEqual) fields.fill_ranges(shape, head.range);
  BoundsReader<Word> reader(contexts_, tables_, in.rest(), shape, errors, ranges, fields);
  if (shape.complete) {
    walk_complete_bounds<Word>(fields, shape, reader);
  } else {
    const LeftOutPoints left_out{errors != ErrorMode::kCoded, ranges != RangeMode::kCoded};
    walk_bounds<Word>(fields, geometry_, shape, left_out, reader);
  }
  fields.store_bounds(shape, bounds);
  return reader.finish() &&
         (ranges != RangeMode::kEqual || are_equal_ranges_coded(shape, around, samples, bounds));
}

template <class Word>
bool BoundsCodec<Word>::are_equal_ranges_coded(const PageShape& shape, const Surroundings<Word>& around,
                                               const PageSamples<Word>& samples,
                                               const PageBounds<Word>& bounds) const {
  const auto page = std::make_unique<Page<Word>>(Page<Word>{samples, bounds});
  return BoundsSymbols<Word>(geometry_, rounding_, shape, around, *page).summary().range_mode() ==
         RangeMode::kEqual;
}

ADAMAS_INSTANTIATE_FOR_WORDS(BoundsSurvey);
ADAMAS_INSTANTIATE_FOR_WORDS(BoundsCodec);

}  // namespace adamas::isosurface
