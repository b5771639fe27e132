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

/// Reads and decodes pages in threads of its own, the most important ones of those that are missing first.
/// Each thread has a part of the volume and its own memory of pages, since pages predict others; what is
/// decoded waits until it is taken. Each page is tried once; one that cannot be had is returned as such, and
/// not tried again.
template <class Word>
class PageLoader {
 public:
  /// Makes a loader of pages of all steps of the store of `pages`. `memory` is the number of bytes that its
  /// own pages may take, with those that wait to be taken. `arrived` is called in one of the loader's threads
  /// when there is something to take where there was nothing. Throws Error where the file cannot be opened
  /// again.
  PageLoader(
      isosurface::StoredPages<Word>& pages, std::size_t memory, std::function<void()> arrived = [] {},
      std::size_t threads = 1);
  PageLoader(const PageLoader&) = delete;
  PageLoader& operator=(const PageLoader&) = delete;
  /// Waits for the pages that are being loaded.
  ~PageLoader();

  /// Says what is to be loaded, in this order, in place of what was wanted before.
  void want(std::vector<isosurface::MissingPage> pages);
  struct Taken {
    std::vector<isosurface::MissingPage> pages;  ///< those that are there now, and those that cannot be had
    std::vector<isosurface::MissingPage> without_room;  ///< those for which the memory was full
  };
  /// The memory of the pages of another step; null where they are not wanted.
  using PagesOf = std::function<isosurface::StoredPages<Word>*(std::uint32_t step)>;
  /// Puts what has come into the memory of a step's pages, of its gradients if these are not null, and of
  /// other steps. Pages that are not wanted any more and gradients of other steps are dropped. It must not be
  /// called while a frame is being worked out.
  Taken take(
      isosurface::StoredPages<Word>& pages, isosurface::StoredGradients* gradients,
      const PagesOf& pages_of = [](std::uint32_t) { return nullptr; });
  /// Whether there is nothing to load or to take.
  [[nodiscard]] bool is_idle() const;
  /// Waits until there is something to take or nothing to load.
  void wait() const;
  /// Why the first page that could not be loaded cannot be had; empty if all could.
  [[nodiscard]] std::string problem() const;
  /// The counts of what was read, with pages that others were predicted from.
  [[nodiscard]] PageReads counts() const;
  /// The number of times that its files were read for pages.
  [[nodiscard]] std::uint64_t page_reads() const;

 private:
  struct Arrived {
    isosurface::MissingPage what;
    std::string problem;                        ///< why it cannot be had; empty if it has come
    std::optional<isosurface::PageId> damaged;  ///< the damaged page, if that is why
    std::unique_ptr<isosurface::Page<Word>> page;
    std::unique_ptr<isosurface::PageSamples<std::uint16_t>> gradients;
    std::shared_ptr<const isosurface::StoreFile::DirectoryPart> directory;
    bool is_wanted = true;  ///< whether it was wanted in the last call of want()
  };
  /// What a thread has for itself, and what it does at the moment, which mutex_ guards.
  struct Reader {
    Reader(std::unique_ptr<isosurface::StoreFile> of, std::size_t bytes)
        : file(std::move(of)), memory(bytes), pages(*file, bytes) {}

    std::unique_ptr<isosurface::StoreFile> file;
    std::size_t memory;
    StepPages<Word> pages;
    std::unique_ptr<isosurface::StoredGradients>
        gradients;  ///< of gradients_step; null before they are asked for
    std::uint32_t gradients_step = 0;
    std::vector<isosurface::MissingPage> wanted;
    std::size_t next = 0;                            ///< the next of these
    std::optional<isosurface::MissingPage> loading;  ///< at the moment
    bool is_loading_wanted = false;                  ///< whether `loading` is still wanted
    PageReads counts;
    std::uint64_t page_reads = 0;
    std::thread thread;

    [[nodiscard]] bool is_done() const { return next >= wanted.size() && !loading; }
  };

  void run(Reader& reader);
  void end();
  /// The reader that has the part of the volume in which a page is.
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
  SharedPool<isosurface::Page<Word>> free_;  ///< pages that were taken, for others that come
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool is_ended_ = false;
  std::vector<Arrived> arrived_;
  std::string problem_;
  std::set<std::pair<std::uint32_t, std::uint64_t>> damaged_;  ///< pages, by step and number
  std::vector<std::unique_ptr<Reader>> readers_;
};

extern template class PageLoader<std::uint8_t>;
extern template class PageLoader<std::uint16_t>;
extern template class PageLoader<std::uint32_t>;

}  // namespace adamas::timevarying
