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
  for (std::size_t n = items_.size(); n-- > 0;) {
    const auto [context, symbol, lane] = items_[n];
    ContextCoder::Range range = coder_.range(context, symbol);
    if (range.frequency == 0) {
      stream.push(lane, symbol, 1, kEscapedBits);
      range = coder_.escape(context);
    }
    stream.push(lane, range.start, range.frequency, ContextCoder::kScaleBits);
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

std::uint8_t ContextDecoder::decode_escaped(std::uint32_t& state, std::size_t context) {
  const std::uint32_t symbol = state & ((1u << kEscapedBits) - 1);
  state >>= kEscapedBits;
  renormalise(state);
  if (symbol < coder_.symbols() && coder_.range(context, symbol).frequency == 0)
    return static_cast<std::uint8_t>(symbol);
  good_ = false;
  return 0;
}

std::uint8_t ContextDecoder::decode_one(std::uint32_t& state, std::size_t context) {
  std::uint32_t symbol = 0;
  state = step(coder_.tables_view(context).entries(0), state, symbol);
  renormalise(state);
  return symbol == ContextCoder::kEscape ? decode_escaped(state, context) : static_cast<std::uint8_t>(symbol);
}

void ContextDecoder::decode(std::size_t base, std::span<const std::uint8_t> contexts,
                            std::span<std::uint8_t> symbols) {
  ADAMAS_ASSERT(contexts.size() == symbols.size());
  for (std::size_t n = decode_most(base, contexts, symbols); n < symbols.size(); ++n)
    symbols[n] = decode_one(states_[n % kLanes], base + contexts[n]);
}

/// Decodes as many at a time as there are states until the stream is near its end. Returns how many.
std::size_t ContextDecoder::decode_most(std::size_t base, std::span<const std::uint8_t> contexts,
                                        std::span<std::uint8_t> symbols) {
  // Each symbol takes a word at most, and one more after an escape.
  constexpr std::ptrdiff_t kMostBytes = 4 * kLanes;
  // Copies that nothing points to stay in registers.
  const auto tables = coder_.tables_view(base);
  std::array<std::uint32_t, kLanes> states = states_;
  const std::byte* next = next_;
  std::size_t n = 0;
  for (; n + kLanes <= symbols.size() && end_ - next >= kMostBytes; n += kLanes) {
#pragma GCC unroll 8
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      std::uint32_t symbol = 0;
      const std::uint32_t state = step(tables.entries(contexts[n + lane]), states[lane], symbol);
      // Without a branch, for which there is no telling: whether a word belongs to the state.
      const std::uint32_t low = state < ContextCoder::kLeastState ? ~0u : 0u;
      states[lane] = state << (low & kWordBits) | (load_word(next) & low);
      next += low & 2;
      if (symbol == ContextCoder::kEscape) [[unlikely]] {
        next_ = next;
        std::uint32_t escaped = states[lane];
        symbol = decode_escaped(escaped, base + contexts[n + lane]);
        states[lane] = escaped;
        next = next_;
      }
      symbols[n + lane] = static_cast<std::uint8_t>(symbol);
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
