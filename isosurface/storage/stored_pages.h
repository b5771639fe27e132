#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/page_reads.h"
#include "isosurface/compression/bounds/bounds_codec.h"
#include "isosurface/compression/gradients/gradient_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/storage/page_cache.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// An exception: `page` is needed and not available, since `damaged` is damaged, the page itself or one that
/// it is predicted from.
struct PageLost {
  PageId page, damaged;
};

/// The decoded samples and bounds of one step of a store. Pages that are damaged, or predicted from a damaged
/// page, are not available. This class decodes pages that are coded in space, as are all pages of the first
/// step; a derived class decodes those that are coded with the steps before (timevarying/step_pages.h). Word:
/// OrderedWord of the store's samples.
template <class Word>
class StoredPages : public PageCache<Word> {
 public:
  /// Makes the pages of a step whose pages are coded in space: steps_before(step) is 0. `memory` is the
  /// number of bytes that decoded pages may take. Throws Error where the tables are damaged; those of bounds
  /// are read when bounds are first requested. The file must outlive this.
  StoredPages(StoreFile& file, std::uint32_t step, std::size_t memory);

  [[nodiscard]] StoreFile& file() { return file_; }
  /// Returns the pages of this step for each of `count` threads; the first thread has these pages. All share
  /// the memory in equal parts, and the other objects stay for later calls. Samples that one of them has
  /// decoded are copied to the others, as far as there is room. Only one thread may call this at a time.
  std::vector<StoredPages*> for_threads(std::size_t count);
  [[nodiscard]] std::uint32_t step() const { return step_; }

  /// These return samples() and bounds() of pages that are needed in any case. They throw PageLost.
  const PageSamples<Word>& needed_samples(const PageId& id) { return needed(id, this->samples(id)); }
  const PageBounds<Word>& needed_bounds(const PageId& id) { return needed(id, this->bounds(id)); }
  /// Returns the directory entry of a page; none where that is damaged.
  std::optional<PageEntry> entry(const PageId& id) { return file_.entry(step_, id); }

  /// Returns the pages that were found damaged, in this order.
  [[nodiscard]] const std::vector<PageId>& damaged() const { return damaged_; }
  /// Returns the damaged page because of which a page was unavailable last.
  [[nodiscard]] const PageId& last_damaged() const { return last_damaged_; }
  [[nodiscard]] virtual PageReads counts() const;

 protected:
  using SpaceCodec = std::shared_ptr<const SampleCodec<Word>>;
  /// Makes the pages for a derived class. `space_codec` decodes samples that are coded in space. `alike` has
  /// the pages of another step of the same block, with the same tables, or is null.
  StoredPages(StoreFile& file, std::uint32_t step, std::shared_ptr<PageMemory<Word>> memory,
              SpaceCodec space_codec, const StoredPages* alike);

 private:
  /// Decodes samples whose time_order() is not 0. Returns false where they are not available.
  virtual bool decode_in_time(std::span<const std::byte> /*coded*/, const PageToLoad<Word>&) { return false; }
  /// Returns the bounds of the page one step before; null where they are not available.
  virtual const PageBounds<Word>* earlier_bounds(const PageId&) { return nullptr; }
  /// Returns the pages of this step by another file object of the same store, with a memory of their own.
  [[nodiscard]] virtual std::unique_ptr<StoredPages> by_file(StoreFile& file, std::size_t memory) const {
    return std::make_unique<StoredPages>(file, step_, memory);
  }

  bool load(const PageToLoad<Word>& page) override;
  /// The wanted parts that could be decoded.
  enum class Decoded : std::uint8_t { kNothing, kSamples, kAll };
  Decoded decode(std::span<const std::byte> payload, const PageToLoad<Word>& page);
  bool decode_samples(std::span<const std::byte> coded, const PageToLoad<Word>& page);
  bool decode_bounds(const PagePayload& coded, const PageToLoad<Word>& page);
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
  std::size_t memory_for_threads_;  ///< bytes for all threads together
  std::vector<OfThread> others_;
  SpaceCodec space_codec_;
  std::shared_ptr<const BoundsCodec<Word>> bounds_codec_;  ///< null before bounds are requested
  std::vector<PageId> damaged_;
  std::vector<PageId> damaged_bounds_;  ///< the damaged pages whose samples are available
  PageId last_damaged_;
  std::uint64_t copies_ = 0;
};

/// Returns the least and the greatest finite sample of a store, the first greater where there is none; none
/// where the part of the file that has them is damaged.
template <class Sample>
std::optional<std::array<double, 2>> sample_range(StoredPages<OrderedWord<Sample>>& pages);

/// The directions of gradients of one step of a store: pages whose samples are OctahedralCodes, the first
/// byte lowest.
class StoredGradients : public PageCache<std::uint16_t> {
 public:
  /// The bytes of decoded pages that surfaces use.
  static constexpr std::size_t kMemory = std::size_t{64} << 20;
  /// Opens the directions. `memory` is the number of bytes that decoded pages may take. Throws Error where
  /// the store has no gradients or their tables are damaged. The file must outlive this.
  StoredGradients(StoreFile& file, std::uint32_t step, std::size_t memory);

  /// Returns the direction at a point, whose coordinates count samples and are not negative: a unit vector,
  /// or zero where nothing changes. Beyond the data it is that of the nearest sample. None where the page is
  /// not available.
  std::optional<Vec3> direction(LatticePoint p);
  [[nodiscard]] PageId page_of(LatticePoint p) const { return grid().page(in_data(p)); }
  /// Returns the damaged page because of which a page was unavailable last.
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
