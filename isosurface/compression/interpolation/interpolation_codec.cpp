#include "isosurface/compression/interpolation/interpolation_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <utility>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/simd.h"
#include "isosurface/compression/interpolation/interpolation_page.h"
#include "isosurface/compression/page_order.h"

namespace adamas::isosurface {
namespace {

/// Whether the tables of a set are indexed by activity, that is, there are not too many activities.
template <class Depth>
constexpr bool kByActivity = sizeof(typename Depth::Value) == 2;
/// Returns the context, in its set, of an activity: with the class above it if a sample prevails.
template <class Depth>
std::uint8_t context_of(typename Depth::Value activity, bool prevails) {
  if constexpr (InterpolationCodec<Depth>::kMayPrevail) {
    if (prevails) return ActivityContext<Depth>::context_with_class(activity);
  }
  return ActivityContext<Depth>::context(activity);
}

/// Returns the number of activities, with the classes above them if there are any.
template <class Depth>
constexpr std::size_t activity_count(bool prevails) {
  return (prevails ? std::size_t{ActivityContext<Depth>::kClasses} : 1) << ActivityContext<Depth>::kBits;
}

/// Returns the table by set and activity, given that of each context.
template <class Depth>
std::vector<std::uint8_t> tables_of_activities(std::span<const std::uint8_t> of_contexts, bool prevails) {
  std::vector<std::uint8_t> result;
  if constexpr (kByActivity<Depth>) {
    const std::size_t count = activity_count<Depth>(prevails);
    result.reserve(InterpolationCells<Depth>::kSets * count);
    for (std::size_t set = 0; set < InterpolationCells<Depth>::kSets; ++set) {
      const std::uint8_t* const of_set =
          of_contexts.data() + set * InterpolationCodec<Depth>::contexts_of_set(prevails);
      for (std::size_t n = 0; n < count; ++n) {
        const auto activity = static_cast<typename Depth::Value>(n);
        result.push_back(of_set[context_of<Depth>(activity, prevails)]);
      }
    }
  }
  return result;
}

}  // namespace

template <class Depth>
InterpolationCodec<Depth>::InterpolationCodec(ContextTables contexts, Prevailing prevailing)
    : prevailing_(prevailing),
      contexts_(std::move(contexts)),
      tables_(contexts_),
      table_of_activity_(
          tables_of_activities<Depth>(contexts_.tables_of_contexts(), prevailing_.has_value())) {}

template <class Depth>
InterpolationCodec<Depth> InterpolationCodec<Depth>::parse(std::span<const std::byte> tables,
                                                           std::string_view name) {
  BitReader in(tables);
  Prevailing prevailing;
  if constexpr (kMayPrevail) {
    in.refill();
    if (in.take(1) != 0) prevailing = static_cast<Word>(in.take(ResidualToken<Word>::kBits));
  }
  const bool prevails = prevailing.has_value();
  ContextTables contexts =
      ContextTables::read(in, complete_context(prevails) + 1, token_count(prevails), name);
  if (!in.at_end()) {
    fail("{}: expected the end after {} tables of frequencies, found {} data", name, contexts.tables().size(),
         in.overrun() ? "too little" : "more");
  }
  return InterpolationCodec(std::move(contexts), prevailing);
}

template <class Depth>
std::vector<std::byte> InterpolationCodec<Depth>::tables() const {
  std::vector<std::byte> tables;
  BitWriter out(tables);
  if constexpr (kMayPrevail) {
    out.put(prevailing_ ? 1 : 0, 1);
    if (prevailing_) out.put(*prevailing_, ResidualToken<Word>::kBits);
  }
  contexts_.write(out);
  out.finish();
  return tables;
}

template <class Depth>
auto InterpolationCodec<Depth>::table_of(int set) const {
  const auto n = static_cast<std::size_t>(set);
  if constexpr (kByActivity<Depth>) {
    const std::uint8_t* const tables =
        table_of_activity_.data() + n * activity_count<Depth>(prevailing_.has_value());
    return [tables](auto activity) { return tables[static_cast<std::uint16_t>(activity)]; };
  } else {
    const std::uint8_t* const tables = contexts_.tables_of_contexts().data() + n * contexts_of_set(false);
    return [tables](auto activity) { return tables[ActivityContext<Depth>::context(activity)]; };
  }
}

template <class Depth>
template <std::size_t Bytes>
void InterpolationCodec<Depth>::predict(InterpolationPage<Depth>& page, int set) const {
  page.predict(set);
  if constexpr (kMayPrevail) {
    if (prevailing_) page.template add_prevailing_classes<Bytes>(set, *prevailing_);
  }
}

template <class Depth>
void InterpolationCodec<Depth>::encode_with(const PageShape& shape, const Around& around,
                                            const Samples& samples, std::vector<std::byte>& out,
                                            std::span<const std::byte> along) const {
  std::array<std::uint8_t, PageGrid::kPoints> tables;
  std::array<Word, PageGrid::kPoints> folded;
  std::array<std::uint8_t, PageGrid::kPoints> prevailing{};
  const std::size_t count = own_points(shape);
  std::array<std::size_t, InterpolationCells<Depth>::kSets> sizes{count};
  std::size_t n = 0;
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      const Word prediction = predicted_inside<Word>(q, shape, samples);
      folded[n++] = ResidualToken<Word>::fold(static_cast<Word>(samples[PageGrid::place(q, 0)] - prediction));
    });
    std::fill_n(tables.begin(), count, contexts_.tables_of_contexts().back());
  } else {
    InterpolationPage<Depth> page(shape.count, around);
    for (int set = 0; set < InterpolationCells<Depth>::kSets; n += page.size(set++)) {
      with_wide_lanes([&](auto bytes) {
        predict<bytes()>(page, set);
        page.contexts(set, table_of(set), tables.data() + n);
        page.residuals(set, samples, folded.data() + n);
        if (prevailing_) page.find_prevailing(set, samples, *prevailing_, prevailing.data() + n);
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
    writer.put(std::span(tables).subspan(n, size), folded.data() + n, prevailing.data() + n);
    n += size;
  }
  const std::size_t begin = out.size();
  out.push_back(static_cast<std::byte>(PageKind::kResiduals));
  writer.finish(out, along.first(std::min(along.size(), std::tuple_size_v<BytesAlong>)));
  if (out.size() - begin - 1 < count * sizeof(Word)) return;
  out.resize(begin);
  write_raw<Word>(shape, samples, out);
}

template <class Depth>
bool InterpolationCodec<Depth>::decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                            const Around& around, Samples& samples, BytesAlong& along) const {
  if (bytes.empty()) return false;
  const auto kind = static_cast<PageKind>(bytes[0]);
  const auto code = bytes.subspan(1);
  along.fill({});
  if (kind == PageKind::kRaw) {
    if (!shape.complete) take_coarser<Word>(around, samples);
    return read_raw<Word>(code, shape, samples);
  }
  if (kind == PageKind::kSmooth) return code.empty() && decode_smooth(shape, around, samples);
  if (kind != PageKind::kResiduals || code.size() >= own_points(shape) * sizeof(Word)) return false;
  Reader reader(tables_, code);
  const bool good =
      shape.complete ? decode_complete(reader, shape, samples) : decode_sets(reader, shape, around, samples);
  return good && reader.at_end(along);
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
    with_wide_lanes([&](auto bytes) {
      predict<bytes()>(page, set);
      page.contexts(set, table_of(set), tables.data());
    });
    if (!reader.take(std::span(tables).first(page.size(set)), folded.data())) return false;
    if (const std::uint8_t* const prevailing = reader.prevailing()) {
      bool good = true;
      with_wide_lanes(
          [&](auto) { good = page.put_prevailing(set, prevailing_.value_or(0), prevailing, folded.data()); });
      if (!good) return false;
    }
    with_wide_lanes([&](auto) { page.apply(set, folded.data()); });
  }
  with_wide_lanes([&](auto) { page.store(samples); });
  return true;
}

template <class Depth>
bool InterpolationCodec<Depth>::decode_complete(Reader& reader, const PageShape& shape,
                                                Samples& samples) const {
  std::array<std::uint8_t, PageGrid::kPoints> tables;
  std::array<Word, PageGrid::kPoints> folded;
  const std::size_t count = own_points(shape);
  std::fill_n(tables.begin(), count, contexts_.tables_of_contexts().back());
  if (!reader.take(std::span(tables).first(count), folded.data()) || reader.prevailing() != nullptr)
    return false;
  const Word* next = folded.data();
  for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
    const Word prediction = predicted_inside<Word>(q, shape, samples);
    samples[PageGrid::place(q, 0)] = static_cast<Word>(prediction + ResidualToken<Word>::unfold(*next++));
  });
  return true;
}

template class InterpolationCodec<Depth8>;
template class InterpolationCodec<Depth12>;
template class InterpolationCodec<Depth16>;
template class InterpolationCodec<Depth32>;

template <class Depth>
InterpolationSurvey<Depth>::InterpolationSurvey(std::optional<Word> prevailing)
    : prevailing_(prevailing),
      counts_(InterpolationCodec<Depth>::complete_context(prevailing.has_value()) + 1,
              InterpolationCodec<Depth>::token_count(prevailing.has_value())) {}

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
      count(counts_.contexts() - 1, Token::fold(residual));
    });
    return;
  }
  using Page = InterpolationPage<Depth>;
  Page page(shape.count, around);
  std::array<Word, Page::kMostInSet> folded;
  std::array<std::uint8_t, Page::kMostInSet> contexts, prevailing{};
  for (int set = 0; set < Page::Cells::kSets; ++set) {
    with_wide_lanes([&](auto bytes) {
      page.predict(set);
      if constexpr (InterpolationCodec<Depth>::kMayPrevail) {
        if (prevailing_) {
          page.template add_prevailing_classes<bytes()>(set, *prevailing_);
          page.find_prevailing(set, samples, *prevailing_, prevailing.data());
        }
      }
      const bool prevails = prevailing_.has_value();
      page.contexts(
          set, [prevails](auto activity) { return context_of<Depth>(activity, prevails); }, contexts.data());
      page.residuals(set, samples, folded.data());
      page.apply(set, folded.data());
    });
    const std::size_t first =
        static_cast<std::size_t>(set) * InterpolationCodec<Depth>::contexts_of_set(prevailing_.has_value());
    for (std::size_t n = 0; n < page.size(set); ++n) {
      if (prevailing[n] != 0) {
        counts_.add(first + contexts[n], Token::kPrevailing);
      } else {
        count(first + contexts[n], folded[n]);
      }
    }
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
  return std::make_unique<InterpolationCodec<Depth>>(ContextTables(counts_), prevailing_);
}

template class InterpolationSurvey<Depth8>;
template class InterpolationSurvey<Depth12>;
template class InterpolationSurvey<Depth16>;
template class InterpolationSurvey<Depth32>;

}  // namespace adamas::isosurface
