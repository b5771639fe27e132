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

/// The coding of the samples of pages; the numbers are those in files.
enum class SampleCoding : std::uint8_t {
  kSplitEdge = 0,      ///< mean of the split edge's ends, lead-1 codes: the dissertation (D), section 4.11
  kInterpolation = 1,  ///< cubic on edges, then faces, then centres; contexts of local variation
  kRanks = 2,          ///< kInterpolation of the samples' ranks, for words of more than a byte
  kPlain = 3           ///< samples as they are: kSplitEdge in files, all of whose pages are raw
};

/// Returns the coding with which pages of this coding are decoded, and which files name.
constexpr SampleCoding coding_in_files(SampleCoding coding) {
  return coding == SampleCoding::kPlain ? SampleCoding::kSplitEdge : coding;
}

/// Returns the coding of single bytes, which have no ranks, in a file with this coding.
constexpr SampleCoding coding_of_bytes(SampleCoding coding) {
  return coding == SampleCoding::kRanks ? SampleCoding::kInterpolation : coding;
}

/// Codes pages of samples, lossless. It is made by a SampleSurvey, or from the tables of a file. Several
/// threads may use it at once. Word: see Page.
template <class Word>
class SampleCodec {
 public:
  using Samples = PagePoints<Word>;
  using Around = typename Surroundings<Word>::template Points<Word>;

  virtual ~SampleCodec() = default;

  /// Returns the bytes from which `parse_sample_codec` makes the codec again; they are the same for equal
  /// surveys.
  [[nodiscard]] virtual std::vector<std::byte> tables() const = 0;
  /// Appends the page's own points, in whole bytes. `around` is not read where the page is complete; of
  /// `samples` only places that have points are read. As many bytes of `along` as carried_along() returns are
  /// carried along, in bits that states of the entropy coder would leave unused.
  virtual void encode_with(const PageShape& shape, const Around& around, const Samples& samples,
                           std::vector<std::byte>& out, std::span<const std::byte> along) const = 0;
  void encode(const PageShape& shape, const Around& around, const Samples& samples,
              std::vector<std::byte>& out) const {
    encode_with(shape, around, samples, out, {});
  }
  /// Fills all places of `samples` that have points, those of coarser LODs from `around`, and sets the bytes
  /// that were carried along, with zeros behind them. Returns false, with undefined `samples` and `along`,
  /// where the bytes are not a result of `encode_with`.
  [[nodiscard]] virtual bool decode_with(std::span<const std::byte> bytes, const PageShape& shape,
                                         const Around& around, Samples& samples, BytesAlong& along) const = 0;
  [[nodiscard]] bool decode(std::span<const std::byte> bytes, const PageShape& shape, const Around& around,
                            Samples& samples) const {
    BytesAlong along;
    return decode_with(bytes, shape, around, samples, along) && along == BytesAlong{};
  }
};

/// Returns the number of bytes, of `size`, that a coded page carries along. The two lowest bits of `first`,
/// its first byte, are its kind.
std::size_t carried_along(SampleCoding coding, std::byte first, std::size_t size);

/// Counts the samples of pages, for the tables of a codec. A codec can code any page, but less well if the
/// page was not counted.
template <class Word>
class SampleSurvey {
 public:
  using Samples = typename SampleCodec<Word>::Samples;
  using Around = typename SampleCodec<Word>::Around;

  virtual ~SampleSurvey() = default;

  virtual void add(const PageShape& shape, const Around& around, const Samples& samples) = 0;
  /// Adds the counts of another survey of the same coding. The order of pages and of merging does not matter.
  virtual void merge(const SampleSurvey& other) = 0;
  [[nodiscard]] virtual std::unique_ptr<SampleCodec<Word>> codec() const = 0;
};

/// Makes the survey of a coding. `ranks` are those of the volume's samples, for kRanks alone. `prevailing` is
/// a word that is so frequent among the volume's samples that a token of its own pays; it is used where words
/// or ranks have one byte.
template <class Word>
std::unique_ptr<SampleSurvey<Word>> sample_survey(SampleCoding coding,
                                                  std::shared_ptr<const SampleRanks> ranks = nullptr,
                                                  std::optional<Word> prevailing = {});

/// Makes a codec from its tables. Throws Error, which begins with `name`, unless some codec's `tables` could
/// have given just these bytes.
template <class Word>
std::unique_ptr<SampleCodec<Word>> parse_sample_codec(SampleCoding coding, std::span<const std::byte> tables,
                                                      std::string_view name);

}  // namespace adamas::isosurface
