#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/volume/page.h"

namespace adamas::isosurface {

class SampleRanks;

/// How the samples of pages are coded; the numbers are those in files.
enum class SampleCoding : std::uint8_t {
  kSplitEdge = 0,      ///< mean of the split edge's ends, lead-1 codes: the dissertation (D), section 4.11
  kInterpolation = 1,  ///< cubic on edges, then faces, then centres; contexts of local variation
  kRanks = 2,          ///< kInterpolation of the samples' ranks; of words of more than a byte
  kPlain = 3           ///< as they are: kSplitEdge in files, all of whose pages are raw
};

/// The coding by which pages of this coding are decoded, and which stands in files.
constexpr SampleCoding coding_in_files(SampleCoding coding) {
  return coding == SampleCoding::kPlain ? SampleCoding::kSplitEdge : coding;
}

/// The coding of single bytes, which have no ranks, in a file with this coding.
constexpr SampleCoding coding_of_bytes(SampleCoding coding) {
  return coding == SampleCoding::kRanks ? SampleCoding::kInterpolation : coding;
}

/// Codes pages of samples, lossless. It is made by a SampleSurvey, or from the tables of a file. May be used
/// by several threads at once. Word: see Page.
template <class Word>
class SampleCodec {
 public:
  using Samples = PagePoints<Word>;
  using Around = typename Surroundings<Word>::template Points<Word>;

  virtual ~SampleCodec() = default;

  /// The bytes from which `parse_sample_codec` makes the codec again; they are the same for equal surveys.
  [[nodiscard]] virtual std::vector<std::byte> tables() const = 0;
  /// Appends the page's own points, in whole bytes. `around` is not read where the page is complete; of
  /// `samples` only places that have points are read. Carries along, in bits that states of the entropy coder
  /// would leave unused, as many bytes of `along` as carries_along says.
  virtual void encode_with(const PageShape& shape, const Around& around, const Samples& samples,
                           std::vector<std::byte>& out, std::span<const std::byte> along) const = 0;
  void encode(const PageShape& shape, const Around& around, const Samples& samples,
              std::vector<std::byte>& out) const {
    encode_with(shape, around, samples, out, {});
  }
  /// Fills all places of `samples` that have points, those of coarser LODs from `around`, and gives what was
  /// carried along, with zeros behind it. Returns false, and leaves anything in `samples` and `along`, where
  /// the bytes are not what `encode_with` of some page gives.
  [[nodiscard]] virtual bool decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                         const Around& around, Samples& samples, BytesAlong& along) const = 0;
  /// Decodes what `encode` gives.
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                            Samples& samples) const {
    BytesAlong along;
    return decode_with(bytes, shape, around, samples, along) && along == BytesAlong{};
  }
};

/// The number of bytes, of `size`, that a coded page carries along. The two lowest bits of `first`, its first
/// byte, are its kind.
std::size_t carried_along(SampleCoding coding, std::byte first, std::size_t size);

/// Counts what pages hold, for the tables of the codec that will code them. Codecs code any page, also one
/// that was not counted, only less well.
template <class Word>
class SampleSurvey {
 public:
  using Samples = typename SampleCodec<Word>::Samples;
  using Around = typename SampleCodec<Word>::Around;

  virtual ~SampleSurvey() = default;

  virtual void add(const PageShape& shape, const Around& around, const Samples& samples) = 0;
  /// Adds what another survey, of the same coding, has counted. The order of pages and of merging does not
  /// matter.
  virtual void merge(const SampleSurvey& other) = 0;
  [[nodiscard]] virtual std::unique_ptr<SampleCodec<Word>> codec() const = 0;
};

/// Makes the survey of a coding. `ranks` are those of the volume's samples, for kRanks alone. `prevailing` is
/// a word that so many of the volume's samples have that it pays to code it apart; it is used where words or
/// ranks have one byte.
template <class Word>
std::unique_ptr<SampleSurvey<Word>> sample_survey(SampleCoding coding,
                                                  std::shared_ptr<const SampleRanks> ranks = nullptr,
                                                  std::optional<Word> prevailing = {});

/// Makes a codec again from its tables. Throws Error, which begins with `name`, unless some codec's `tables`
/// could have given just these bytes.
template <class Word>
std::unique_ptr<SampleCodec<Word>> parse_sample_codec(SampleCoding coding, std::span<const std::byte> tables,
                                                      std::string_view name);

}  // namespace adamas::isosurface
