#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/vec3.h"
#include "isosurface/compression/bounds_codec.h"
#include "isosurface/compression/gradient_codec.h"
#include "isosurface/compression/time_codec.h"
#include "isosurface/storage/page_cache.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// What reading a store has met with.
struct PageCounts {
  std::uint64_t pages = 0;       ///< read for their own sake
  std::uint64_t predictors = 0;  ///< read only since others are predicted from them
  std::uint64_t bytes = 0;       ///< of both and of the directory
  std::uint64_t copies = 0;      ///< pages that were damaged, of which the second copy was whole
  std::uint64_t damaged = 0;     ///< pages that cannot be had

  PageCounts& operator+=(const PageCounts& other) {
    pages += other.pages;
    predictors += other.predictors;
    bytes += other.bytes;
    copies += other.copies;
    damaged += other.damaged;
    return *this;
  }
};

/// A page that is needed cannot be had, since a page is damaged: it itself or one that it is predicted from.
struct PageLost {
  PageId page, damaged;
};

/// What a page that is coded in time is decoded with.
template <class Word>
struct EarlierPages {
  std::array<EarlierPage<Word>, 2> pages;
  Surroundings<Word> around;
};

/// The decoded samples and bounds of one step of a store. Pages that are damaged, or predicted from one that
/// is, cannot be had. Word: OrderedWord of the store's samples.
template <class Word>
class StoredPages : public PageCache<Word> {
 public:
  /// `memory`: bytes that decoded pages may take, with those of the steps before that these are coded with.
  /// Throws Error where the tables are damaged, those of bounds not before bounds are asked for. The file
  /// must outlive this.
  StoredPages(StoreFile& file, std::uint32_t step, std::size_t memory);
  /// A memory for steps of a store. Where pages are coded with those of the steps before, it has room for
  /// these in any case: without them each page would be decoded again for each of the steps that follow.
  static std::shared_ptr<PageMemory<Word>> memory_for(const StoreFile& file, std::size_t bytes);
  /// Gives the pages of another step.
  using FindStep = std::function<StoredPages&(std::uint32_t step)>;
  /// The same of one of several steps that share a memory. `alike`: the pages of another step of the same
  /// block, the tables of which serve here too, or null.
  StoredPages(StoreFile& file, std::uint32_t step, std::shared_ptr<PageMemory<Word>> memory, FindStep find,
              const StoredPages* alike);

  [[nodiscard]] StoreFile& file() { return file_; }
  /// The same step of the same file for each of some threads, the first of which has these pages: they share
  /// the memory, and the others stay for later calls. Samples that one of them has decoded the others have
  /// too, as far as there is room. Not to be called by several threads at once.
  std::vector<StoredPages*> for_threads(std::size_t count);
  [[nodiscard]] std::uint32_t step() const { return step_; }

  /// The same as samples() and bounds(), for pages without which there is no way to go on. Throw PageLost.
  const PageSamples<Word>& needed_samples(const PageId& id) { return needed(id, this->samples(id)); }
  const PageBounds<Word>& needed_bounds(const PageId& id) { return needed(id, this->bounds(id)); }
  /// What the directory says of a page; nothing where that is damaged.
  std::optional<PageEntry> entry(const PageId& id) { return file_.entry(step_, id); }

  /// Pages that were found damaged, in the order in which they were met.
  [[nodiscard]] const std::vector<PageId>& damaged() const { return damaged_; }
  /// The damaged page for which a page could not be had, when that was last so.
  [[nodiscard]] const PageId& last_damaged() const { return last_damaged_; }
  [[nodiscard]] PageCounts counts() const;

 private:
  bool load(const PageToLoad<Word>& page) override;
  /// Which of the parts that are wanted the bytes are of.
  enum class Decoded : std::uint8_t { kNothing, kSamples, kAll };
  Decoded decode(std::span<const std::byte> payload, const PageToLoad<Word>& page);
  bool decode_samples(std::span<const std::byte> coded, const PageToLoad<Word>& page);
  bool decode_bounds(const PagePayload& coded, const PageToLoad<Word>& page);
  /// Of the step before, one of which there is.
  StoredPages& before();
  template <class Part>
  const Part& needed(const PageId& id, const Part* part) const {
    if (part == nullptr) throw PageLost{id, this->loads() ? last_damaged_ : id};
    return *part;
  }

  struct OfThread {
    std::unique_ptr<StoreFile> file;
    std::unique_ptr<StoredPages> pages;
  };

  StoreFile& file_;
  std::uint32_t step_;
  std::size_t memory_for_threads_;  ///< of all of them
  std::vector<OfThread> others_;
  std::shared_ptr<const TimeCodec<Word>> sample_codec_;
  FindStep find_;                                ///< none where no steps are shared
  std::unique_ptr<StoredPages> before_;          ///< null where they are, and before it is asked for
  std::unique_ptr<EarlierPages<Word>> earlier_;  ///< work memory; null before a page is coded in time
  std::shared_ptr<const BoundsCodec<Word>> bounds_codec_;  ///< null before bounds are asked for
  std::vector<PageId> damaged_;
  std::vector<PageId> damaged_bounds_;  ///< of these, those whose samples can be had
  PageId last_damaged_;
  std::uint64_t copies_ = 0;
};

extern template class StoredPages<std::uint8_t>;
extern template class StoredPages<std::uint16_t>;
extern template class StoredPages<std::uint32_t>;

/// The least and the greatest finite sample of a store, the first greater where there is none; nothing where
/// the part of the file that tells of them is damaged.
template <class Sample>
std::optional<std::array<double, 2>> sample_range(StoredPages<OrderedWord<Sample>>& pages);

/// The directions of gradients that one step of a store keeps: pages whose samples are the bytes of
/// OctahedralCode, the first byte lowest.
class StoredGradients : public PageCache<std::uint16_t> {
 public:
  /// Bytes of decoded pages that those who make surfaces allow.
  static constexpr std::size_t kMemory = std::size_t{64} << 20;
  /// `memory`: bytes that decoded pages may take. Throws Error where the store has no gradients or their
  /// tables are damaged. The file must outlive this.
  StoredGradients(StoreFile& file, std::uint32_t step, std::size_t memory);

  /// The direction at a point, whose coordinates count samples and are not negative: a unit vector, or zero
  /// where nothing changes. Beyond the data it is that of the nearest sample. Nothing where the page cannot
  /// be had.
  std::optional<Vec3> direction(LatticePoint p);
  /// The page that tells of it.
  [[nodiscard]] PageId page_of(LatticePoint p) const { return grid().page(in_data(p)); }
  /// The damaged page for which a page could not be had, when that was last so.
  [[nodiscard]] const PageId& last_damaged() const { return last_damaged_; }

 private:
  [[nodiscard]] LatticePoint in_data(LatticePoint p) const;
  bool load(const PageToLoad<std::uint16_t>& page) override;

  StoreFile& file_;
  std::uint32_t step_;
  GradientCodec codec_;
  PageId last_damaged_;
};

}  // namespace adamas::isosurface
