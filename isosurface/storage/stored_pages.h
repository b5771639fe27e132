#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "isosurface/compression/bounds_codec.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/storage/page_cache.h"
#include "isosurface/storage/store_file.h"

namespace adamas {

/// What reading a store has met with.
struct PageCounts {
  std::uint64_t pages = 0;       ///< read for their own sake
  std::uint64_t predictors = 0;  ///< read only since others are predicted from them
  std::uint64_t bytes = 0;       ///< of both and of the directory
  std::uint64_t copies = 0;      ///< pages that were damaged, of which the second copy was whole
  std::uint64_t damaged = 0;     ///< pages that cannot be had
};

/// The parts of a page's bytes in a store.
struct PagePayload {
  std::span<const std::byte> samples, values, gradients;
};

/// Joins the parts; the inverse.
std::vector<std::byte> join_payload(const PagePayload& parts);
/// False where the bytes are not those of three parts.
[[nodiscard]] bool split_payload(std::span<const std::byte> bytes, PagePayload& parts);

/// The decoded pages of one step of a store. Word: OrderedWord of the store's samples.
template <class Word>
class StoredPages {
 public:
  /// `memory`: bytes that decoded pages may take. Throws Error where the tables are damaged, those of values
  /// not before any are asked for. The file must outlive this.
  StoredPages(StoreFile& file, std::uint32_t step, std::size_t memory);

  [[nodiscard]] StoreFile& file() { return file_; }
  [[nodiscard]] std::uint32_t step() const { return step_; }
  [[nodiscard]] const PageGrid& grid() const { return file_.grid(); }

  /// A part of a page, or null where it is damaged or predicted from one that is. Valid until the next call.
  const PageSamples<Word>* samples(const PageId& id) { return tree_.samples(id); }
  const PageBounds<Word>* values(const PageId& id) { return tree_.values(id); }
  /// The samples of a page that is in memory; null for others.
  const PageSamples<Word>* held(const PageId& id) { return tree_.find(id); }
  /// All of a page; false where it cannot be had.
  bool copy(const PageId& id, Page<Word>& page) { return tree_.copy(id, page); }
  /// The values of the page, or of all, will hardly be asked for again.
  void drop_bounds(const PageId& id) { tree_.drop_bounds(id); }
  void drop_bounds() { tree_.drop_bounds(); }
  /// What is known round a page; false where something cannot be had.
  bool surroundings(const PageId& id, Surroundings<Word>& around) { return tree_.surroundings(id, around); }
  /// What the directory says of it; nothing where that is damaged.
  std::optional<PageEntry> entry(const PageId& id) { return file_.entry(step_, id); }
  /// Pages that were found damaged, in the order in which they were met.
  [[nodiscard]] const std::vector<PageId>& damaged() const { return damaged_; }
  /// The damaged page for which a page could not be had, when that was last so.
  [[nodiscard]] const PageId& last_damaged() const { return last_damaged_; }
  [[nodiscard]] PageCounts counts() const;

 private:
  bool load(const PageId& id, const PageShape& shape, const Surroundings<Word>& around, PageParts parts,
            PageSamples<Word>& samples, PageBounds<Word>* values);
  bool decode(std::span<const std::byte> payload, const PageShape& shape, const Surroundings<Word>& around,
              PageParts parts, PageSamples<Word>& samples, PageBounds<Word>* values);

  StoreFile& file_;
  std::uint32_t step_;
  std::unique_ptr<SampleCodec<Word>> sample_codec_;
  std::optional<BoundsCodec<Word>> bounds_codec_;  ///< none before values are asked for
  PageCache<Word> tree_;
  std::vector<PageId> damaged_;
  PageId last_damaged_;
  std::uint64_t copies_ = 0;
};

extern template class StoredPages<std::uint8_t>;
extern template class StoredPages<std::uint16_t>;
extern template class StoredPages<std::uint32_t>;

}  // namespace adamas
