#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/shared_pool.h"
#include "isosurface/storage/missing_page.h"
#include "isosurface/storage/step_pages.h"

namespace adamas {

/// Reads and decodes pages in a thread of its own, the most important ones of those that are missing first.
/// It has its own memory of pages, since pages predict others; what it has decoded waits until it is taken.
/// Each page is tried once: one that cannot be had is told of, and not tried again.
template <class Word>
class PageLoader {
 public:
  /// A loader for pages of memories of all steps of a store. `memory`: bytes that its own pages may take,
  /// with those that wait to be taken. `arrived` is called in the loader's thread when there is something to
  /// take. Throws Error where the file cannot be opened again.
  PageLoader(
      StoredPages<Word>& pages, std::size_t memory, std::function<void()> arrived = [] {});
  PageLoader(const PageLoader&) = delete;
  PageLoader& operator=(const PageLoader&) = delete;
  /// Waits for the page that is being loaded.
  ~PageLoader();

  /// What is to be loaded, in this order; in place of what was wanted before.
  void want(std::vector<MissingPage> pages);
  struct Taken {
    std::vector<MissingPage> pages;  ///< those that are there now, and those that cannot be had
    bool is_full = false;            ///< there was no room for some
  };
  /// The memory of the pages of another step; null where they are not wanted.
  using PagesOf = std::function<StoredPages<Word>*(std::uint32_t step)>;
  /// Puts what has come into the memory of a step's pages, and of its gradients if that is not null, and of
  /// other steps; pages that have come and are not wanted any more are dropped. Tells of those of the step.
  /// Not to be called while a frame is being worked out.
  Taken take(
      StoredPages<Word>& pages, StoredGradients* gradients,
      const PagesOf& pages_of = [](std::uint32_t) { return nullptr; });
  /// Whether there is nothing to load or to take.
  [[nodiscard]] bool is_idle() const;
  /// Waits until there is something to take or nothing to load.
  void wait() const;
  /// Why a page cannot be had: of the first one. Empty: nothing.
  [[nodiscard]] std::string problem() const;
  /// What was read; pages that others were predicted from too.
  [[nodiscard]] PageCounts counts() const;
  /// How often its file was read for pages.
  [[nodiscard]] std::uint64_t page_reads() const;

 private:
  struct Arrived {
    MissingPage what;
    std::string problem;  ///< why it cannot be had; empty: here it is
    std::unique_ptr<Page<Word>> page;
    std::unique_ptr<PageSamples<std::uint16_t>> gradients;
    std::shared_ptr<const StoreFile::DirectoryPart> directory;
    bool is_wanted = true;  ///< still, by the last call of want()
  };

  void run();
  Arrived load(const MissingPage& wanted);
  void load_part(Arrived& arrived);
  StoredGradients& gradients(std::uint32_t step);
  [[nodiscard]] bool has_work() const { return next_ < wanted_.size() && arrived_.size() < most_arrived_; }
  static bool put(const Arrived& arrived, StoredPages<Word>& pages, StoredGradients* gradients);
  static void note_lost(const Arrived& arrived, StoredPages<Word>& pages, StoredGradients* gradients);

  std::unique_ptr<StoreFile> file_;
  std::size_t memory_;
  StepPages<Word> pages_;                       ///< of the thread, like gradients_
  std::unique_ptr<StoredGradients> gradients_;  ///< of gradients_step_; null before they are asked for
  std::uint32_t gradients_step_ = 0;
  std::function<void()> notify_;
  std::size_t most_arrived_;     ///< so many pages wait to be taken at most
  SharedPool<Page<Word>> free_;  ///< pages that were taken, for others that come
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool is_ended_ = false;
  std::optional<MissingPage> loading_;  ///< at the moment
  bool is_loading_wanted_ = false;      ///< that still
  std::vector<MissingPage> wanted_;
  std::size_t next_ = 0;  ///< of wanted_
  std::vector<Arrived> arrived_;
  std::string problem_;
  PageCounts counts_;
  std::uint64_t page_reads_ = 0;
  std::thread thread_;
};

extern template class PageLoader<std::uint8_t>;
extern template class PageLoader<std::uint16_t>;
extern template class PageLoader<std::uint32_t>;

}  // namespace adamas
