#include "isosurface/compression/sample_ranks.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "isosurface/compression/bit_stream.h"
#include "isosurface/compression/page_order.h"

namespace adamas {
namespace {

constexpr int kCountBits = 16;
/// Of the table that ranks are looked up in.
constexpr int kTableBits = 16;

}  // namespace

SampleRanks::SampleRanks(std::vector<std::uint32_t> values) : values_(std::move(values)) {
  ADAMAS_ASSERT(!values_.empty() && values_.size() <= kMost);
  const std::uint32_t range = values_.back() - values_.front();
  shift_ = std::max(static_cast<int>(std::bit_width(range)) - kTableBits, 0);
  first_.resize(std::size_t{range >> shift_} + 1);
  std::size_t next = 0;
  for (std::uint32_t rank = 0; rank < values_.size(); ++rank) {
    const std::size_t at = (values_[rank] - values_.front()) >> shift_;
    for (; next <= at; ++next) first_[next] = rank;
  }
}

std::vector<std::byte> SampleRanks::write() const {
  std::vector<std::byte> bytes;
  BitWriter out(bytes);
  out.put(values_.size() - 1, kCountBits);
  std::uint64_t next = 0;
  for (const std::uint32_t value : values_) {
    put_delta(out, value - next + 1);
    next = std::uint64_t{value} + 1;
  }
  out.finish();
  return bytes;
}

SampleRanks SampleRanks::read(std::span<const std::byte> bytes, int bits, std::string_view name) {
  BitReader in(bytes);
  in.refill();
  const std::size_t count = in.take(kCountBits) + 1;
  std::vector<std::uint32_t> values;
  std::uint64_t next = 0;
  for (std::size_t n = 0; n < count && !in.overrun(); ++n) {
    const std::uint64_t step = take_delta(in), value = next + step - 1;
    if (step == 0 || value >> bits != 0)
      fail("{}: expected {} different samples of {} bits, found {}", name, count, bits, n);
    values.push_back(static_cast<std::uint32_t>(value));
    next = value + 1;
  }
  if (!in.at_end()) {
    fail("{}: expected the end after {} different samples, found {} data", name, count,
         in.overrun() ? "too little" : "more");
  }
  return SampleRanks(std::move(values));
}

template <class Word>
void SampleRanks::ranks(std::span<const Word> values, std::uint32_t* ranks) const {
  const std::uint32_t least = values_.front(), most = values_.back() - least;
  const std::uint32_t *const first = first_.data(), *const known = values_.data();
  const int shift = shift_;
  std::uint32_t other = 0;
  // Those that their upper bits tell: most often all.
  with_wide_lanes([&](auto) {
    std::uint32_t differing = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const std::uint32_t rank = first[std::min(values[n] - least, most) >> shift];
      differing |= known[rank] ^ values[n];
      ranks[n] = rank;
    }
    other = differing;
  });
  if (other == 0) return;
  for (std::size_t n = 0; n < values.size(); ++n) ranks[n] = rank(values[n]);
}

template <class Word>
void SampleCensus<Word>::add(const PageShape& shape, const PagePoints<Word>& samples) {
  if (values_.size() > kMost) return;
  samples_ += own_points(shape);
  for_each_own_place(shape, [&](std::size_t place) {
    if (values_.size() > kMost || (values_.size() > 0 && samples[place] == last_)) return;
    last_ = samples[place];
    values_.insert(last_);
  });
}

template <class Word>
std::shared_ptr<const SampleRanks> SampleCensus<Word>::ranks() const {
  const std::size_t count = values_.size();
  if (count == 0 || count > kMost || samples_ / kLeastOfEach < count) return nullptr;
  std::vector<std::uint32_t> sorted(values_.begin(), values_.end());
  std::ranges::sort(sorted);
  return std::make_shared<const SampleRanks>(std::move(sorted));
}

template void SampleRanks::ranks(std::span<const std::uint16_t>, std::uint32_t*) const;
template void SampleRanks::ranks(std::span<const std::uint32_t>, std::uint32_t*) const;
template class SampleCensus<std::uint8_t>;
template class SampleCensus<std::uint16_t>;
template class SampleCensus<std::uint32_t>;

}  // namespace adamas
