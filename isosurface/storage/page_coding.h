#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "isosurface/compression/bounds/bounds_codec.h"
#include "isosurface/compression/gradient_codec.h"
#include "isosurface/compression/time_codec.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/store_format.h"

namespace adamas::isosurface {

/// A page with all that is known when it is coded.
template <class Word>
struct Job {
  std::uint64_t number = 0;
  PageShape shape{};
  Page<Word> page;
  Surroundings<Word> around;
  GradientCodes gradients;  ///< undefined, with those round it, where none are kept
  GradientCodesAround gradients_around;
  std::array<EarlierPage<Word>, 2> earlier;  ///< of the steps before, as many as it may be coded with
  std::size_t earlier_count = 0;
  bool has_earlier_bounds = false;  ///< whether its bounds are those of the step before

  [[nodiscard]] std::span<const EarlierPage<Word>> before() const {
    return std::span(earlier).first(earlier_count);
  }
};

/// What the tables are made from.
template <class Word>
struct Surveys {
  TimeSurvey<Word> samples;
  BoundsSurvey<Word> bounds;
  std::optional<GradientSurvey> gradients;

  Surveys(TimeSurvey<Word> of_samples, SampleCoding coding, bool with_gradients, const Vec3& spacing,
          const RangeRounding<Word>& rounding)
      : samples(std::move(of_samples)), bounds(spacing, rounding) {
    if (with_gradients) gradients.emplace(coding_of_bytes(coding));
  }

  void add(const Job<Word>& job) {
    samples.add(job.shape, job.around.samples, job.page.samples, job.before());
    if (!job.has_earlier_bounds) bounds.add(job.shape, job.around, job.page);
    if (gradients) gradients->add(job.shape, job.gradients_around, job.gradients);
  }
  void merge(const Surveys& other) {
    samples.merge(other.samples);
    bounds.merge(other.bounds);
    if (gradients) gradients->merge(*other.gradients);
  }
};

/// The bytes of a page, and what the directory says of it.
struct CodedPage {
  std::vector<std::byte> samples, bounds, gradients;
  std::size_t along = 0;  ///< how many of the bounds the samples carry
  PageSummary summary;

  [[nodiscard]] PagePayload payload() const {
    return {samples, std::span(bounds).subspan(along), gradients, along};
  }
};

template <class Word>
struct Codecs {
  SampleCoding coding;
  TimeCodec<Word> samples;
  BoundsCodec<Word> bounds;
  std::optional<GradientCodec> gradients;

  Codecs(SampleCoding of_samples, const Surveys<Word>& surveys)
      : coding(of_samples), samples(surveys.samples), bounds(surveys.bounds) {
    if (surveys.gradients) gradients.emplace(surveys.gradients->codec());
  }

  void encode(const Job<Word>& job, CodedPage& coded) const {
    coded.samples.clear();
    coded.bounds.clear();
    coded.gradients.clear();
    if (!job.has_earlier_bounds) bounds.encode(job.shape, job.around, job.page, coded.bounds);
    samples.encode(job.shape, job.around.samples, job.page.samples, job.before(), coded.samples,
                   coded.bounds);
    coded.along = carried_along(coding, coded.samples[0], coded.bounds.size());
    if (gradients) gradients->encode(job.shape, job.gradients_around, job.gradients, coded.gradients);
    coded.summary = summary(job.shape, job.page);
  }
};

}  // namespace adamas::isosurface
