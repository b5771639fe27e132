#include "isosurface/compression/interpolation_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "isosurface/compression/interpolation_page.h"
#include "isosurface/compression/page_order.h"

namespace adamas {
namespace {

/// Whether the tables of a set are looked up by activity: where there are not too many activities.
template <class Depth>
constexpr bool kByActivity = sizeof(typename Depth::Value) == 2;
template <class Depth>
constexpr std::size_t kActivities = std::size_t{1} << ActivityContext<Depth>::kBits;

/// The table by set and activity, from that of each context.
template <class Depth>
std::vector<std::uint8_t> tables_of_activities(std::span<const std::uint8_t> of_contexts) {
  std::vector<std::uint8_t> result;
  if constexpr (kByActivity<Depth>) {
    result.reserve(InterpolationCells<Depth>::kSets * kActivities<Depth>);
    for (std::size_t set = 0; set < InterpolationCells<Depth>::kSets; ++set) {
      const std::uint8_t* const of_set = of_contexts.data() + set * InterpolationCodec<Depth>::kContextsOfSet;
      for (std::size_t n = 0; n < kActivities<Depth>; ++n)
        result.push_back(of_set[ActivityContext<Depth>::of(static_cast<typename Depth::Value>(n))]);
    }
  }
  return result;
}

}  // namespace

template <class Depth>
InterpolationCodec<Depth>::InterpolationCodec(ContextTables contexts)
    : contexts_(std::move(contexts)),
      tables_(contexts_),
      table_of_activity_(tables_of_activities<Depth>(contexts_.of_contexts())) {}

template <class Depth>
InterpolationCodec<Depth> InterpolationCodec<Depth>::parse(std::span<const std::byte> tables,
                                                           std::string_view name) {
  BitReader in(tables);
  ContextTables contexts = ContextTables::read(in, kContexts, ResidualToken<Word>::kTokens, name);
  if (!in.at_end()) {
    fail("{}: expected the end after {} tables of frequencies, found {} data", name, contexts.tables().size(),
         in.overrun() ? "too little" : "more");
  }
  return InterpolationCodec(std::move(contexts));
}

template <class Depth>
std::vector<std::byte> InterpolationCodec<Depth>::tables() const {
  std::vector<std::byte> tables;
  BitWriter out(tables);
  contexts_.write(out);
  out.finish();
  return tables;
}

template <class Depth>
auto InterpolationCodec<Depth>::table_of(int set) const {
  const auto n = static_cast<std::size_t>(set);
  if constexpr (kByActivity<Depth>) {
    const std::uint8_t* const tables = table_of_activity_.data() + n * kActivities<Depth>;
    return [tables](auto activity) { return tables[static_cast<std::uint16_t>(activity)]; };
  } else {
    const std::uint8_t* const tables = contexts_.of_contexts().data() + n * kContextsOfSet;
    return [tables](auto activity) { return tables[ActivityContext<Depth>::of(activity)]; };
  }
}

template <class Depth>
void InterpolationCodec<Depth>::encode(const PageShape& shape, const Around& around, const Samples& samples,
                                       std::vector<std::byte>& out) const {
  std::array<std::uint8_t, PageGrid::kPoints> tables;
  std::array<Word, PageGrid::kPoints> folded;
  const std::size_t count = own_points(shape);
  std::array<std::size_t, InterpolationCells<Depth>::kSets> sizes{count};
  std::size_t n = 0;
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      const Word prediction = predicted_inside<Word>(q, shape, samples);
      folded[n++] = ResidualToken<Word>::fold(static_cast<Word>(samples[PageGrid::place(q, 0)] - prediction));
    });
    std::fill_n(tables.begin(), count, contexts_.of_contexts()[kComplete]);
  } else {
    InterpolationPage<Depth> page(shape.count, around);
    for (int set = 0; set < InterpolationCells<Depth>::kSets; n += page.size(set++)) {
      with_wide_lanes([&](auto) {
        page.predict(set);
        page.contexts(set, table_of(set), tables.data() + n);
        page.residuals(set, samples, folded.data() + n);
        page.apply(set, folded.data() + n);
      });
      sizes[static_cast<std::size_t>(set)] = page.size(set);
    }
  }
  if (std::all_of(folded.begin(), folded.begin() + static_cast<std::ptrdiff_t>(count),
                  [](Word residual) { return residual == 0; })) {
    out.push_back(static_cast<std::byte>(PageKind::kSmooth));
    return;
  }
  ResidualWriter<Word> writer(tables_, count);
  n = 0;
  for (const std::size_t size : sizes) {
    writer.put(std::span(tables).subspan(n, size), folded.data() + n);
    n += size;
  }
  const std::size_t begin = out.size();
  out.push_back(static_cast<std::byte>(PageKind::kResiduals));
  writer.finish(out);
  if (out.size() - begin - 1 < count * sizeof(Word)) return;
  out.resize(begin);
  write_raw<Word>(shape, samples, out);
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
  std::array<std::uint8_t, Page::kMostInSet> tables;
  std::array<Word, Page::kMostInSet> folded;
  for (int set = 0; set < InterpolationCells<Depth>::kSets; ++set) {
    with_wide_lanes([&](auto) {
      page.predict(set);
      page.contexts(set, table_of(set), tables.data());
    });
    if (!reader.take(std::span(tables).first(page.size(set)), folded.data())) return false;
    with_wide_lanes([&](auto) { page.apply(set, folded.data()); });
  }
  with_wide_lanes([&](auto) { page.store(samples); });
  return reader.at_end();
}

template <class Depth>
bool InterpolationCodec<Depth>::decode_complete(Reader& reader, const PageShape& shape,
                                                Samples& samples) const {
  std::array<std::uint8_t, PageGrid::kPoints> tables;
  std::array<Word, PageGrid::kPoints> folded;
  const std::size_t count = own_points(shape);
  std::fill_n(tables.begin(), count, contexts_.of_contexts()[kComplete]);
  if (!reader.take(std::span(tables).first(count), folded.data())) return false;
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

template <class Depth>
InterpolationSurvey<Depth>::InterpolationSurvey()
    : counts_(InterpolationCodec<Depth>::kContexts, ResidualToken<Word>::kTokens) {}

template <class Depth>
void InterpolationSurvey<Depth>::add(const PageShape& shape, const Around& around, const Samples& samples) {
  using Token = ResidualToken<Word>;
  const auto count = [this](std::size_t context, Word folded) {
    counts_.add(context, static_cast<std::size_t>(Token::token(folded)));
  };
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      const Word prediction = predicted_inside<Word>(q, shape, samples);
      const auto residual = static_cast<Word>(samples[PageGrid::place(q, 0)] - prediction);
      count(InterpolationCodec<Depth>::kComplete, Token::fold(residual));
    });
    return;
  }
  using Page = InterpolationPage<Depth>;
  Page page(shape.count, around);
  std::array<Word, Page::kMostInSet> folded;
  std::array<std::uint8_t, Page::kMostInSet> contexts;
  for (int set = 0; set < Page::Cells::kSets; ++set) {
    with_wide_lanes([&](auto) {
      page.predict(set);
      page.contexts(
          set, [](auto activity) { return ActivityContext<Depth>::of(activity); }, contexts.data());
      page.residuals(set, samples, folded.data());
      page.apply(set, folded.data());
    });
    const std::size_t first = static_cast<std::size_t>(set) * InterpolationCodec<Depth>::kContextsOfSet;
    for (std::size_t n = 0; n < page.size(set); ++n) count(first + contexts[n], folded[n]);
  }
}

template <class Depth>
void InterpolationSurvey<Depth>::merge(const SampleSurvey<Word>& other) {
  const auto* same = dynamic_cast<const InterpolationSurvey*>(&other);
  ADAMAS_ASSERT(same != nullptr);
  counts_.merge(same->counts_);
}

template <class Depth>
std::unique_ptr<SampleCodec<typename Depth::Word>> InterpolationSurvey<Depth>::codec() const {
  return std::make_unique<InterpolationCodec<Depth>>(ContextTables(counts_));
}

template class InterpolationSurvey<Depth8>;
template class InterpolationSurvey<Depth12>;
template class InterpolationSurvey<Depth16>;
template class InterpolationSurvey<Depth32>;

}  // namespace adamas
