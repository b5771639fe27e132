#include "isosurface/compression/value_codec.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "isosurface/compression/bit_stream.h"
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

bool is_coded(RangeMode mode) { return mode == RangeMode::kCoded || mode == RangeMode::kCodedButSure; }

/// The decoder's part of walk_values.
template <class Word>
class ValueReader {
 public:
  using Codes = typename Page<Word>::template Points<std::uint8_t>;
  using Words = typename Page<Word>::template Points<Word>;

  ValueReader(const ContextCoder& coder, std::span<const std::byte> symbols,
              std::span<const std::byte> extras, ErrorMode error_mode, RangeMode range_mode)
      : decoder_(coder, symbols), extras_(extras), error_mode_(error_mode), range_mode_(range_mode) {}

  [[nodiscard]] bool needs_errors() const { return error_mode_ == ErrorMode::kCoded; }
  [[nodiscard]] bool needs_ranges() const { return range_mode_ != RangeMode::kEmpty; }

  void errors(const ValueStage<std::uint8_t>& stage, Codes& codes) {
    decoder_.decode({stage.contexts.data(), stage.size}, {symbols_.data(), stage.size});
    std::uint8_t all = 0;
    ValueSummary<Word> summary = summary_;
    for (std::size_t n = 0; n < stage.size; ++n) {
      all |= symbols_[n];
      const auto code = static_cast<std::uint8_t>((symbols_[n] + stage.predicted[n]) & 63);
      codes[stage.places[n]] = code;
      summary.add_error(code);
    }
    summary_ = summary;
    good_ = good_ && all < ValueContexts<Word>::kErrorSymbols;
  }

  void range(const ValueStage<Word>& stage, std::size_t side, Words& words) {
    copy_sure<Word>(
        stage, [&words](std::size_t place) { return words.data() + place; }, seen_from(side, Word{0}));
    summary_.add_sure(stage);
    if (range_mode_ == RangeMode::kPredicted) {
      for (std::size_t n = 0; n < stage.size; ++n) {
        const Word value = stage.predicted[n];
        summary_.add_range(value, value, false);
        words[stage.places[n]] = seen_from(side, value);
      }
      return;
    }
    decoder_.decode({stage.contexts.data(), stage.size}, {symbols_.data(), stage.size});
    ValueSummary<Word> summary = summary_;
    for (std::size_t n = 0; n < stage.size; ++n) {
      const Word predicted = stage.predicted[n];
      const Word value = word(symbols_[n], predicted, stage.bound[n]);
      summary.add_range(value, predicted, ValueContexts<Word>::is_sure(stage.contexts[n]));
      words[stage.places[n]] = seen_from(side, value);
    }
    summary_ = summary;
  }

  /// Whether the page is one that is coded so.
  [[nodiscard]] bool finish(bool coded) const {
    if (coded && (!decoder_.finish() || !extras_.at_end())) return false;
    const bool right_errors = !needs_errors() || summary_.error_mode() == error_mode_;
    return good_ && right_errors && summary_.range_mode() == range_mode_;
  }

 private:
  Word word(std::uint8_t symbol, Word predicted, Word bound) {
    using Token = RangeToken<Word>;
    if (symbol == Token::kPredicted) return predicted;
    Word value = bound;
    std::uint32_t extra = 0;
    if (symbol > Token::kBehind) {
      symbol = Token::kBound;
      good_ = false;
    }
    if (symbol != Token::kBound) {
      extras_.refill();
      extra = static_cast<std::uint32_t>(extras_.take(Token::extra_bits(symbol)));
      value = Token{symbol, extra}.value(predicted);
    }
    const Token token = Token::of(value, predicted, bound);
    good_ = good_ && token.symbol == symbol && token.extra == extra;
    return value;
  }

  ContextDecoder decoder_;
  BitReader extras_;
  ErrorMode error_mode_;
  RangeMode range_mode_;
  ValueSummary<Word> summary_;
  bool good_ = true;
  std::array<std::uint8_t, ValueStage<Word>::kMost> symbols_;
};

}  // namespace

template <class Word>
ValueSurvey<Word>::ValueSurvey() : counts_(ValueContexts<Word>::kCount, ValueContexts<Word>::kSymbols) {}

template <class Word>
void ValueSurvey<Word>::add(const PageShape& shape, const Surroundings<Word>& around,
                            const Page<Word>& page) {
  const ValueSymbols<Word> symbols(shape, around, page);
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
ValueCodec<Word> ValueCodec<Word>::parse(std::span<const std::byte> tables, std::string_view name) {
  BitReader in(tables);
  ContextCoder coder =
      ContextCoder::read(in, ValueContexts<Word>::kCount, ValueContexts<Word>::kSymbols, name);
  if (!in.at_end()) fail("{}: expected the end after the tables of values, found more data", name);
  return ValueCodec(std::move(coder));
}

template <class Word>
void ValueCodec<Word>::encode(const PageShape& shape, const Surroundings<Word>& around,
                              const Page<Word>& page, std::vector<std::byte>& out) const {
  const ValueSymbols<Word> symbols(shape, around, page);
  const ErrorMode errors = symbols.summary().error_mode();
  const RangeMode ranges = symbols.summary().range_mode();
  out.push_back(head(errors, ranges));
  if (errors == ErrorMode::kEqual) out.push_back(static_cast<std::byte>(symbols.summary().any_error));
  if (errors != ErrorMode::kCoded && !is_coded(ranges)) return;
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
  const bool coded = errors == ErrorMode::kCoded || is_coded(ranges);
  std::size_t length = 0;
  if (coded) {
    if (bytes.size() < kLengthBytes) return false;
    length = std::to_integer<std::size_t>(bytes[0]) | std::to_integer<std::size_t>(bytes[1]) << 8;
    bytes = bytes.subspan(kLengthBytes);
    if (bytes.size() < length) return false;
  } else if (!bytes.empty()) {
    return false;
  }
  ValueReader<Word> reader(coder_, bytes.first(length), bytes.subspan(length), errors, ranges);
  if (errors != ErrorMode::kCoded) page.errors.fill(error);
  if (ranges == RangeMode::kEmpty) {
    page.low.fill(ValueFields<Word>::kUnknown);
    page.high.fill(0);
  }
  if (shape.complete) {
    walk_complete_values<Word>(shape, page, reader);
  } else {
    fill_coarser_values(shape, around, page);
    const bool trust = ranges == RangeMode::kCodedButSure || ranges == RangeMode::kPredicted;
    walk_values<Word>(shape, around, page, trust, reader);
  }
  return reader.finish(coded);
}

template class ValueSurvey<std::uint8_t>;
template class ValueSurvey<std::uint16_t>;
template class ValueSurvey<std::uint32_t>;
template class ValueCodec<std::uint8_t>;
template class ValueCodec<std::uint16_t>;
template class ValueCodec<std::uint32_t>;

}  // namespace adamas
