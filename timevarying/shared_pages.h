#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "timevarying/page_loader.h"
#include "timevarying/step_pages.h"

namespace adamas::timevarying {

/// A mutex that threads get in the order in which they asked for it: a thread that releases it and asks again
/// at once comes after those that wait.
class FairMutex {
 public:
  void lock();
  void unlock();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0, served_ = 0;
};

/// The decoded pages of all steps of an open store, in one memory of limited size. All readers of the store
/// share it, in whatever thread they are: SeriesFrames of several isovalues, sections, probes. Only the
/// thread that holds the lock may use the file and the pages.
class SharedPages {
 public:
  /// `memory`: bytes for decoded pages, including those of the threads that read pages ahead. The file must
  /// outlive this object, and must be read only through it.
  static std::unique_ptr<SharedPages> open(isosurface::StoreFile& file, std::size_t memory);
  SharedPages(const SharedPages&) = delete;
  SharedPages& operator=(const SharedPages&) = delete;
  virtual ~SharedPages() = default;

  using Lock = std::unique_lock<FairMutex>;
  /// Locks the pages for the calling thread until it releases the lock.
  [[nodiscard]] Lock lock() { return Lock(mutex_); }
  [[nodiscard]] const isosurface::StoreFile& file() const { return file_; }
  /// `arrived` is called in threads that load pages, when some have arrived. Only pages that SeriesFrames
  /// lack are loaded in threads; the threads end with the last SeriesFrames.
  void set_arrived(std::function<void()> arrived) { arrived_ = std::move(arrived); }

  /// The counts of reading the file, for all readers together.
  [[nodiscard]] virtual PageReads counts() = 0;
  /// The number of reads of the file for pages.
  [[nodiscard]] virtual std::uint64_t page_reads() = 0;
  /// Bytes that the decoded pages take, without those of the threads that load pages.
  [[nodiscard]] virtual std::size_t bytes_held() = 0;

 protected:
  explicit SharedPages(isosurface::StoreFile& file) : file_(file) {}

  isosurface::StoreFile& file_;
  FairMutex mutex_;
  std::function<void()> arrived_ = [] {};
};

/// A reader for which threads load pages: those that it lacks, and those that it will need for other steps.
template <class Word>
class PageUser {
 public:
  virtual ~PageUser() = default;
  /// The pages of its present step.
  [[nodiscard]] virtual isosurface::StoredPages<Word>& pages() = 0;
  /// Is told of pages that have arrived, for whichever user.
  virtual void note(const typename PageLoader<Word>::Taken& taken) = 0;

  /// Missing pages of the present step, the most important ones first.
  std::vector<isosurface::MissingPage> missing;
  std::vector<isosurface::MissingPage> needed;  ///< all pages of the present step that it has used
  std::vector<std::uint32_t> expected;  ///< steps for which it will need the same pages, the next one first
};

/// The shared pages of stores with samples of type Word. Only the thread that holds the lock may call
/// members.
template <class Word>
class SharedPagesOf final : public SharedPages {
 public:
  using Pages = isosurface::StoredPages<Word>;
  SharedPagesOf(isosurface::StoreFile& file, std::size_t memory);

  [[nodiscard]] PageReads counts() override;
  [[nodiscard]] std::uint64_t page_reads() override;
  [[nodiscard]] std::size_t bytes_held() override;

  [[nodiscard]] StepPages<Word>& steps() { return steps_; }
  /// The directions of gradients at a step, for all readers of that step; null if the store has none. Throws
  /// Error if their tables are damaged.
  std::shared_ptr<isosurface::StoredGradients> gradients(std::uint32_t step);

  void add_user(PageUser<Word>& user) {
    users_.push_back(&user);
    steps_.set_keeps_bounds(has_several_users());
  }
  /// Ends the loading threads with the last user.
  void remove_user(PageUser<Word>& user);
  [[nodiscard]] bool has_several_users() const { return users_.size() > 1; }
  /// Begins to load pages in threads, which then have a part of the memory.
  void open_loader();
  /// The loader; null if no pages are loaded in threads.
  [[nodiscard]] PageLoader<Word>* loader() { return loader_.get(); }
  /// Lets the threads load what all users lack, and then what they will need.
  void load_wanted();
  /// Moves arrived pages into memory and tells all users. `gradients`: those of the user's step, or null.
  void take_arrived(PageUser<Word>& user, isosurface::StoredGradients* gradients);

 private:
  std::vector<isosurface::MissingPage> wanted_pages();
  void note_needs();
  Pages* pages_of(std::uint32_t step, PageUser<Word>& user);

  std::size_t memory_;
  StepPages<Word> steps_;
  std::shared_ptr<isosurface::StoredGradients> gradients_;  ///< those that were requested last
  std::uint32_t gradients_step_ = 0;
  std::vector<PageUser<Word>*> users_;
  std::unique_ptr<PageLoader<Word>> loader_;
  PageReads loaded_before_;  ///< counts of loaders that have ended
  std::uint64_t reads_before_ = 0;
};

extern template class SharedPagesOf<std::uint8_t>;
extern template class SharedPagesOf<std::uint16_t>;
extern template class SharedPagesOf<std::uint32_t>;

}  // namespace adamas::timevarying
