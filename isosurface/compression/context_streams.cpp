#include <algorithm>

#include "isosurface/compression/context_coder.h"

namespace adamas {
namespace {

constexpr int kWordBits = 16;
constexpr int kEscapedBits = 8;
constexpr std::size_t kLanes = ContextCoder::kLanes;

/// States and words lie in the stream with the least byte first.
std::uint32_t load_word(const std::byte* at) {
  return std::to_integer<std::uint32_t>(at[0]) | std::to_integer<std::uint32_t>(at[1]) << 8;
}

std::uint32_t step(const ContextCoder::Entry* entries, std::uint32_t state, std::uint32_t& symbol) {
  const ContextCoder::Entry entry = entries[state & (ContextCoder::kScale - 1)];
  symbol = entry & 255;
  return (entry >> 8 & 0xfff) * (state >> ContextCoder::kScaleBits) + (entry >> 20);
}

/// The stream as it grows from its end: the decoder will take what comes last first.
struct BackwardStates {
  std::array<std::uint32_t, kLanes> states;
  std::vector<std::uint16_t> words;

  void push(std::size_t lane, std::uint32_t start, std::uint32_t frequency, int scale_bits) {
    std::uint32_t& state = states[lane];
    if (state >> (32 - scale_bits) >= frequency) {
      words.push_back(static_cast<std::uint16_t>(state));
      state >>= kWordBits;
    }
    state = ((state / frequency) << scale_bits) + state % frequency + start;
  }
};

}  // namespace

void ContextEncoder::put(std::size_t base, std::span<const std::uint8_t> contexts,
                         std::span<const std::uint8_t> symbols) {
  ADAMAS_ASSERT(contexts.size() == symbols.size());
  for (std::size_t n = 0; n < symbols.size(); ++n) {
    items_.push_back(
        {static_cast<std::uint16_t>(base + contexts[n]), symbols[n], static_cast<std::uint8_t>(n % kLanes)});
  }
}

void ContextEncoder::finish(std::vector<std::byte>& out) const {
  BackwardStates stream;
  stream.states.fill(ContextCoder::kLeastState);
  stream.words.reserve(items_.size() / 2);
  for (std::size_t end = items_.size(), begin = 0; end > 0; end = begin) {
    for (begin = end - 1; items_[begin].lane != 0;) --begin;
    // What is escaped in a row comes after the row.
    for (std::size_t n = end; n-- > begin;) {
      const auto [context, symbol, lane] = items_[n];
      if (coder_.range(context, symbol).frequency == 0) stream.push(lane, symbol, 1, kEscapedBits);
    }
    for (std::size_t n = end; n-- > begin;) {
      const auto [context, symbol, lane] = items_[n];
      const ContextCoder::Range own = coder_.range(context, symbol);
      const ContextCoder::Range range = own.frequency == 0 ? coder_.escape(context) : own;
      stream.push(lane, range.start, range.frequency, ContextCoder::kScaleBits);
    }
  }
  const auto append = [&out](std::uint32_t number, int bytes) {
    for (int n = 0; n < bytes; ++n) out.push_back(static_cast<std::byte>(number >> (8 * n) & 0xff));
  };
  for (const std::uint32_t state : stream.states) append(state, 4);
  for (std::size_t n = stream.words.size(); n-- > 0;) append(stream.words[n], 2);
}

ContextDecoder::ContextDecoder(const ContextCoder& coder, std::span<const std::byte> bytes)
    : coder_(coder), next_(bytes.data()), end_(bytes.data() + bytes.size()) {
  states_.fill(ContextCoder::kLeastState);
  if (bytes.size() < 4 * kLanes) {
    good_ = false;
    next_ = end_;
    return;
  }
  for (std::uint32_t& state : states_) {
    state = load_word(next_) | load_word(next_ + 2) << kWordBits;
    next_ += 4;
    good_ = good_ && state >= ContextCoder::kLeastState;
  }
}

void ContextDecoder::renormalise(std::uint32_t& state) {
  if (state >= ContextCoder::kLeastState) return;
  state <<= kWordBits;
  if (end_ - next_ < 2) {
    good_ = false;
    return;
  }
  state |= load_word(next_);
  next_ += 2;
}

void ContextDecoder::decode_escaped(std::size_t base, std::span<const std::uint8_t> contexts,
                                    std::uint8_t* symbols) {
  for (std::size_t lane = 0; lane < contexts.size(); ++lane) {
    if (symbols[lane] != ContextCoder::kEscape) continue;
    const std::uint32_t symbol = states_[lane] & ((1u << kEscapedBits) - 1);
    states_[lane] >>= kEscapedBits;
    renormalise(states_[lane]);
    const bool is_rare =
        symbol < coder_.symbols() && coder_.range(base + contexts[lane], symbol).frequency == 0;
    symbols[lane] = static_cast<std::uint8_t>(is_rare ? symbol : 0);
    good_ = good_ && is_rare;
  }
}

void ContextDecoder::decode(std::size_t base, std::span<const std::uint8_t> contexts,
                            std::span<std::uint8_t> symbols) {
  ADAMAS_ASSERT(contexts.size() == symbols.size());
  for (std::size_t n = decode_most(base, contexts, symbols); n < symbols.size(); n += kLanes) {
    const auto row = contexts.subspan(n, std::min(kLanes, symbols.size() - n));
    for (std::size_t lane = 0; lane < row.size(); ++lane) {
      std::uint32_t symbol = 0;
      states_[lane] = step(coder_.tables_view(base).entries(row[lane]), states_[lane], symbol);
      renormalise(states_[lane]);
      symbols[n + lane] = static_cast<std::uint8_t>(symbol);
    }
    decode_escaped(base, row, symbols.data() + n);
  }
}

/// Decodes rows of as many as there are states until the stream is near its end. Returns how many.
std::size_t ContextDecoder::decode_most(std::size_t base, std::span<const std::uint8_t> contexts,
                                        std::span<std::uint8_t> symbols) {
  constexpr std::ptrdiff_t kMostBytes = 2 * kLanes;
  // Copies that nothing points to stay in registers.
  const auto tables = coder_.tables_view(base);
  std::array<std::uint32_t, kLanes> states = states_;
  const std::byte* next = next_;
  std::size_t n = 0;
  for (; n + kLanes <= symbols.size() && end_ - next >= kMostBytes; n += kLanes) {
    std::uint32_t any = 0;
#pragma GCC unroll 8
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      std::uint32_t symbol = 0;
      const std::uint32_t state = step(tables.entries(contexts[n + lane]), states[lane], symbol);
      // Without a branch, for which there is no telling: whether a word belongs to the state.
      const std::uint32_t low = state < ContextCoder::kLeastState ? ~0u : 0u;
      states[lane] = state << (low & kWordBits) | (load_word(next) & low);
      next += low & 2;
      symbols[n + lane] = static_cast<std::uint8_t>(symbol);
      any |= symbol;
    }
    // Of all symbols the escape alone has the highest bit.
    if ((any & 128) != 0) [[unlikely]] {
      states_ = states;
      next_ = next;
      decode_escaped(base, contexts.subspan(n, kLanes), symbols.data() + n);
      states = states_;
      next = next_;
    }
  }
  states_ = states;
  next_ = next;
  return n;
}

bool ContextDecoder::finish() const {
  bool least = true;
  for (const std::uint32_t state : states_) least = least && state == ContextCoder::kLeastState;
  return good_ && least && next_ == end_;
}

}  // namespace adamas
