#include "isosurface/compression/interpolation_codec.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "isosurface/compression/interpolation_page.h"
#include "isosurface/compression/page_order.h"

namespace adamas {
namespace {

/// Whether the groups of a set lie in a table by activity: where there are not too many activities.
template <class Depth>
constexpr bool kByActivity = sizeof(typename Depth::Value) == 2;
template <class Depth>
constexpr std::size_t kActivities = std::size_t{1} << ActivityContext<Depth>::kBits;

/// Groups by set and activity: what ContextGroups says of contexts.
template <class Depth>
std::vector<std::uint8_t> groups_of_activities(std::span<const std::uint8_t> groups) {
  std::vector<std::uint8_t> result;
  if constexpr (kByActivity<Depth>) {
    result.reserve(InterpolationCells<Depth>::kSets * kActivities<Depth>);
    for (std::size_t set = 0; set < InterpolationCells<Depth>::kSets; ++set) {
      const std::uint8_t* const of_set = groups.data() + set * InterpolationCodec<Depth>::kContextsOfSet;
      for (std::size_t n = 0; n < kActivities<Depth>; ++n)
        result.push_back(of_set[ActivityContext<Depth>::of(static_cast<typename Depth::Value>(n))]);
    }
  }
  return result;
}

}  // namespace

template <class Depth>
InterpolationCodec<Depth>::InterpolationCodec(ContextGroups groups)
    : groups_(std::move(groups)),
      tables_(groups_.frequencies()),
      group_of_activity_(groups_of_activities<Depth>(groups_.groups())) {}

template <class Depth>
InterpolationCodec<Depth> InterpolationCodec<Depth>::parse(std::span<const std::byte> tables,
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

template <class Depth>
std::vector<std::byte> InterpolationCodec<Depth>::tables() const {
  std::vector<std::byte> tables;
  BitWriter out(tables);
  groups_.write(out);
  out.finish();
  return tables;
}

template <class Depth>
auto InterpolationCodec<Depth>::group_of(int set) const {
  const auto n = static_cast<std::size_t>(set);
  if constexpr (kByActivity<Depth>) {
    const std::uint8_t* const groups = group_of_activity_.data() + n * kActivities<Depth>;
    return [groups](auto activity) { return groups[static_cast<std::uint16_t>(activity)]; };
  } else {
    const std::uint8_t* const groups = groups_.groups().data() + n * kContextsOfSet;
    return [groups](auto activity) { return groups[ActivityContext<Depth>::of(activity)]; };
  }
}

template <class Depth>
void InterpolationCodec<Depth>::encode(const PageShape& shape, const Around& around, const Samples& samples,
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
    InterpolationPage<Depth> page(shape.count, around);
    std::size_t n = 0;
    for (int set = 0; set < InterpolationCells<Depth>::kSets; n += page.size(set++)) {
      with_wide_lanes([&](auto) {
        page.predict(set);
        page.contexts(set, group_of(set), groups.data() + n);
        page.residuals(set, samples, folded.data() + n);
        page.apply(set, folded.data() + n);
      });
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

template <class Depth>
void InterpolationCodec<Depth>::write(std::span<const std::uint8_t> groups, std::span<const Word> folded,
                                      std::vector<std::byte>& out) const {
  using Token = ResidualToken<Word>;
  std::array<std::uint8_t, PageGrid::kPoints> tokens, symbols;
  for (std::size_t n = 0; n < groups.size(); ++n) {
    tokens[n] = static_cast<std::uint8_t>(Token::token(folded[n]));
    symbols[n] = tables_.has(groups[n], tokens[n]) ? tokens[n] : static_cast<std::uint8_t>(Token::kEscape);
  }
  RangeTables::States states;
  std::array<std::uint16_t, PageGrid::kPoints> words;
  const std::uint16_t* const end = tables_.encode(groups, symbols.data(), states, words.data());
  BitWriter bits(out);
  for (const std::uint32_t x : states) {
    const int length = std::bit_width(x) - 1;
    bits.put(static_cast<std::uint64_t>(length - Reader::kLeastBits), Reader::kLengthBits);
    bits.put(x ^ 1u << length, length);
  }
  for (std::size_t n = 0; n < groups.size(); ++n) {
    if (symbols[n] < Token::kDirect) continue;
    const int open = Token::extra_bits(tokens[n]);
    if (symbols[n] == Token::kEscape) bits.put(tokens[n], Token::kTokenBits);
    bits.put(folded[n] & ((std::uint64_t{1} << open) - 1), open);
  }
  bits.finish();
  for (const std::uint16_t* word = words.data(); word != end; ++word) {
    out.push_back(static_cast<std::byte>(*word & 0xff));
    out.push_back(static_cast<std::byte>(*word >> 8));
  }
}

template <class Depth>
bool InterpolationCodec<Depth>::decode(std::span<const std::byte> bytes, const PageShape& shape,
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
  Reader reader(tables_, code);
  return shape.complete ? decode_complete(reader, shape, samples)
                        : decode_sets(reader, shape, around, samples);
}

template <class Depth>
bool InterpolationCodec<Depth>::decode_smooth(const PageShape& shape, const Around& around,
                                              Samples& samples) const {
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      samples[PageGrid::place(q, 0)] = predicted_inside<Word>(q, shape, samples);
    });
    return true;
  }
  with_wide_lanes([&](auto) {
    InterpolationPage<Depth> page(shape.count, around);
    for (int set = 0; set < InterpolationCells<Depth>::kSets; ++set) page.predict(set);
    page.store(samples);
  });
  return true;
}

template <class Depth>
bool InterpolationCodec<Depth>::decode_sets(Reader& reader, const PageShape& shape, const Around& around,
                                            Samples& samples) const {
  using Page = InterpolationPage<Depth>;
  Page page(shape.count, around);
  std::array<std::uint8_t, Page::kMostInSet> groups;
  std::array<Word, Page::kMostInSet> folded;
  for (int set = 0; set < InterpolationCells<Depth>::kSets; ++set) {
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

template <class Depth>
bool InterpolationCodec<Depth>::decode_complete(Reader& reader, const PageShape& shape,
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

template class InterpolationCodec<Depth8>;
template class InterpolationCodec<Depth12>;
template class InterpolationCodec<Depth16>;
template class InterpolationCodec<Depth32>;

}  // namespace adamas
