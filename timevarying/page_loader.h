#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/shared_pool.h"
#include "isosurface/storage/missing_page.h"
#include "timevarying/step_pages.h"

namespace adamas::timevarying {

/// Reads and decodes pages in threads of its own, the most important missing ones first. Each thread has a
/// part of the volume and its own memory of pages, since pages predict others; decoded pages wait until they
/// are taken. Each page is tried once; one that cannot be loaded is returned as such and not tried again.
template <class Word>
class PageLoader {
 public:
  /// Makes a loader of pages of all steps of the store of `pages`. `memory` is the number of bytes for its
  /// own pages, including those that wait to be taken. `arrived` is called in one of the loader's threads
  /// when the first page has arrived since the last take(). Throws Error if the file cannot be opened again.
  PageLoader(
      isosurface::StoredPages<Word>& pages, std::size_t memory, std::function<void()> arrived = [] {},
      std::size_t threads = 1);
  PageLoader(const PageLoader&) = delete;
  PageLoader& operator=(const PageLoader&) = delete;
  /// Waits for the pages that are being loaded.
  ~PageLoader();

  /// Sets what is to be loaded, in this order, and replaces what was wanted before.
  void want(std::vector<isosurface::MissingPage> pages);
  struct Taken {
    std::vector<isosurface::MissingPage> pages;  ///< those that have arrived, and those that cannot be loaded
    std::vector<isosurface::MissingPage> without_room;  ///< those for which the memory was full
  };
  /// The memory of the pages of another step; null if they are not wanted.
  using PagesOf = std::function<isosurface::StoredPages<Word>*(std::uint32_t step)>;
  /// Moves arrived pages into the memory of a step's pages, of its gradients if these are not null, and of
  /// other steps. Pages that are no longer wanted and gradients of other steps are dropped. It must not be
  /// called while a frame is being computed.
  Taken take(
      isosurface::StoredPages<Word>& pages, isosurface::StoredGradients* gradients,
      const PagesOf& pages_of = [](std::uint32_t) { return nullptr; });
  /// Whether there is nothing to load or to take.
  [[nodiscard]] bool is_idle() const;
  /// Waits until there is something to take or nothing to load.
  void wait() const;
  /// Why the first page that failed cannot be loaded; empty if none failed.
  [[nodiscard]] std::string problem() const;
  /// The counts of what was read, including pages that predict others.
  [[nodiscard]] PageReads counts() const;
  /// The number of read operations for pages on its files.
  [[nodiscard]] std::uint64_t page_reads() const;

 private:
  struct Arrived {
    isosurface::MissingPage what;
    std::string problem;                        ///< why it cannot be loaded; empty if it has arrived
    std::optional<isosurface::PageId> damaged;  ///< the damaged page, if that is the reason
    std::unique_ptr<isosurface::Page<Word>> page;
    std::unique_ptr<isosurface::PageSamples<std::uint16_t>> gradients;
    std::shared_ptr<const isosurface::StoreFile::DirectoryPart> directory;
    bool is_wanted = true;  ///< whether the last call of want() asked for it
  };
  /// The data of one thread, and its present work, which mutex_ guards.
  struct Reader {
    Reader(std::unique_ptr<isosurface::StoreFile> opened, std::size_t bytes)
        : file(std::move(opened)), memory(bytes), pages(*file, bytes) {}

    std::unique_ptr<isosurface::StoreFile> file;
    std::size_t memory;
    StepPages<Word> pages;
    /// Gradients of gradients_step; null before they are requested.
    std::unique_ptr<isosurface::StoredGradients> gradients;
    std::uint32_t gradients_step = 0;
    std::vector<isosurface::MissingPage> wanted;
    std::size_t next = 0;                            ///< index of the next one of these
    std::optional<isosurface::MissingPage> loading;  ///< the page that is being loaded
    bool is_loading_wanted = false;                  ///< whether `loading` is still wanted
    PageReads counts;
    std::uint64_t page_reads = 0;
    std::thread thread;

    [[nodiscard]] bool is_done() const { return next >= wanted.size() && !loading; }
  };

  void run(Reader& reader);
  void end();
  /// The reader of the part of the volume that contains a page.
  [[nodiscard]] Reader& reader_of(const isosurface::PageId& id);
  Arrived load(Reader& reader, const isosurface::MissingPage& wanted);
  void load_part(Reader& reader, Arrived& arrived);
  static isosurface::StoredGradients& gradients(Reader& reader, std::uint32_t step);
  [[nodiscard]] bool is_done() const {
    return std::ranges::all_of(readers_, [](const auto& reader) { return reader->is_done(); });
  }
  static bool put(const Arrived& arrived, isosurface::StoredPages<Word>& pages,
                  isosurface::StoredGradients* gradients);
  static void note_lost(const Arrived& arrived, isosurface::StoredPages<Word>& pages,
                        isosurface::StoredGradients* gradients);

  isosurface::PageGrid grid_;
  std::function<void()> notify_;
  std::size_t most_arrived_;                 ///< the greatest number of pages that wait to be taken
  SharedPool<isosurface::Page<Word>> free_;  ///< unused pages for reuse
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool is_ended_ = false;
  std::vector<Arrived> arrived_;
  std::string problem_;
  std::set<std::pair<std::uint32_t, std::uint64_t>> damaged_;  ///< damaged pages, by step and number
  std::vector<std::unique_ptr<Reader>> readers_;
};

extern template class PageLoader<std::uint8_t>;
extern template class PageLoader<std::uint16_t>;
extern template class PageLoader<std::uint32_t>;

}  // namespace adamas::timevarying
