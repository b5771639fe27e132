#include "isosurface/compression/value_codec.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "isosurface/compression/bit_stream.h"
#include "isosurface/compression/row_lanes.h"
#include "isosurface/compression/value_symbols.h"

namespace adamas {
namespace {

// A page is a byte of modes, errors lowest; the code of all errors where that is their mode; and where
// something is coded the length of the symbols' bytes in two bytes, these, and the bits that symbols leave
// open.
constexpr int kRangeModeAt = 2;
constexpr std::size_t kLengthBytes = 2;

std::byte head(ErrorMode errors, RangeMode ranges) {
  return static_cast<std::byte>(static_cast<int>(errors) | static_cast<int>(ranges) << kRangeModeAt);
}

/// The decoder's part of walk_values.
template <class Word>
class ValueReader {
 public:
  ValueReader(const ContextCoder& coder, std::span<const std::byte> symbols,
              std::span<const std::byte> extras, const PageShape& shape, ErrorMode error_mode,
              RangeMode range_mode, ValueFields<Word>& fields)
      : shape_(shape),
        error_mode_(error_mode),
        range_mode_(range_mode),
        fields_(fields),
        decoder_(coder, symbols),
        extras_(extras) {}

  static constexpr bool kFills = true;
  [[nodiscard]] bool needs_errors() const { return is_coded(error_mode_); }
  [[nodiscard]] bool needs_ranges() const { return range_mode_ != RangeMode::kEmpty; }

  void errors(int /*phase*/, const ValueStage& stage) {
    const std::size_t size = stage.size;
    decoder_.decode({stage.contexts.data(), size}, {symbols_.data(), size});
    unsigned all = 0, sure = 0;
    for (std::size_t n = 0; n < size; ++n) all |= symbols_[n];
    for (std::size_t n = 0; error_mode_ == ErrorMode::kCoded && n < size; ++n)
      sure |= stage.contexts[n] == ErrorStages<Word>::kSure ? symbols_[n] : 0u;
    const PaddedGrid<std::uint8_t>& predicted = fields_.predicted;
    PaddedGrid<std::uint8_t>& errors = fields_.errors;
    for (std::size_t n = 0; n < size; ++n) {
      const std::size_t place = stage.places[n];
      errors[place] = static_cast<std::uint8_t>((symbols_[n] + predicted[place]) & 63);
    }
    summary_.any_sure_error_other |= sure != 0;
    good_ = good_ && all < ValueContexts<Word>::kErrorSymbols;
  }

  void range(int /*phase*/, std::size_t side, const ValueStage& stage) {
    if (range_mode_ == RangeMode::kPredicted) return;
    const std::size_t size = stage.size;
    decoder_.decode({stage.contexts.data(), size}, {symbols_.data(), size});
    const PaddedGrid<Word>&known = fields_.known[side], &bounds = fields_.bounds[side];
    PaddedGrid<Word>& values = fields_.values[side];
    BitReader extras = extras_;
    unsigned all = 0, sure = 0;
    bool good = true;
    for (std::size_t n = 0; n < size; ++n) {
      const std::uint8_t symbol = symbols_[n];
      if (symbol == RangeToken<Word>::kPredicted) continue;
      all |= symbol;
      sure |= stage.contexts[n] == kSureRange ? symbol : 0u;
      const std::size_t place = stage.places[n];
      const Word predicted = known[place], bound = std::min(bounds[place], predicted);
      if (symbol == RangeToken<Word>::kBound) {
        good = good && bound != predicted;
        values[place] = bound;
      } else {
        values[place] = word(symbol, predicted, bound, extras, good);
      }
    }
    extras_ = extras;
    good_ = good_ && good;
    static_assert(RangeToken<Word>::kPredicted == 0);
    summary_.any_other |= all != 0;
    summary_.any_sure_range_other |= sure != 0;
  }

  /// Whether the page is one that is coded so.
  [[nodiscard]] bool finish() {
    const bool coded = is_coded(error_mode_) || is_coded(range_mode_);
    if (!good_ || (coded && (!decoder_.finish() || !extras_.at_end()))) return false;
    summary_.add_errors(shape_, fields_);
    if (needs_ranges()) summary_.add_ranges(shape_, fields_);
    return summary_.error_mode() == error_mode_ && summary_.range_mode() == range_mode_;
  }

 private:
  static constexpr std::uint16_t kSureRange = ValueContexts<Word>::kRanges + RangeStages<Word>::kSure;

  static Word word(std::uint8_t symbol, Word predicted, Word bound, BitReader& extras, bool& good) {
    using Token = RangeToken<Word>;
    if (symbol > Token::kBehind) {
      good = false;
      return predicted;
    }
    extras.refill();
    const auto extra = static_cast<std::uint32_t>(extras.take(Token::extra_bits(symbol)));
    const Word value = Token{symbol, extra}.value(predicted);
    // Else another token would stand for it.
    good = good && value != bound && (value > predicted) == (symbol == Token::kBehind);
    return value;
  }

  PageShape shape_;
  ErrorMode error_mode_;
  RangeMode range_mode_;
  ValueFields<Word>& fields_;
  ContextDecoder decoder_;
  BitReader extras_;
  ValueSummary summary_;
  bool good_ = true;
  std::array<std::uint8_t, ValueStage::kMost> symbols_;
};

/// The page's values from the fields.
template <class Word>
void store_values(const ValueFields<Word>& fields, const PageShape& shape, Page<Word>& page) {
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const LatticePoint row{0, j, k};
      const std::size_t to = PageGrid::place(row, 0);
      std::copy_n(fields.values[0].at(row), PageGrid::kSide, page.low.data() + to);
      std::copy_n(fields.errors.at(row), PageGrid::kSide, page.errors.data() + to);
      const Word* high = fields.values[1].at(row);
      for (std::size_t i = 0; i < PageGrid::kSide; ++i) page.high[to + i] = static_cast<Word>(~high[i]);
    }
  }
}

}  // namespace

template <class Word>
ValueSurvey<Word>::ValueSurvey(const Vec3& spacing)
    : geometry_(spacing), counts_(ValueContexts<Word>::kCount, ValueContexts<Word>::kSymbols) {}

template <class Word>
void ValueSurvey<Word>::add(const PageShape& shape, const Surroundings<Word>& around,
                            const Page<Word>& page) {
  const ValueSymbols<Word> symbols(geometry_, shape, around, page);
  for (const auto& stage : symbols.stages()) {
    for (std::size_t n = 0; n < stage.symbols.size(); ++n) counts_.add(stage.contexts[n], stage.symbols[n]);
  }
}

template <class Word>
std::vector<std::byte> ValueCodec<Word>::tables() const {
  std::vector<std::byte> bytes;
  BitWriter out(bytes);
  coder_.write(out);
  out.finish();
  return bytes;
}

template <class Word>
ValueCodec<Word> ValueCodec<Word>::parse(std::span<const std::byte> tables, const Vec3& spacing,
                                         std::string_view name) {
  BitReader in(tables);
  ContextCoder coder =
      ContextCoder::read(in, ValueContexts<Word>::kCount, ValueContexts<Word>::kSymbols, name);
  if (!in.at_end()) fail("{}: expected the end after the tables of values, found more data", name);
  return ValueCodec(ErrorGeometry(spacing), std::move(coder));
}

template <class Word>
void ValueCodec<Word>::encode(const PageShape& shape, const Surroundings<Word>& around,
                              const Page<Word>& page, std::vector<std::byte>& out) const {
  const ValueSymbols<Word> symbols(geometry_, shape, around, page);
  const ErrorMode errors = symbols.summary().error_mode();
  const RangeMode ranges = symbols.summary().range_mode();
  out.push_back(head(errors, ranges));
  if (errors == ErrorMode::kEqual) out.push_back(static_cast<std::byte>(symbols.summary().any_error));
  if (!is_coded(errors) && !is_coded(ranges)) return;
  ContextEncoder encoder(coder_);
  for (const auto& stage : symbols.stages()) encoder.put(stage.contexts, stage.symbols);
  const std::size_t at = out.size();
  out.resize(at + kLengthBytes);
  encoder.finish(out);
  const std::size_t length = out.size() - at - kLengthBytes;
  out[at] = static_cast<std::byte>(length & 0xff);
  out[at + 1] = static_cast<std::byte>(length >> 8);
  BitWriter extras(out);
  for (const auto& [bits, count] : symbols.extras()) extras.put(bits, count);
  extras.finish();
}

template <class Word>
bool ValueCodec<Word>::decode(std::span<const std::byte> bytes, const PageShape& shape,
                              const Surroundings<Word>& around, Page<Word>& page) const {
  if (bytes.empty()) return false;
  const auto modes = std::to_integer<std::uint8_t>(bytes[0]);
  const auto errors = static_cast<ErrorMode>(modes & 3);
  const auto ranges = static_cast<RangeMode>(modes >> kRangeModeAt);
  if (errors > ErrorMode::kCoded || ranges > RangeMode::kCoded) return false;
  bytes = bytes.subspan(1);
  std::uint8_t error = 0;
  if (errors == ErrorMode::kEqual) {
    if (bytes.empty()) return false;
    error = std::to_integer<std::uint8_t>(bytes[0]);
    const bool any_point = shape.complete || shape.count != LatticePoint{1, 1, 1};
    if (error == 0 || error >= ValueContexts<Word>::kErrorSymbols || !any_point) return false;
    bytes = bytes.subspan(1);
  }
  const bool coded = is_coded(errors) || is_coded(ranges);
  std::size_t length = 0;
  if (coded) {
    if (bytes.size() < kLengthBytes) return false;
    length = std::to_integer<std::size_t>(bytes[0]) | std::to_integer<std::size_t>(bytes[1]) << 8;
    bytes = bytes.subspan(kLengthBytes);
    if (bytes.size() < length) return false;
  } else if (!bytes.empty()) {
    return false;
  }
  ValueFields<Word> fields;
  fields.load(shape, around, page);
  if (!is_coded(errors)) fields.fill_errors(shape, error);
  ValueReader<Word> reader(coder_, bytes.first(length), bytes.subspan(length), shape, errors, ranges, fields);
  if (shape.complete) {
    walk_complete_values<Word>(fields, shape, reader);
  } else {
    const ValueTrust trust{errors != ErrorMode::kCoded, ranges != RangeMode::kCoded};
    walk_values<Word>(fields, geometry_, shape, trust, reader);
  }
  store_values(fields, shape, page);
  return reader.finish();
}

template class ValueSurvey<std::uint8_t>;
template class ValueSurvey<std::uint16_t>;
template class ValueSurvey<std::uint32_t>;
template class ValueCodec<std::uint8_t>;
template class ValueCodec<std::uint16_t>;
template class ValueCodec<std::uint32_t>;

}  // namespace adamas
