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

/// A mutex that threads get in the order in which they asked for it: a thread that gives it back and wants it
/// again at once comes after those that wait.
class FairMutex {
 public:
  void lock();
  void unlock();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0, served_ = 0;
};

/// The decoded pages of an open store, of all its steps, in one memory of limited size. All readers of the
/// store share it, in whatever thread they are: SeriesFrames of several isovalues, sections, probes. One
/// thread at a time may use the file and the pages, for as long as it holds the lock.
class SharedPages {
 public:
  /// `memory`: bytes that decoded pages may take, including those of the threads that read pages ahead. The
  /// file must outlive this, and is read through this alone.
  static std::unique_ptr<SharedPages> open(isosurface::StoreFile& file, std::size_t memory);
  SharedPages(const SharedPages&) = delete;
  SharedPages& operator=(const SharedPages&) = delete;
  virtual ~SharedPages() = default;

  using Lock = std::unique_lock<FairMutex>;
  /// The pages belong to the calling thread until it gives the lock back.
  [[nodiscard]] Lock lock() { return Lock(mutex_); }
  [[nodiscard]] const isosurface::StoreFile& file() const { return file_; }
  /// `arrived` is called in threads that load pages, when some have come. Only pages that SeriesFrames lack
  /// are loaded in threads; the threads end with the last SeriesFrames.
  void set_arrived(std::function<void()> arrived) { arrived_ = std::move(arrived); }

  /// What reading the file has met with, for all readers together.
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

/// A reader for which pages are loaded in threads: what it lacks, and what it will need of other steps.
template <class Word>
class PageUser {
 public:
  virtual ~PageUser() = default;
  /// The pages of the step that it reads at present.
  [[nodiscard]] virtual isosurface::StoredPages<Word>& pages() = 0;
  /// Takes notice of pages that have come, be it for another user.
  virtual void note(const typename PageLoader<Word>::Taken& taken) = 0;

  std::vector<isosurface::MissingPage> missing;  ///< of the present step, the most important ones first
  std::vector<isosurface::MissingPage> needed;   ///< all of the present step that it has used
  std::vector<std::uint32_t> expected;           ///< steps of which it will need the same, the next one first
};

/// The shared pages of stores whose samples are such words. Only the thread that holds the lock may call
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
  /// The directions of gradients at a step, for all readers of that step; null where the store keeps none.
  /// Throws Error where their tables are damaged.
  std::shared_ptr<isosurface::StoredGradients> gradients(std::uint32_t step);

  void add_user(PageUser<Word>& user) {
    users_.push_back(&user);
    steps_.set_keeps_bounds(has_several_users());
  }
  /// Ends the loading threads with the last user.
  void remove_user(PageUser<Word>& user);
  [[nodiscard]] bool has_several_users() const { return users_.size() > 1; }
  /// Begins to load pages in threads. From then on these have a part of the memory.
  void open_loader();
  /// Null where no pages are loaded in threads.
  [[nodiscard]] PageLoader<Word>* loader() { return loader_.get(); }
  /// Has the threads load what all users lack, and then what they will need.
  void load_wanted();
  /// Puts what has come into memory, and tells all users. `gradients`: those of the user's step, or null.
  void take_arrived(PageUser<Word>& user, isosurface::StoredGradients* gradients);

 private:
  std::vector<isosurface::MissingPage> wanted_pages();
  void note_needs();
  Pages* pages_of(std::uint32_t step, PageUser<Word>& user);

  std::size_t memory_;
  StepPages<Word> steps_;
  std::shared_ptr<isosurface::StoredGradients> gradients_;  ///< those that were asked for last
  std::uint32_t gradients_step_ = 0;
  std::vector<PageUser<Word>*> users_;
  std::unique_ptr<PageLoader<Word>> loader_;
  PageReads loaded_before_;  ///< by loaders that have ended
  std::uint64_t reads_before_ = 0;
};

extern template class SharedPagesOf<std::uint8_t>;
extern template class SharedPagesOf<std::uint16_t>;
extern template class SharedPagesOf<std::uint32_t>;

}  // namespace adamas::timevarying
