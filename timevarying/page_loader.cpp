#include "timevarying/page_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <tuple>
#include <utility>

namespace adamas::timevarying {

using namespace isosurface;

template <class Word>
PageLoader<Word>::PageLoader(StoredPages<Word>& pages, std::size_t memory, std::function<void()> arrived,
                             std::size_t threads)
    : grid_(pages.grid()),
      notify_(std::move(arrived)),
      most_arrived_(std::clamp<std::size_t>(memory / (4 * sizeof(Page<Word>)), 16, 4096)) {
  for (std::size_t n = 0; n < threads; ++n)
    readers_.push_back(
        std::make_unique<Reader>(pages.file().for_another_thread(), (memory - memory / 4) / threads));
  try {
    for (const auto& reader : readers_)
      reader->thread = std::thread([this, &of_thread = *reader] { run(of_thread); });
  } catch (...) {
    end();
    throw;
  }
}

template <class Word>
PageLoader<Word>::~PageLoader() {
  end();
}

template <class Word>
void PageLoader<Word>::end() {
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
  }
  changed_.notify_all();
  for (const auto& reader : readers_) {
    if (reader->thread.joinable()) reader->thread.join();
  }
}

template <class Word>
typename PageLoader<Word>::Reader& PageLoader<Word>::reader_of(const PageId& id) {
  // Pages of one eighth of the volume go to one reader, so that few pages predict those of several readers.
  const int up = std::max(0, grid_.top() - 2 - id.lod);
  const LatticePoint part{id.block.i >> up, id.block.j >> up, id.block.k >> up};
  return *readers_[static_cast<std::size_t>(part.i + 2 * part.j + 3 * part.k) % readers_.size()];
}

template <class Word>
void PageLoader<Word>::want(std::vector<MissingPage> pages) {
  const auto key = [this](const MissingPage& page) {
    return std::tuple(page.step, grid_.number(page.id), page.part);
  };
  using Key = decltype(key(MissingPage{}));
  std::vector<Key> keys;
  std::ranges::transform(pages, std::back_inserter(keys), key);
  std::ranges::sort(keys);
  {
    const std::lock_guard lock(mutex_);
    // A page that is in memory or on its way is not loaded again.
    std::vector<Key> known;
    const auto is_wanted = [&](const MissingPage& page) {
      const bool is_among = std::ranges::binary_search(keys, key(page));
      if (is_among) known.push_back(key(page));
      return is_among;
    };
    for (Arrived& arrived : arrived_) arrived.is_wanted = is_wanted(arrived.what);
    for (const auto& reader : readers_) {
      if (reader->loading) reader->is_loading_wanted = is_wanted(*reader->loading);
      reader->wanted.clear();
      reader->next = 0;
    }
    std::ranges::sort(known);
    for (const MissingPage& page : pages) {
      if (!std::ranges::binary_search(known, key(page))) reader_of(page.id).wanted.push_back(page);
    }
  }
  changed_.notify_all();
}

template <class Word>
void PageLoader<Word>::run(Reader& reader) {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] {
      return is_ended_ || (reader.next < reader.wanted.size() && arrived_.size() < most_arrived_);
    });
    if (is_ended_) return;
    const MissingPage wanted = reader.wanted[reader.next++];
    reader.loading = wanted;
    reader.is_loading_wanted = true;
    lock.unlock();
    Arrived arrived = load(reader, wanted);
    const PageReads counts = reader.pages.counts();
    lock.lock();
    reader.loading.reset();
    arrived.is_wanted = reader.is_loading_wanted;
    reader.counts = counts;
    reader.page_reads = reader.file->page_reads();
    if (problem_.empty()) problem_ = arrived.problem;
    if (arrived.damaged) damaged_.emplace(wanted.step, grid_.number(*arrived.damaged));
    const bool is_first = arrived_.empty();
    arrived_.push_back(std::move(arrived));
    lock.unlock();
    changed_.notify_all();
    // A single call suffices, since the receiver takes all pages.
    if (is_first) notify_();
    lock.lock();
  }
}

template <class Word>
typename PageLoader<Word>::Arrived PageLoader<Word>::load(Reader& reader, const MissingPage& wanted) {
  Arrived arrived;
  arrived.what = wanted;
  try {
    load_part(reader, arrived);
  } catch (const std::exception& error) {
    // The disk cannot be read, or tables are damaged.
    arrived.problem = error.what();
  }
  return arrived;
}

template <class Word>
StoredGradients& PageLoader<Word>::gradients(Reader& reader, std::uint32_t step) {
  if (reader.gradients == nullptr || reader.gradients_step != step)
    reader.gradients = std::make_unique<StoredGradients>(*reader.file, step, reader.memory / 2);
  reader.gradients_step = step;
  return *reader.gradients;
}

template <class Word>
void PageLoader<Word>::load_part(Reader& reader, Arrived& arrived) {
  const auto& [id, part, view_class, depth, step] = arrived.what;
  StoreFile& file = *reader.file;
  const auto note_damaged = [&](const PageId& damaged) {
    arrived.damaged = damaged;
    arrived.problem = fmt::format("{}: {} is damaged", file.name(), page_name(damaged));
  };
  if (part == MissingPage::Part::kDirectory) {
    arrived.directory = file.directory_part(step, id);
    if (!file.entry(step, id)) note_damaged(id);
    return;
  }
  if (part == MissingPage::Part::kGradients) {
    StoredGradients& from = gradients(reader, step);
    const PageSamples<std::uint16_t>* const found = from.samples(id);
    if (found == nullptr) return note_damaged(from.last_damaged());
    arrived.gradients = std::make_unique<PageSamples<std::uint16_t>>(*found);
    return;
  }
  StoredPages<Word>& pages = reader.pages.at(step);
  arrived.page = free_.take();
  if (arrived.page == nullptr) arrived.page = std::make_unique_for_overwrite<Page<Word>>();
  if (part == MissingPage::Part::kAll) {
    if (!pages.copy(id, *arrived.page)) note_damaged(pages.last_damaged());
    return;
  }
  const PageSamples<Word>* const found = pages.samples(id);
  if (found == nullptr) return note_damaged(pages.last_damaged());
  static_cast<PageSamples<Word>&>(*arrived.page) = *found;
}

template <class Word>
typename PageLoader<Word>::Taken PageLoader<Word>::take(StoredPages<Word>& pages, StoredGradients* gradients,
                                                        const PagesOf& pages_of) {
  std::vector<Arrived> arrived;
  {
    const std::lock_guard lock(mutex_);
    arrived = std::exchange(arrived_, {});
  }
  changed_.notify_all();
  Taken taken;
  for (const Arrived& one : arrived) {
    if (one.directory) pages.file().take_over(one.directory);
    const bool is_of_step = one.what.step == pages.step();
    StoredPages<Word>* const to = is_of_step ? &pages : pages_of(one.what.step);
    if (to == nullptr) continue;
    if (!one.problem.empty()) {
      note_lost(one, *to, is_of_step ? gradients : nullptr);
      taken.pages.push_back(one.what);
      continue;
    }
    const bool is_of_no_use = one.what.part == MissingPage::Part::kGradients && !is_of_step;
    if (!one.is_wanted || is_of_no_use) continue;
    const bool has_room = put(one, *to, gradients);
    (has_room ? taken.pages : taken.without_room).push_back(one.what);
  }
  for (Arrived& one : arrived) free_.give(std::move(one.page));
  return taken;
}

template <class Word>
bool PageLoader<Word>::put(const Arrived& arrived, StoredPages<Word>& pages, StoredGradients* gradients) {
  const PageId& id = arrived.what.id;
  const int importance = arrived.what.view_class;
  switch (arrived.what.part) {
    case MissingPage::Part::kDirectory:
      return true;
    case MissingPage::Part::kGradients:
      return gradients == nullptr || gradients->put(id, *arrived.gradients, nullptr, importance);
    case MissingPage::Part::kSamples:
      return pages.put(id, *arrived.page, nullptr, importance);
    case MissingPage::Part::kAll:
      break;
  }
  return pages.put(id, *arrived.page, arrived.page.get(), importance);
}

template <class Word>
void PageLoader<Word>::note_lost(const Arrived& arrived, StoredPages<Word>& pages,
                                 StoredGradients* gradients) {
  if (arrived.what.part != MissingPage::Part::kGradients) {
    pages.note_lost(arrived.what.id);
  } else if (gradients != nullptr) {
    gradients->note_lost(arrived.what.id);
  }
}

template <class Word>
bool PageLoader<Word>::is_idle() const {
  const std::lock_guard lock(mutex_);
  return is_done() && arrived_.empty();
}

template <class Word>
void PageLoader<Word>::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !arrived_.empty() || is_done(); });
}

template <class Word>
std::string PageLoader<Word>::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

template <class Word>
PageReads PageLoader<Word>::counts() const {
  const std::lock_guard lock(mutex_);
  PageReads all;
  for (const auto& reader : readers_) all += reader->counts;
  // Several readers may find the same damaged page.
  all.damaged = damaged_.size();
  return all;
}

template <class Word>
std::uint64_t PageLoader<Word>::page_reads() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t all = 0;
  for (const auto& reader : readers_) all += reader->page_reads;
  return all;
}

template class PageLoader<std::uint8_t>;
template class PageLoader<std::uint16_t>;
template class PageLoader<std::uint32_t>;

}  // namespace adamas::timevarying
