#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "isosurface/compression/interpolation_codec.h"
#include "isosurface/compression/interpolation_page.h"
#include "isosurface/compression/page_order.h"

namespace adamas {

template <class Word>
InterpolationSurvey<Word>::InterpolationSurvey()
    : counts_(InterpolationCodec<Word>::kContexts,
              std::vector<std::uint64_t>(static_cast<std::size_t>(ResidualToken<Word>::kTokens), 0)) {}

template <class Word>
void InterpolationSurvey<Word>::add(const PageShape& shape, const Around& around, const Samples& samples) {
  using Token = ResidualToken<Word>;
  const auto count = [this](std::size_t context, Word folded) {
    ++counts_[context][static_cast<std::size_t>(Token::token(folded))];
  };
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      const Word prediction = predicted_inside<Word>(q, shape, samples);
      const auto residual = static_cast<Word>(samples[PageGrid::place(q, 0)] - prediction);
      count(InterpolationCodec<Word>::kComplete, Token::fold(residual));
    });
    return;
  }
  using Page = InterpolationPage<Word>;
  Page page(shape.count, around);
  std::array<Word, Page::kMostInSet> folded;
  std::array<std::uint8_t, Page::kMostInSet> contexts;
  for (int set = 0; set < Page::Cells::kSets; ++set) {
    page.predict(set);
    page.contexts(
        set, [](auto activity) { return ActivityContext<Word>::of(activity); }, contexts.data());
    page.residuals(set, samples, folded.data());
    page.apply(set, folded.data());
    const std::size_t first = static_cast<std::size_t>(set) * InterpolationCodec<Word>::kContextsOfSet;
    for (std::size_t n = 0; n < page.size(set); ++n) count(first + contexts[n], folded[n]);
  }
}

template <class Word>
void InterpolationSurvey<Word>::merge(const SampleSurvey<Word>& other) {
  const auto* same = dynamic_cast<const InterpolationSurvey*>(&other);
  ADAMAS_ASSERT(same != nullptr);
  for (std::size_t context = 0; context < counts_.size(); ++context) {
    for (std::size_t s = 0; s < counts_[context].size(); ++s)
      counts_[context][s] += same->counts_[context][s];
  }
}

template <class Word>
std::unique_ptr<SampleCodec<Word>> InterpolationSurvey<Word>::codec() const {
  return std::make_unique<InterpolationCodec<Word>>(ContextGroups(counts_, ResidualToken<Word>::kTokenBits));
}

template class InterpolationSurvey<std::uint8_t>;
template class InterpolationSurvey<std::uint16_t>;
template class InterpolationSurvey<std::uint32_t>;

}  // namespace adamas
