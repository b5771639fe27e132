#include "isosurface/compression/split_edge/split_edge_codec.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {
namespace {

/// A point of a page and the points of `around` whose mean is its prediction.
struct Prediction {
  std::uint16_t place, a, b;
};

constexpr std::size_t kCoarser = 512;

/// Returns the predictions of the points that an LOD adds, in hierarchical z-order. Pages begin at multiples
/// of 4, so that the coordinates in the page determine the direction of the split edge.
const std::array<Prediction, PageGrid::kPoints - kCoarser>& predictions() {
  static const auto kPredictions = [] {
    std::array<Prediction, PageGrid::kPoints - kCoarser> result{};
    const LatticePoint whole{PageGrid::kSide, PageGrid::kSide, PageGrid::kSide};
    for_each_own_point({whole, false, 0}, [&result](LatticePoint q, std::uint64_t index) {
      const LatticePoint d = split_direction(q);
      result[index - kCoarser] = {static_cast<std::uint16_t>(PageGrid::place(q, 0)),
                                  static_cast<std::uint16_t>(surrounding_place(q - d)),
                                  static_cast<std::uint16_t>(surrounding_place(q + d))};
    });
    return result;
  }();
  return kPredictions;
}

/// Calls f(place of the sample, prediction) for the page's own points. Predictions inside a complete page
/// need the samples before.
template <class Word, class Samples, class Around, class F>
void for_each_prediction(const PageShape& shape, const Around& around, const Samples& samples, F&& f) {
  if (shape.complete) {
    for_each_own_point(shape, [&](LatticePoint q, std::uint64_t) {
      f(PageGrid::place(q, 0), predicted_inside<Word>(q, shape, samples));
    });
    return;
  }
  const bool whole = shape.count == LatticePoint{PageGrid::kSide, PageGrid::kSide, PageGrid::kSide};
  for (const Prediction& p : predictions()) {
    const LatticePoint q{p.place & 15, p.place >> 4 & 15, p.place >> 8};
    if (whole || shape.owns(q)) {
      f(std::size_t{p.place}, static_cast<Word>(predicted(around[p.a], around[p.b])));
    }
  }
}

using Residuals = std::array<std::uint32_t, PageGrid::kPoints>;

template <class Word, class Samples, class Around>
std::span<const std::uint32_t> residuals_of(const PageShape& shape, const Around& around,
                                            const Samples& samples, Residuals& residuals) {
  std::size_t count = 0;
  for_each_prediction<Word>(shape, around, samples, [&](std::size_t place, Word prediction) {
    residuals[count++] = static_cast<Word>(samples[place] - prediction);
  });
  return std::span(residuals).first(count);
}

bool all_zero(std::span<const std::uint32_t> residuals) {
  return std::ranges::all_of(residuals, [](std::uint32_t residual) { return residual == 0; });
}

}  // namespace

template <class Word>
void SplitEdgeCodec<Word>::encode_with(const PageShape& shape, const Around& around, const Samples& samples,
                                       std::vector<std::byte>& out, std::span<const std::byte>) const {
  Residuals residuals;
  const auto own = residuals_of<Word>(shape, around, samples, residuals);
  const std::size_t begin = out.size();
  if (all_zero(own)) {
    out.push_back(static_cast<std::byte>(PageKind::kSmooth));
    return;
  }
  out.push_back(static_cast<std::byte>(PageKind::kResiduals));
  if (code_.codes(own)) {
    code_.encode(own, out);
    if (out.size() - begin - 1 < own.size() * sizeof(Word)) return;
  }
  out.resize(begin);
  write_raw<Word>(shape, samples, out);
}

template <class Word>
bool SplitEdgeCodec<Word>::decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                       const Around& around, Samples& samples, BytesAlong& along) const {
  if (bytes.empty()) return false;
  along.fill({});
  if (!shape.complete) take_coarser<Word>(around, samples);
  const auto kind = static_cast<PageKind>(bytes[0]);
  const auto code = bytes.subspan(1);
  if (kind == PageKind::kRaw) return read_raw<Word>(code, shape, samples);
  Residuals residuals;
  const auto own = std::span(residuals).first(own_points(shape));
  if (kind == PageKind::kResiduals) {
    if (code.size() >= own.size() * sizeof(Word) || !code_.decode(code, own) || all_zero(own)) return false;
  } else if (kind == PageKind::kSmooth && code.empty()) {
    std::ranges::fill(own, 0u);
  } else {
    return false;
  }
  const std::uint32_t* residual = own.data();
  for_each_prediction<Word>(shape, around, samples, [&](std::size_t place, Word prediction) {
    samples[place] = static_cast<Word>(prediction + *residual++);
  });
  return true;
}

template <class Word>
void SplitEdgeSurvey<Word>::add(const PageShape& shape, const Around& around, const Samples& samples) {
  Residuals residuals;
  const auto own = residuals_of<Word>(shape, around, samples, residuals);
  if (!all_zero(own)) statistics_.add(own);
}

template <class Word>
void SplitEdgeSurvey<Word>::merge(const SampleSurvey<Word>& other) {
  const auto* same = dynamic_cast<const SplitEdgeSurvey*>(&other);
  ADAMAS_ASSERT(same != nullptr);
  statistics_.merge(same->statistics_);
}

template <class Word>
std::unique_ptr<SampleCodec<Word>> SplitEdgeSurvey<Word>::codec() const {
  return std::make_unique<SplitEdgeCodec<Word>>(ResidualCode(statistics_));
}

ADAMAS_INSTANTIATE_FOR_WORDS(SplitEdgeCodec);
ADAMAS_INSTANTIATE_FOR_WORDS(SplitEdgeSurvey);

}  // namespace adamas::isosurface
