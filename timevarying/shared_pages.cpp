#include "timevarying/shared_pages.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/parallel.h"
#include "isosurface/volume/samples.h"

namespace adamas::timevarying {

using namespace isosurface;

void FairMutex::lock() {
  std::unique_lock lock(mutex_);
  const std::uint64_t turn = next_++;
  changed_.wait(lock, [&] { return served_ == turn; });
}

void FairMutex::unlock() {
  {
    const std::lock_guard lock(mutex_);
    ++served_;
  }
  changed_.notify_all();
}

std::unique_ptr<SharedPages> SharedPages::open(StoreFile& file, std::size_t memory) {
  return with_sample_type(file.header().grid.type, [&](auto sample) -> std::unique_ptr<SharedPages> {
    return std::make_unique<SharedPagesOf<OrderedWord<decltype(sample)>>>(file, memory);
  });
}

template <class Word>
SharedPagesOf<Word>::SharedPagesOf(StoreFile& file, std::size_t memory)
    : SharedPages(file), memory_(memory), steps_(file, memory) {}

template <class Word>
PageReads SharedPagesOf<Word>::counts() {
  PageReads counts = steps_.counts();
  counts += loaded_before_;
  if (loader_) counts += loader_->counts();
  return counts;
}

template <class Word>
std::uint64_t SharedPagesOf<Word>::page_reads() {
  return file_.page_reads() + reads_before_ + (loader_ ? loader_->page_reads() : 0);
}

template <class Word>
std::size_t SharedPagesOf<Word>::bytes_held() {
  return steps_.bytes_held();
}

template <class Word>
std::shared_ptr<StoredGradients> SharedPagesOf<Word>::gradients(std::uint32_t step) {
  if (!file_.header(step).gradients) return nullptr;
  if (!gradients_ || gradients_step_ != step) {
    gradients_ = std::make_shared<StoredGradients>(file_, step, StoredGradients::kMemory);
    gradients_step_ = step;
  }
  return gradients_;
}

template <class Word>
void SharedPagesOf<Word>::open_loader() {
  if (loader_) return;
  // The loader decodes again the pages that predict others, and those that others are coded with.
  const std::size_t of_loader = file_.steps() > 1 ? memory_ / 2 : memory_ / 4;
  steps_.set_memory(memory_ - of_loader);
  // Some threads are left for the frames themselves.
  const std::size_t threads = std::clamp<std::size_t>(thread_limit() / 4, 1, 4);
  loader_ = std::make_unique<PageLoader<Word>>(users_.front()->pages(), of_loader, arrived_, threads);
}

template <class Word>
void SharedPagesOf<Word>::remove_user(PageUser<Word>& user) {
  std::erase(users_, &user);
  steps_.set_keeps_bounds(has_several_users());
  if (!loader_) return;
  if (!users_.empty()) return load_wanted();
  loaded_before_ += loader_->counts();
  reads_before_ += loader_->page_reads();
  loader_.reset();
  steps_.set_memory(memory_);
}

template <class Word>
std::vector<MissingPage> SharedPagesOf<Word>::wanted_pages() {
  std::vector<MissingPage> wanted;
  std::set<std::tuple<std::uint32_t, std::uint64_t, MissingPage::Part>> known;
  const auto add = [&](const MissingPage& page) {
    if (known.emplace(page.step, file_.grid().number(page.id), page.part).second) wanted.push_back(page);
  };
  // The most important pages of each user come first.
  std::size_t most = 0, most_steps = 0;
  for (const PageUser<Word>* const user : users_) {
    most = std::max(most, user->missing.size());
    most_steps = std::max(most_steps, user->expected.size());
  }
  for (std::size_t n = 0; n < most; ++n) {
    for (const PageUser<Word>* const user : users_) {
      if (n < user->missing.size()) add(user->missing[n]);
    }
  }
  for (std::size_t n = 0; n < most_steps; ++n) {
    for (PageUser<Word>* const user : users_) {
      if (n >= user->expected.size() || user->expected[n] == user->pages().step()) continue;
      Pages& pages = steps_.ahead(user->expected[n], user->pages());
      for (MissingPage page : user->needed) {
        page.step = user->expected[n];
        if (!pages.is_lost(page.id) && !pages.has(page.id, parts_of(page))) add(page);
      }
    }
  }
  return wanted;
}

template <class Word>
void SharedPagesOf<Word>::load_wanted() {
  loader_->want(wanted_pages());
}

template <class Word>
void SharedPagesOf<Word>::note_needs() {
  for (PageUser<Word>* const user : users_) user->pages().forget_needs();
  for (PageUser<Word>* const user : users_) {
    for (const MissingPage& page : user->needed) user->pages().need(page.id, page.view_class);
  }
}

template <class Word>
typename SharedPagesOf<Word>::Pages* SharedPagesOf<Word>::pages_of(std::uint32_t step, PageUser<Word>& user) {
  for (PageUser<Word>* const other : users_) {
    if (other->pages().step() == step) return &other->pages();
  }
  const bool is_expected = std::ranges::any_of(users_, [step](const PageUser<Word>* other) {
    return std::ranges::find(other->expected, step) != other->expected.end();
  });
  return is_expected ? &steps_.ahead(step, user.pages()) : nullptr;
}

template <class Word>
void SharedPagesOf<Word>::take_arrived(PageUser<Word>& user, StoredGradients* gradients) {
  if (!loader_) return;
  // A frame that is the only user notes its needs itself.
  if (has_several_users()) note_needs();
  const auto taken =
      loader_->take(user.pages(), gradients, [&](std::uint32_t step) { return pages_of(step, user); });
  for (PageUser<Word>* const other : users_) other->note(taken);
}

template class SharedPagesOf<std::uint8_t>;
template class SharedPagesOf<std::uint16_t>;
template class SharedPagesOf<std::uint32_t>;

}  // namespace adamas::timevarying
