#include "isosurface/compression/interpolation_codec.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "isosurface/compression/interpolation_page.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/compression/wide_lanes.h"

namespace adamas {
namespace {

constexpr int kLengthBits = 4;
/// Bits below the leading 1 of the least state.
constexpr int kLeastBits = SymbolFrequencies::kScaleBits;
/// Activities of 8-bit samples have a table of their groups.
constexpr std::size_t kActivities = std::size_t{1} << ActivityContext<std::uint8_t>::kBits;

/// Groups by activity: what ContextGroups says of contexts.
template <class Word>
std::vector<std::uint8_t> groups_of_activities(std::span<const std::uint8_t> groups) {
  std::vector<std::uint8_t> result;
  if constexpr (sizeof(Word) == 1) {
    for (std::size_t set = 0; set < InterpolationCells<Word>::kSets; ++set) {
      for (std::size_t activity = 0; activity < kActivities; ++activity) {
        const std::size_t first = set * InterpolationCodec<Word>::kContextsOfSet;
        result.push_back(groups[first + ActivityContext<Word>::of(activity)]);
      }
    }
  }
  return result;
}

}  // namespace

/// Takes residuals from a page's bytes.
template <class Word>
class InterpolationCodec<Word>::Reader {
 public:
  Reader(const InterpolationCodec& codec, std::span<const std::byte> bytes)
      : codec_(codec), bits_(bytes), size_(bytes.size()) {
    ADAMAS_ASSERT(size_ <= kMostBytes);
    std::memset(buffer_.data(), 0, RangeDecoder::kSlack);
    std::memcpy(buffer_.data() + RangeDecoder::kSlack, bytes.data(), size_);
    RangeTables::States states;
    for (std::uint32_t& x : states) {
      bits_.refill();
      const int length = kLeastBits + static_cast<int>(take(kLengthBits));
      x = 1u << length | static_cast<std::uint32_t>(take(length));
    }
    decoder_.emplace(codec.tables_, states, begin(), begin() + size_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// A page that is longer is not one.
  static constexpr std::size_t kMostBytes = PageGrid::kPoints * sizeof(Word);

  /// One residual per group.
  bool take(std::span<const std::uint8_t> groups, Word* folded) {
    if constexpr (sizeof(Word) == 1) {
      return decoder_->take(groups, folded) && join(groups, folded, folded);
    } else {
      std::array<std::uint8_t, PageGrid::kPoints> symbols;
      return decoder_->take(groups, symbols.data()) && join(groups, symbols.data(), folded);
    }
  }

  /// Whether all bytes were used, and as `write` gives them.
  [[nodiscard]] bool at_end() const {
    const std::size_t bytes = (taken_ + 7) / 8;
    if (!decoder_->at_start() || !any_ || decoder_->words() != begin() + bytes) return false;
    return taken_ % 8 == 0 || std::to_integer<unsigned>(begin()[bytes - 1]) >> taken_ % 8 == 0;
  }

 private:
  using Token = ResidualToken<Word>;

  [[nodiscard]] const std::byte* begin() const { return buffer_.data() + RangeDecoder::kSlack; }

  std::uint64_t take(int bits) {
    taken_ += static_cast<std::size_t>(bits);
    return bits_.take(bits);
  }

  /// Adds what the symbols leave open.
  bool join(std::span<const std::uint8_t> groups, const std::uint8_t* symbols, Word* folded) {
    constexpr std::uint64_t kEach = 0x0101010101010101u, kOpen = kEach * 0xf0, kHighest = kEach << 7;
    static_assert(Token::kDirect == 16);
    std::size_t n = 0;
    for (; n + 8 <= groups.size(); n += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, symbols + n, sizeof eight);
      any_ = any_ || eight != 0;
      // The lowest byte that is 0, of those that differ from the escape's, has its highest bit here.
      const std::uint64_t other = eight ^ kEach * Token::kEscape;
      if ((eight & kOpen) == 0) {
        if constexpr (sizeof(Word) > 1) std::copy_n(symbols + n, 8, folded + n);
      } else if (((other - kEach) & ~other & kHighest) == 0) {
        join_tokens(symbols + n, folded + n);
      } else {
        for (std::size_t m = n; m < n + 8; ++m) {
          if (!join_one(groups[m], symbols[m], folded[m])) return false;
        }
      }
    }
    for (; n < groups.size(); ++n) {
      any_ = any_ || symbols[n] != 0;
      if (!join_one(groups[n], symbols[n], folded[n])) return false;
    }
    return true;
  }

  /// Eight symbols that are tokens, without branches, for which there is no telling.
  void join_tokens(const std::uint8_t* symbols, Word* folded) {
    struct Entry {
      Word first = 0;         ///< the least number that is folded to the token
      std::uint8_t open = 0;  ///< bits that it leaves open
    };
    static constexpr auto kEntries = [] {
      std::array<Entry, Token::kTokens> entries;
      for (int token = 0; token < Token::kTokens; ++token)
        entries[static_cast<std::size_t>(token)] = {Token::join(token, 0),
                                                    static_cast<std::uint8_t>(Token::extra_bits(token))};
      return entries;
    }();
    constexpr int kPerRefill = BitReader::kRefilled / Token::extra_bits(Token::kTokens - 1);
    for (int m = 0; m < 8; ++m) {
      if (m % kPerRefill == 0) bits_.refill();
      const Entry entry = kEntries[symbols[m]];
      folded[m] = static_cast<Word>(entry.first | take(entry.open));
    }
  }

  bool join_one(std::size_t group, int symbol, Word& folded) {
    if (symbol < Token::kDirect) {
      folded = static_cast<Word>(symbol);
      return true;
    }
    bits_.refill();
    if (symbol == Token::kEscape) {
      symbol = static_cast<int>(take(Token::kTokenBits));
      if (codec_.tables_.has(group, static_cast<std::size_t>(symbol))) return false;
    }
    folded = Token::join(symbol, static_cast<Word>(take(Token::extra_bits(symbol))));
    return true;
  }

  const InterpolationCodec& codec_;
  BitReader bits_;
  std::size_t size_;
  std::size_t taken_ = 0;  ///< bits
  bool any_ = false;       ///< whether a residual was not zero
  std::array<std::byte, RangeDecoder::kSlack + kMostBytes> buffer_;
  std::optional<RangeDecoder> decoder_;
};

template <class Word>
InterpolationCodec<Word>::InterpolationCodec(ContextGroups groups)
    : groups_(std::move(groups)),
      tables_(groups_.frequencies()),
      group_of_activity_(groups_of_activities<Word>(groups_.groups())) {}

template <class Word>
InterpolationCodec<Word> InterpolationCodec<Word>::parse(std::span<const std::byte> tables,
                                                         std::string_view name) {
  BitReader in(tables);
  const auto symbols = static_cast<std::size_t>(ResidualToken<Word>::kTokens + 1);
  ContextGroups groups = ContextGroups::read(in, kContexts, symbols, name);
  if (!in.at_end()) {
    fail("{}: expected the end after {} tables of frequencies, found {} data", name,
         groups.frequencies().size(), in.overrun() ? "too little" : "more");
  }
  return InterpolationCodec(std::move(groups));
}

template <class Word>
std::vector<std::byte> InterpolationCodec<Word>::tables() const {
  std::vector<std::byte> tables;
  BitWriter out(tables);
  groups_.write(out);
  out.finish();
  return tables;
}

template <class Word>
auto InterpolationCodec<Word>::group_of(int set) const {
  if constexpr (sizeof(Word) == 1) {
    const std::uint8_t* const groups =
        group_of_activity_.data() + static_cast<std::size_t>(set) * kActivities;
    return [groups](auto activity) { return groups[activity]; };
  } else {
    const std::uint8_t* const groups =
        groups_.groups().data() + static_cast<std::size_t>(set) * kContextsOfSet;
    return [groups](auto activity) { return groups[ActivityContext<Word>::of(activity)]; };
  }
}

template <class Word>
void InterpolationCodec<Word>::encode(const PageShape& shape, const Around& around, const Samples& samples,
                                      std::vector<std::byte>& out) const {
  std::array<std::uint8_t, PageGrid::kPoints> groups;
  std::array<Word, PageGrid::kPoints> folded;
  const std::size_t count = own_points(shape);
  if (shape.complete) {
    std::size_t n = 0;
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      const Word prediction = predicted_inside<Word>(q, shape, samples);
      groups[n] = groups_.groups()[kComplete];
      folded[n++] = ResidualToken<Word>::fold(static_cast<Word>(samples[PageGrid::place(q, 0)] - prediction));
    });
  } else {
    InterpolationPage<Word> page(shape.count, around);
    std::size_t n = 0;
    for (int set = 0; set < InterpolationCells<Word>::kSets; n += page.size(set++)) {
      page.predict(set);
      page.contexts(set, group_of(set), groups.data() + n);
      page.residuals(set, samples, folded.data() + n);
      page.apply(set, folded.data() + n);
    }
  }
  if (std::all_of(folded.begin(), folded.begin() + static_cast<std::ptrdiff_t>(count),
                  [](Word residual) { return residual == 0; })) {
    out.push_back(static_cast<std::byte>(PageKind::kSmooth));
    return;
  }
  const std::size_t begin = out.size();
  out.push_back(static_cast<std::byte>(PageKind::kResiduals));
  write(std::span(groups).first(count), std::span(folded).first(count), out);
  if (out.size() - begin - 1 < count * sizeof(Word)) return;
  out.resize(begin);
  write_raw<Word>(shape, samples, out);
}

template <class Word>
void InterpolationCodec<Word>::write(std::span<const std::uint8_t> groups, std::span<const Word> folded,
                                     std::vector<std::byte>& out) const {
  using Token = ResidualToken<Word>;
  const auto symbol = [this, groups, folded](std::size_t n) {
    const int token = Token::token(folded[n]);
    return static_cast<std::size_t>(tables_.has(groups[n], static_cast<std::size_t>(token)) ? token
                                                                                            : Token::kEscape);
  };
  RangeTables::States states;
  states.fill(RangeTables::kLeast);
  std::vector<std::byte> words;
  // The sets begin with the first state, and each takes a multiple of kStates.
  for (std::size_t n = groups.size(); n-- > 0;) {
    tables_.push(states[n % RangeTables::kStates], groups[n], symbol(n), words);
  }
  BitWriter bits(out);
  for (const std::uint32_t x : states) {
    const int length = std::bit_width(x) - 1;
    bits.put(static_cast<std::uint64_t>(length - kLeastBits), kLengthBits);
    bits.put(x ^ 1u << length, length);
  }
  for (std::size_t n = 0; n < groups.size(); ++n) {
    const int token = Token::token(folded[n]), open = Token::extra_bits(token);
    if (symbol(n) == Token::kEscape) bits.put(static_cast<std::uint64_t>(token), Token::kTokenBits);
    if (open > 0) bits.put(folded[n] & ((std::uint64_t{1} << open) - 1), open);
  }
  bits.finish();
  out.insert(out.end(), words.begin(), words.end());
}

template <class Word>
bool InterpolationCodec<Word>::decode(std::span<const std::byte> bytes, const PageShape& shape,
                                      const Around& around, Samples& samples) const {
  if (bytes.empty()) return false;
  const auto kind = static_cast<PageKind>(bytes[0]);
  const auto code = bytes.subspan(1);
  if (kind == PageKind::kRaw) {
    if (!shape.complete) take_coarser<Word>(around, samples);
    return read_raw<Word>(code, shape, samples);
  }
  if (kind == PageKind::kSmooth) return code.empty() && decode_smooth(shape, around, samples);
  if (kind != PageKind::kResiduals || code.size() >= own_points(shape) * sizeof(Word)) return false;
  Reader reader(*this, code);
  return shape.complete ? decode_complete(reader, shape, samples)
                        : decode_sets(reader, shape, around, samples);
}

template <class Word>
bool InterpolationCodec<Word>::decode_smooth(const PageShape& shape, const Around& around,
                                             Samples& samples) const {
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      samples[PageGrid::place(q, 0)] = predicted_inside<Word>(q, shape, samples);
    });
    return true;
  }
  with_wide_lanes([&](auto) {
    InterpolationPage<Word> page(shape.count, around);
    for (int set = 0; set < InterpolationCells<Word>::kSets; ++set) page.predict(set);
    page.store(samples);
  });
  return true;
}

template <class Word>
bool InterpolationCodec<Word>::decode_sets(Reader& reader, const PageShape& shape, const Around& around,
                                           Samples& samples) const {
  using Page = InterpolationPage<Word>;
  Page page(shape.count, around);
  std::array<std::uint8_t, Page::kMostInSet> groups;
  std::array<Word, Page::kMostInSet> folded;
  for (int set = 0; set < InterpolationCells<Word>::kSets; ++set) {
    with_wide_lanes([&](auto) {
      page.predict(set);
      page.contexts(set, group_of(set), groups.data());
    });
    if (!reader.take(std::span(groups).first(page.size(set)), folded.data())) return false;
    with_wide_lanes([&](auto) { page.apply(set, folded.data()); });
  }
  with_wide_lanes([&](auto) { page.store(samples); });
  return reader.at_end();
}

template <class Word>
bool InterpolationCodec<Word>::decode_complete(Reader& reader, const PageShape& shape,
                                               Samples& samples) const {
  std::array<std::uint8_t, PageGrid::kPoints> groups;
  std::array<Word, PageGrid::kPoints> folded;
  const std::size_t count = own_points(shape);
  std::fill_n(groups.begin(), count, groups_.groups()[kComplete]);
  if (!reader.take(std::span(groups).first(count), folded.data())) return false;
  const Word* next = folded.data();
  for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
    const Word prediction = predicted_inside<Word>(q, shape, samples);
    samples[PageGrid::place(q, 0)] = static_cast<Word>(prediction + ResidualToken<Word>::unfold(*next++));
  });
  return reader.at_end();
}

template class InterpolationCodec<std::uint8_t>;
template class InterpolationCodec<std::uint16_t>;
template class InterpolationCodec<std::uint32_t>;

}  // namespace adamas
