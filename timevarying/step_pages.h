#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <utility>

#include "isosurface/storage/stored_pages.h"
#include "timevarying/time_codec.h"

namespace adamas::timevarying {

/// The decoded samples and bounds of any step of a store, also if they are coded with those of the steps
/// before (TimeCodec), which are decoded as needed.
template <class Word>
class SeriesPages final : public isosurface::StoredPages<Word> {
 public:
  using Memory = isosurface::PageMemory<Word>;
  using Stored = isosurface::StoredPages<Word>;

  /// The pages of one step, which decode those of earlier steps for themselves. `memory` is the number of
  /// bytes for decoded pages of all these steps. Throws Error if the tables are damaged; those of bounds are
  /// read when bounds are first requested. The file must outlive this object.
  SeriesPages(isosurface::StoreFile& file, std::uint32_t step, std::size_t memory);
  /// A memory for steps of a store. If pages are coded with those of the steps before, it always has room for
  /// these: otherwise each page would be decoded again for each of the steps that follow.
  static std::shared_ptr<Memory> memory_for(const isosurface::StoreFile& file, std::size_t bytes);
  /// Returns the pages of another step.
  using FindStep = std::function<SeriesPages&(std::uint32_t step)>;
  /// The pages of one of several steps that share a memory. `alike` has the pages of another step, or is
  /// null; if that step is of the same block, its tables are shared.
  SeriesPages(isosurface::StoreFile& file, std::uint32_t step, std::shared_ptr<Memory> memory, FindStep find,
              const SeriesPages* alike);

  [[nodiscard]] PageReads counts() const override;

 private:
  using Codec = std::shared_ptr<const TimeCodec<Word>>;
  /// The work memory for a page that is coded in time.
  struct Earlier {
    std::array<EarlierPage<Word>, 2> pages;
    isosurface::Surroundings<Word> around;
  };

  SeriesPages(isosurface::StoreFile& file, std::uint32_t step, std::shared_ptr<Memory> memory, FindStep find,
              const SeriesPages* alike, Codec codec);
  static const SeriesPages* of_same_block(const isosurface::StoreFile& file, std::uint32_t step,
                                          const SeriesPages* alike);
  static Codec codec_of(const isosurface::StoreFile& file, std::uint32_t step, const SeriesPages* alike);

  bool decode_in_time(std::span<const std::byte> coded, const isosurface::PageToLoad<Word>& page) override;
  const isosurface::PageBounds<Word>* earlier_bounds(const isosurface::PageId& page) override {
    return before().bounds(page);
  }
  [[nodiscard]] std::unique_ptr<Stored> by_file(isosurface::StoreFile& file,
                                                std::size_t memory) const override {
    return std::make_unique<SeriesPages>(file, this->step(), memory);
  }
  /// The pages of the step before. The present step must not be the first.
  SeriesPages& before();

  Codec codec_;
  FindStep find_;                        ///< empty if steps share no memory
  std::unique_ptr<SeriesPages> before_;  ///< null if find_ returns it, and before it is needed
  std::unique_ptr<Earlier> earlier_;     ///< null before a page is coded in time
};

/// The pages of the steps of a store, in one memory. If it is full, pages of the step that was used least
/// recently are dropped. Pages decoded for a step also serve the steps that are coded with it.
template <class Word>
class StepPages {
 public:
  using Pages = SeriesPages<Word>;

  /// `memory` is the number of bytes for decoded pages. The file must outlive this object.
  StepPages(isosurface::StoreFile& file, std::size_t memory);
  StepPages(const StepPages&) = delete;
  StepPages& operator=(const StepPages&) = delete;

  [[nodiscard]] isosurface::StoreFile& file() const { return file_; }
  /// The pages of a step. They stay until kMostSteps others were requested. Throws Error if tables are
  /// damaged.
  Pages& at(std::uint32_t step);
  static constexpr std::size_t kMostSteps = 32;
  /// The pages of a step as at() returns them, which stay as long as a caller holds them.
  std::shared_ptr<Pages> shared(std::uint32_t step) {
    at(step);
    return steps_.at(step).pages;
  }
  /// The pages of a step that follows another one, to be read before it is needed: they are dropped before
  /// those of that one.
  Pages& ahead(std::uint32_t step, const isosurface::StoredPages<Word>& current);
  /// Calls visit(pages) for each step that has pages in memory, in ascending order. It does not change which
  /// pages are dropped first.
  template <class Visit>
  void for_each_in_memory(const Visit& visit) const {
    for (const auto& [step, of_step] : steps_) visit(std::as_const(*of_step.pages));
  }
  void set_memory(std::size_t bytes) { memory_->limit = bytes; }
  /// Sets whether bounds that a reader no longer needs stay in memory, since other readers may need them.
  void set_keeps_bounds(bool keeps) { memory_->keeps_bounds = keeps; }
  /// The number of bytes that the decoded pages of all steps take.
  [[nodiscard]] std::size_t bytes_held() const { return memory_->taken(); }
  /// The counts of all steps, including dropped ones.
  [[nodiscard]] PageReads counts() const;

 private:
  Pages& found(std::uint32_t step);
  void drop_old();

  struct Step {
    std::shared_ptr<Pages> pages;
    std::uint64_t wanted = 0;  ///< when it was used last, or first to decode another step
  };
  isosurface::StoreFile& file_;
  std::shared_ptr<isosurface::PageMemory<Word>> memory_;
  std::map<std::uint32_t, Step> steps_;
  std::uint64_t wants_ = 0;
  PageReads dropped_;  ///< counts of dropped steps
};

extern template class SeriesPages<std::uint8_t>;
extern template class SeriesPages<std::uint16_t>;
extern template class SeriesPages<std::uint32_t>;
extern template class StepPages<std::uint8_t>;
extern template class StepPages<std::uint16_t>;
extern template class StepPages<std::uint32_t>;

}  // namespace adamas::timevarying
