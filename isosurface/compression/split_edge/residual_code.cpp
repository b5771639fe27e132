#include "isosurface/compression/split_edge/residual_code.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "isosurface/compression/entropy/prefix_code.h"

namespace adamas::isosurface {
namespace {

/// The number of bits of the stream that index the tables: any codeword, or short ones with the bits after
/// them.
constexpr int kWindowBits = CanonicalHuffman::kMaxLength;
constexpr std::size_t kWindows = std::size_t{1} << kWindowBits;

/// A residual with all its bits; its length is 0 where the window does not have all of them.
struct Whole {
  std::int32_t value = 0;
  int symbol = 0;
  int length = 0;
};

Whole whole_at(const CanonicalHuffman& code, LeadOne lead_one, std::uint32_t window, int available) {
  const CanonicalHuffman::Match match = code.match(window);
  const int extra_bits = lead_one.extra_bits(match.symbol);
  const int length = match.length + extra_bits;
  if (match.length == 0 || length > available) return {};
  const std::uint32_t extra = window >> match.length & ((1u << extra_bits) - 1);
  const std::uint32_t residual = lead_one.join({match.symbol, extra});
  const int unused = LeadOne::kMaxBits - lead_one.bits();
  return {static_cast<std::int32_t>(residual << unused) >> unused, match.symbol, length};
}

// An entry has, from its lowest bit: 6 bits for the number of bits found; 2 for the number of residuals,
// which is 0 for a codeword alone, or for none and then the number of bits is 0; 6 for the last symbol; 6 for
// the second residual and 12 for the first, signed.
constexpr int kCountAt = 6, kSymbolAt = 8, kSecondAt = 14, kFirstAt = 20;

constexpr bool fits(std::int32_t value, int bits) {
  return value >= -(1 << (bits - 1)) && value < 1 << (bits - 1);
}

std::uint32_t pack(int length, int count, int symbol, std::int32_t first, std::int32_t second) {
  const auto field = [](std::int32_t value, int at) { return static_cast<std::uint32_t>(value) << at; };
  return field(first, kFirstAt) | field(second & 63, kSecondAt) | field(symbol, kSymbolAt) |
         field(count, kCountAt) | field(length, 0);
}

int length_of(std::uint32_t entry) { return static_cast<int>(entry & 63); }
std::uint32_t count_of(std::uint32_t entry) { return entry >> kCountAt & 3; }
std::uint32_t symbol_of(std::uint32_t entry) { return entry >> kSymbolAt & 63; }
std::uint32_t first_of(std::uint32_t entry) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(entry) >> kFirstAt);
}
std::uint32_t second_of(std::uint32_t entry) {
  const auto at_top = static_cast<std::int32_t>(entry << (32 - kFirstAt));
  return static_cast<std::uint32_t>(at_top >> (32 - kFirstAt + kSecondAt));
}

}  // namespace

ResidualCode::ResidualCode(LeadOne lead_one, std::vector<CanonicalHuffman> codes)
    : lead_one_(lead_one), codes_(std::move(codes)) {
  entries_.reserve(codes_.size() * kWindows);
  for (int previous = 0; previous < lead_one_.symbols(); ++previous) {
    for (std::uint32_t window = 0; window < kWindows; ++window) {
      entries_.push_back(entry_of(previous, window));
    }
  }
}

ResidualCode::Entry ResidualCode::entry_of(int previous, std::uint32_t window) const {
  const auto code = [this](int symbol) -> const CanonicalHuffman& {
    return codes_[static_cast<std::size_t>(symbol)];
  };
  const Whole first = whole_at(code(previous), lead_one_, window, kWindowBits);
  if (first.length == 0 || !fits(first.value, 32 - kFirstAt)) {
    const CanonicalHuffman::Match match = code(previous).match(window);
    return pack(match.length, 0, match.symbol, 0, 0);
  }
  const Whole second =
      whole_at(code(first.symbol), lead_one_, window >> first.length, kWindowBits - first.length);
  if (second.length == 0 || !fits(second.value, kFirstAt - kSecondAt)) {
    return pack(first.length, 1, first.symbol, first.value, 0);
  }
  return pack(first.length + second.length, 2, second.symbol, first.value, second.value);
}

ResidualCode::ResidualCode(const ResidualStatistics& statistics)
    : ResidualCode(LeadOne(statistics.bits()), [&statistics] {
        std::vector<CanonicalHuffman> codes;
        for (int previous = 0; previous <= statistics.bits(); ++previous) {
          codes.emplace_back(package_merge(statistics.counts(previous), CanonicalHuffman::kMaxLength));
        }
        return codes;
      }()) {}

std::vector<std::byte> ResidualCode::serialise() const {
  std::vector<std::byte> tables;
  BitWriter out(tables);
  for (const CanonicalHuffman& code : codes_) code.write(out);
  out.finish();
  ADAMAS_ASSERT(tables.size() <= kMaxTableBytes);
  return tables;
}

ResidualCode ResidualCode::parse(std::span<const std::byte> tables, int bits, std::string_view name) {
  const LeadOne lead_one(bits);
  BitReader in(tables);
  std::vector<CanonicalHuffman> codes;
  for (int previous = 0; previous < lead_one.symbols(); ++previous) {
    codes.push_back(CanonicalHuffman::read(in, static_cast<std::size_t>(lead_one.symbols()),
                                           fmt::format("{}: prefix code after symbol {}", name, previous)));
  }
  if (!in.at_end()) fail("{}: expected the end after {} prefix codes, found more data", name, codes.size());
  return {lead_one, std::move(codes)};
}

bool ResidualCode::codes(std::span<const std::uint32_t> residuals) const {
  int previous = 0;
  for (const std::uint32_t residual : residuals) {
    const int symbol = lead_one_.split(residual).symbol;
    if (codes_[static_cast<std::size_t>(previous)].words()[static_cast<std::size_t>(symbol)].length == 0) {
      return false;
    }
    previous = symbol;
  }
  return true;
}

void ResidualCode::encode(std::span<const std::uint32_t> residuals, std::vector<std::byte>& out) const {
  BitWriter writer(out);
  int previous = 0;
  for (const std::uint32_t residual : residuals) {
    const auto [symbol, extra] = lead_one_.split(residual);
    const CanonicalHuffman::Word word =
        codes_[static_cast<std::size_t>(previous)].words()[static_cast<std::size_t>(symbol)];
    if (word.length == 0) {
      fail("residual code: expected a residual that its statistics count, found symbol {} after {}", symbol,
           previous);
    }
    writer.put(word.bits | std::uint64_t{extra} << word.length, word.length + lead_one_.extra_bits(symbol));
    previous = symbol;
  }
  writer.finish();
}

bool ResidualCode::decode(std::span<const std::byte> page, std::span<std::uint32_t> residuals) const {
  BitReader in(page);
  int previous = 0;
  if (!decode_most(in, previous, residuals)) return false;
  for (std::uint32_t& residual : residuals) {
    if (!decode_one(in, previous, residual)) return false;
  }
  return in.at_end();
}

/// Decodes residuals from the front and removes them from the span, until fewer than 2 * kAtOnce are left.
bool ResidualCode::decode_most(BitReader& reader, int& previous, std::span<std::uint32_t>& residuals) const {
  constexpr int kAtOnce = BitReader::kRefilled / kWindowBits;
  // This copy, which no pointer refers to, stays in registers.
  BitReader in = reader;
  const LeadOne lead_one = lead_one_;
  const Entry* const entries = entries_.data();
  std::uint32_t* out = residuals.data();
  std::uint32_t* const end = out + residuals.size();
  Entry entry = pack(0, 0, previous, 0, 0);
  while (end - out >= 2 * kAtOnce) {
    in.refill();
    for (int n = 0; n < kAtOnce; ++n) {
      entry = entries[symbol_of(entry) * kWindows + (in.window() & (kWindows - 1))];
      // If there is only one residual, the next one overwrites the second.
      out[0] = first_of(entry) & lead_one.mask();
      out[1] = second_of(entry) & lead_one.mask();
      in.skip(length_of(entry));
      out += count_of(entry);
      if (count_of(entry) == 0) [[unlikely]] {
        if (length_of(entry) == 0) return false;
        const int symbol = static_cast<int>(symbol_of(entry));
        in.refill();
        *out++ = lead_one.join({symbol, static_cast<std::uint32_t>(in.take(lead_one.extra_bits(symbol)))});
        in.refill();
      }
    }
  }
  previous = static_cast<int>(symbol_of(entry));
  reader = in;
  residuals = {out, end};
  return true;
}

bool ResidualCode::decode_one(BitReader& in, int& previous, std::uint32_t& residual) const {
  in.refill();
  const CanonicalHuffman::Match match = codes_[static_cast<std::size_t>(previous)].match(in.window());
  if (match.length == 0) return false;
  in.skip(match.length);
  previous = match.symbol;
  residual = lead_one_.join({previous, static_cast<std::uint32_t>(in.take(lead_one_.extra_bits(previous)))});
  return true;
}

}  // namespace adamas::isosurface
