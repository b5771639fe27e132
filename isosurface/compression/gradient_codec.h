#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/sample_codec.h"

namespace adamas::isosurface {

/// The directions of the gradients of a page's points: OctahedralCodes as words, the first byte lowest.
using GradientCodes = PagePoints<std::uint16_t>;
/// The directions round a page.
using GradientCodesAround = Surroundings<std::uint16_t>::Points<std::uint16_t>;

/// Codes the directions of a page's own points, lossless: each of the two bytes of the codes as if it were a
/// sample, with tables of its own (the dissertation (D), section 4.11, does so with the components). May be
/// used by several threads at once.
class GradientCodec {
 public:
  static constexpr std::size_t kComponents = 2;
  using Component = SampleCodec<std::uint8_t>;

  /// The bytes from which `parse` makes the codec again; they are the same for equal surveys.
  [[nodiscard]] std::vector<std::byte> tables() const;
  /// Makes a codec again from its tables. Throws Error, which begins with `name`, unless the `tables` of some
  /// codec of that coding could have given just these bytes.
  [[nodiscard]] static GradientCodec parse(SampleCoding coding, std::span<const std::byte> tables,
                                           std::string_view name);

  /// Appends the page's own points, in whole bytes. `around` is not read where the page is complete; of
  /// `codes` only places that have points count.
  void encode(const PageShape& shape, const GradientCodesAround& around, const GradientCodes& codes,
              std::vector<std::byte>& out) const;
  /// Fills all places of `codes` that have points, those of coarser LODs from `around`. Returns false, and
  /// leaves anything in `codes`, where the bytes are not what `encode` of some page gives.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape,
                            const GradientCodesAround& around, GradientCodes& codes) const;

 private:
  friend class GradientSurvey;
  using Components = std::array<std::unique_ptr<Component>, kComponents>;

  explicit GradientCodec(Components components) : components_(std::move(components)) {}

  Components components_;
};

/// Counts what directions pages hold, for the tables of the codec that will code them. Codecs code any page,
/// also one that was not counted, only less well.
class GradientSurvey {
 public:
  explicit GradientSurvey(SampleCoding coding);

  void add(const PageShape& shape, const GradientCodesAround& around, const GradientCodes& codes);
  /// Adds what another survey, of the same coding, has counted. The order of pages and of merging does not
  /// matter.
  void merge(const GradientSurvey& other);
  [[nodiscard]] GradientCodec codec() const;

 private:
  std::array<std::unique_ptr<SampleSurvey<std::uint8_t>>, GradientCodec::kComponents> components_;
};

}  // namespace adamas::isosurface
