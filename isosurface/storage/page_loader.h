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
#include "isosurface/storage/step_pages.h"

namespace adamas::isosurface {

/// Reads and decodes pages in threads of its own, the most important ones of those that are missing first.
/// Each thread has a part of the volume and its own memory of pages, since pages predict others; what is
/// decoded waits until it is taken. Each page is tried once: one that cannot be had is told of, and not tried
/// again.
template <class Word>
class PageLoader {
 public:
  /// A loader for pages of memories of all steps of a store. `memory`: bytes that its own pages may take,
  /// with those that wait to be taken. `arrived` is called in one of the loader's threads when there is
  /// something to take where there was nothing. Throws Error where the file cannot be opened again.
  PageLoader(
      StoredPages<Word>& pages, std::size_t memory, std::function<void()> arrived = [] {},
      std::size_t threads = 1);
  PageLoader(const PageLoader&) = delete;
  PageLoader& operator=(const PageLoader&) = delete;
  /// Waits for the pages that are being loaded.
  ~PageLoader();

  /// What is to be loaded, in this order; in place of what was wanted before.
  void want(std::vector<MissingPage> pages);
  struct Taken {
    std::vector<MissingPage> pages;         ///< those that are there now, and those that cannot be had
    std::vector<MissingPage> without_room;  ///< those for which the memory was full
  };
  /// The memory of the pages of another step; null where they are not wanted.
  using PagesOf = std::function<StoredPages<Word>*(std::uint32_t step)>;
  /// Puts what has come into the memory of a step's pages, and of its gradients if that is not null, and of
  /// other steps; pages that have come and are not wanted any more are dropped. Gradients of other steps are
  /// dropped too. Not to be called while a frame is being worked out.
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
  /// How often its files were read for pages.
  [[nodiscard]] std::uint64_t page_reads() const;

 private:
  struct Arrived {
    MissingPage what;
    std::string problem;            ///< why it cannot be had; empty: here it is
    std::optional<PageId> damaged;  ///< where that is why
    std::unique_ptr<Page<Word>> page;
    std::unique_ptr<PageSamples<std::uint16_t>> gradients;
    std::shared_ptr<const StoreFile::DirectoryPart> directory;
    bool is_wanted = true;  ///< still, by the last call of want()
  };
  /// What a thread has for itself, and, by mutex_, what it does.
  struct Reader {
    Reader(std::unique_ptr<StoreFile> of, std::size_t bytes)
        : file(std::move(of)), memory(bytes), pages(*file, bytes) {}

    std::unique_ptr<StoreFile> file;
    std::size_t memory;
    StepPages<Word> pages;
    std::unique_ptr<StoredGradients> gradients;  ///< of gradients_step; null before they are asked for
    std::uint32_t gradients_step = 0;
    std::vector<MissingPage> wanted;
    std::size_t next = 0;                ///< of those
    std::optional<MissingPage> loading;  ///< at the moment
    bool is_loading_wanted = false;      ///< that still
    PageCounts counts;
    std::uint64_t page_reads = 0;
    std::thread thread;

    [[nodiscard]] bool is_done() const { return next >= wanted.size() && !loading; }
  };

  void run(Reader& reader);
  void end();
  /// The reader that has the part of the volume in which a page is.
  [[nodiscard]] Reader& reader_of(const PageId& id);
  Arrived load(Reader& reader, const MissingPage& wanted);
  void load_part(Reader& reader, Arrived& arrived);
  static StoredGradients& gradients(Reader& reader, std::uint32_t step);
  [[nodiscard]] bool is_done() const {
    return std::ranges::all_of(readers_, [](const auto& reader) { return reader->is_done(); });
  }
  static bool put(const Arrived& arrived, StoredPages<Word>& pages, StoredGradients* gradients);
  static void note_lost(const Arrived& arrived, StoredPages<Word>& pages, StoredGradients* gradients);

  PageGrid grid_;
  std::function<void()> notify_;
  std::size_t most_arrived_;     ///< so many pages wait to be taken at most
  SharedPool<Page<Word>> free_;  ///< pages that were taken, for others that come
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

}  // namespace adamas::isosurface
