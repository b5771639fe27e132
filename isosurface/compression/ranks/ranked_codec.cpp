#include "isosurface/compression/ranks/ranked_codec.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "isosurface/compression/byte_stream.h"
#include "isosurface/compression/entropy/bit_stream.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {
namespace {

constexpr int kCountBits = 16;
/// The number of bits of the index into the table that ranks are looked up in.
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
  // Most often, the upper bits of values determine all these ranks.
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
ADAMAS_INSTANTIATE_FOR_WORDS(SampleCensus);

namespace {

template <class Rank>
bool are_below(std::size_t end, const PageShape& shape, const PagePoints<Rank>& ranks) {
  Rank greatest = 0;
  with_wide_lanes([&](auto) {
    Rank most = 0;
    if (shape.count == LatticePoint{PageGrid::kSide, PageGrid::kSide, PageGrid::kSide}) {
      for (const Rank rank : ranks) most = std::max(most, rank);
    } else {
      for (std::int32_t k = 0; k < shape.count.k; ++k) {
        for (std::int32_t j = 0; j < shape.count.j; ++j) {
          const Rank* const row = ranks.data() + PageGrid::place({0, j, k}, 0);
          for (std::int32_t i = 0; i < shape.count.i; ++i) most = std::max(most, row[i]);
        }
      }
    }
    greatest = most;
  });
  return greatest < end;
}

template <class Word, class Rank>
struct RankedPage {
  typename SampleCodec<Rank>::Around around;
  typename SampleCodec<Rank>::Samples samples;
  bool has_all = true;  ///< whether each of the page's own samples has a rank

  void take_around(const SampleRanks& ranks, const PageShape& shape,
                   const typename SampleCodec<Word>::Around& words) {
    if (shape.complete) return;
    std::array<std::uint32_t, Surroundings<Word>::kPoints> found;
    ranks.ranks(std::span<const Word>(words), found.data());
    std::ranges::transform(found, around.begin(), [](std::uint32_t rank) {
      return static_cast<Rank>(rank == SampleRanks::kNone ? 0 : rank);
    });
  }

  void take(const SampleRanks& ranks, const PageShape& shape,
            const typename SampleCodec<Word>::Samples& words) {
    for_each_own_place(shape, [&](std::size_t place) {
      const std::uint32_t rank = ranks.rank(words[place]);
      has_all = has_all && rank != SampleRanks::kNone;
      samples[place] = static_cast<Rank>(rank);
    });
  }
};

}  // namespace

template <class Word, class Rank>
RankedCodec<Word, Rank>::RankedCodec(std::shared_ptr<const SampleRanks> ranks,
                                     std::unique_ptr<SampleCodec<Rank>> codec)
    : ranks_(std::move(ranks)),
      codec_(std::move(codec)),
      words_(std::size_t{std::numeric_limits<Rank>::max()} + 1, 0) {
  ADAMAS_ASSERT(ranks_->values().size() <= words_.size());
  std::ranges::copy(ranks_->values(), words_.begin());
}

template <class Word, class Rank>
std::vector<std::byte> RankedCodec<Word, Rank>::tables() const {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  out.sized_bytes(ranks_->write());
  out.bytes(codec_->tables());
  return bytes;
}

template <class Word, class Rank>
void RankedCodec<Word, Rank>::encode_with(const PageShape& shape, const Around& around,
                                          const Samples& samples, std::vector<std::byte>& out,
                                          std::span<const std::byte> along) const {
  RankedPage<Word, Rank> page;
  page.take(*ranks_, shape, samples);
  if (!page.has_all) return write_raw<Word>(shape, samples, out, PageKind::kUnranked);
  page.take_around(*ranks_, shape, around);
  codec_->encode_with(shape, page.around, page.samples, out, along);
}

template <class Word, class Rank>
bool RankedCodec<Word, Rank>::decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                          const Around& around, Samples& samples, BytesAlong& along) const {
  RankedPage<Word, Rank> page;
  if (!bytes.empty() && static_cast<PageKind>(bytes[0]) == PageKind::kUnranked) {
    if (!read_raw<Word>(bytes.subspan(1), shape, samples)) return false;
    page.take(*ranks_, shape, samples);
    if (page.has_all) return false;
    along.fill({});
  } else {
    page.take_around(*ranks_, shape, around);
    if (!codec_->decode_with(bytes, shape, page.around, page.samples, along)) return false;
    if (!are_below(ranks_->values().size(), shape, page.samples)) return false;
    with_wide_lanes([&](auto) {
      const std::uint32_t* const words = words_.data();
      for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<Word>(words[page.samples[n]]);
    });
  }
  if (!shape.complete) take_coarser<Word>(around, samples);
  return true;
}

template <class Word, class Rank>
RankedSurvey<Word, Rank>::RankedSurvey(std::shared_ptr<const SampleRanks> ranks,
                                       std::unique_ptr<SampleSurvey<Rank>> survey)
    : ranks_(std::move(ranks)), survey_(std::move(survey)) {}

template <class Word, class Rank>
void RankedSurvey<Word, Rank>::add(const PageShape& shape, const Around& around, const Samples& samples) {
  RankedPage<Word, Rank> page;
  page.take(*ranks_, shape, samples);
  if (!page.has_all) return;
  page.take_around(*ranks_, shape, around);
  survey_->add(shape, page.around, page.samples);
}

template <class Word, class Rank>
void RankedSurvey<Word, Rank>::merge(const SampleSurvey<Word>& other) {
  const auto* same = dynamic_cast<const RankedSurvey*>(&other);
  ADAMAS_ASSERT(same != nullptr);
  survey_->merge(*same->survey_);
}

template <class Word, class Rank>
std::unique_ptr<SampleCodec<Word>> RankedSurvey<Word, Rank>::codec() const {
  return std::make_unique<RankedCodec<Word, Rank>>(ranks_, survey_->codec());
}

template class RankedCodec<std::uint16_t, std::uint8_t>;
template class RankedCodec<std::uint16_t, std::uint16_t>;
template class RankedCodec<std::uint32_t, std::uint8_t>;
template class RankedCodec<std::uint32_t, std::uint16_t>;
template class RankedSurvey<std::uint16_t, std::uint8_t>;
template class RankedSurvey<std::uint16_t, std::uint16_t>;
template class RankedSurvey<std::uint32_t, std::uint8_t>;
template class RankedSurvey<std::uint32_t, std::uint16_t>;

}  // namespace adamas::isosurface
