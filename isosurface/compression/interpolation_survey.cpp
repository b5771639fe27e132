#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "core/base/simd.h"
#include "isosurface/compression/interpolation_codec.h"
#include "isosurface/compression/interpolation_page.h"
#include "isosurface/compression/page_order.h"

namespace adamas {

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
