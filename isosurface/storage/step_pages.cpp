#include "isosurface/storage/step_pages.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace adamas::isosurface {

template <class Word>
StepPages<Word>::StepPages(StoreFile& file, std::size_t memory)
    : file_(file), memory_(StoredPages<Word>::memory_for(file, memory)) {}

template <class Word>
StoredPages<Word>& StepPages<Word>::at(std::uint32_t step) {
  ++wants_;
  StoredPages<Word>& pages = found(step);
  pages.touch();
  steps_.at(step).wanted = wants_;
  drop_old();
  return pages;
}

template <class Word>
StoredPages<Word>& StepPages<Word>::ahead(std::uint32_t step, const StoredPages<Word>& current) {
  StoredPages<Word>& pages = found(step);
  pages.touch(&current);
  steps_.at(step).wanted = wants_;
  return pages;
}

template <class Word>
StoredPages<Word>& StepPages<Word>::found(std::uint32_t step) {
  const auto next = steps_.lower_bound(step);
  if (next != steps_.end() && next->first == step) return *next->second.pages;
  const std::uint32_t first = file_.header(step).first_step;
  const StoredPages<Word>* alike = nullptr;
  if (next != steps_.begin()) alike = std::prev(next)->second.pages.get();
  if ((alike == nullptr || alike->step() < first) && next != steps_.end()) alike = next->second.pages.get();
  auto pages = std::make_shared<StoredPages<Word>>(
      file_, step, memory_, [this](std::uint32_t other) -> StoredPages<Word>& { return found(other); },
      alike);
  // The steps that one is decoded with are worth more the nearer they are.
  if (next != steps_.end() && next->first == step + 1) pages->touch(next->second.pages.get());
  return *steps_.emplace_hint(next, step, Step{std::move(pages), wants_})->second.pages;
}

template <class Word>
void StepPages<Word>::drop_old() {
  while (steps_.size() > kMostSteps) {
    // Steps that somebody holds come last.
    const auto oldest = std::ranges::min_element(steps_, {}, [](const auto& step) {
      return std::pair(step.second.pages.use_count() > 1, step.second.wanted);
    });
    if (oldest->second.pages.use_count() > 1) return;
    dropped_ += oldest->second.pages->counts();
    steps_.erase(oldest);
  }
}

template <class Word>
PageCounts StepPages<Word>::counts() const {
  PageCounts all = dropped_;
  for (const auto& [step, of_step] : steps_) all += of_step.pages->counts();
  all.bytes = file_.bytes_read();
  return all;
}

template class StepPages<std::uint8_t>;
template class StepPages<std::uint16_t>;
template class StepPages<std::uint32_t>;

}  // namespace adamas::isosurface
