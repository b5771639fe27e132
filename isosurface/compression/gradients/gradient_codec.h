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

/// Codes the directions of a page's own points, lossless: each of the two bytes of the codes in the way of a
/// sample, with its own tables (the dissertation (D), section 4.11, does so with the components). Several
/// threads may use it at once.
class GradientCodec {
 public:
  static constexpr std::size_t kComponents = 2;
  using Component = SampleCodec<std::uint8_t>;

  /// Returns the bytes from which `parse` makes the codec again; they are the same for equal surveys.
  [[nodiscard]] std::vector<std::byte> tables() const;
  /// Makes a codec from its tables. Throws Error, which begins with `name`, unless the `tables` of some codec
  /// of that coding could have given just these bytes.
  [[nodiscard]] static GradientCodec parse(SampleCoding coding, std::span<const std::byte> tables,
                                           std::string_view name);

  /// Appends the page's own points, in whole bytes. `around` is not read where the page is complete; of
  /// `codes` only places that have points count.
  void encode(const PageShape& shape, const GradientCodesAround& around, const GradientCodes& codes,
              std::vector<std::byte>& out) const;
  /// Fills all places of `codes` that have points, those of coarser LODs from `around`. Returns false, with
  /// undefined `codes`, where the bytes are not a result of `encode`.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape,
                            const GradientCodesAround& around, GradientCodes& codes) const;

 private:
  friend class GradientSurvey;
  using Components = std::array<std::unique_ptr<Component>, kComponents>;

  explicit GradientCodec(Components components) : components_(std::move(components)) {}

  Components components_;
};

/// Counts the directions of pages, for the tables of a codec. A codec can code any page, but less well if the
/// page was not counted.
class GradientSurvey {
 public:
  explicit GradientSurvey(SampleCoding coding);

  void add(const PageShape& shape, const GradientCodesAround& around, const GradientCodes& codes);
  /// Adds the counts of another survey of the same coding. The order of pages and of merging does not matter.
  void merge(const GradientSurvey& other);
  [[nodiscard]] GradientCodec codec() const;

 private:
  std::array<std::unique_ptr<SampleSurvey<std::uint8_t>>, GradientCodec::kComponents> components_;
};

}  // namespace adamas::isosurface
