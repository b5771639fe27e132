#include "timevarying/step_pages.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace adamas::timevarying {

using namespace isosurface;

template <class Word>
SeriesPages<Word>::SeriesPages(StoreFile& file, std::uint32_t step, std::size_t memory)
    : SeriesPages(file, step, memory_for(file, memory), nullptr, nullptr) {}

template <class Word>
SeriesPages<Word>::SeriesPages(StoreFile& file, std::uint32_t step, std::shared_ptr<Memory> memory,
                               FindStep find, const SeriesPages* alike)
    : SeriesPages(file, step, std::move(memory), std::move(find), of_same_block(file, step, alike),
                  codec_of(file, step, of_same_block(file, step, alike))) {}

template <class Word>
SeriesPages<Word>::SeriesPages(StoreFile& file, std::uint32_t step, std::shared_ptr<Memory> memory,
                               FindStep find, const SeriesPages* alike, Codec codec)
    : Stored(file, step, std::move(memory),
             std::shared_ptr<const SampleCodec<Word>>(codec, &codec->in_space()), alike),
      codec_(std::move(codec)),
      find_(std::move(find)) {}

template <class Word>
std::shared_ptr<PageMemory<Word>> SeriesPages<Word>::memory_for(const StoreFile& file, std::size_t bytes) {
  const std::size_t steps = std::min(file.steps(), kWholeSteps);
  return std::make_shared<Memory>(bytes, steps * Memory::kLeast);
}

template <class Word>
const SeriesPages<Word>* SeriesPages<Word>::of_same_block(const StoreFile& file, std::uint32_t step,
                                                          const SeriesPages* alike) {
  const bool is_same =
      alike != nullptr && file.header(alike->step()).first_step == file.header(step).first_step;
  return is_same ? alike : nullptr;
}

template <class Word>
std::shared_ptr<const TimeCodec<Word>> SeriesPages<Word>::codec_of(const StoreFile& file, std::uint32_t step,
                                                                   const SeriesPages* alike) {
  if (alike != nullptr) return alike->codec_;
  const StoreHeader& header = file.header(step);
  return std::make_shared<TimeCodec<Word>>(header.coding, header.sample_tables, header.time_tables,
                                           file.name());
}

template <class Word>
SeriesPages<Word>& SeriesPages<Word>::before() {
  const std::uint32_t step = this->step() - 1;
  if (find_) return find_(step);
  if (before_ == nullptr) {
    before_ = std::make_unique<SeriesPages>(this->file(), step, this->memory(), nullptr, this);
    before_->touch(this);
  }
  return *before_;
}

template <class Word>
bool SeriesPages<Word>::decode_in_time(std::span<const std::byte> coded, const PageToLoad<Word>& page) {
  const int order = time_order(coded);
  if (order > steps_before(this->step())) return false;
  if (earlier_ == nullptr) earlier_ = std::make_unique_for_overwrite<Earlier>();
  const std::span earlier = std::span(earlier_->pages).first(static_cast<std::size_t>(order));
  SeriesPages* step = this;
  for (EarlierPage<Word>& to : earlier) {
    step = &step->before();
    const PageSamples<Word>* samples = step->samples(page.id);
    if (samples == nullptr) return false;
    to.samples = samples->samples;
    if (page.shape.complete) continue;
    if (!step->surroundings(page.id, earlier_->around, PageParts::kSamples)) return false;
    to.around = earlier_->around.samples;
  }
  return codec_->decode(coded, page.shape, page.around.samples, earlier, page.samples.samples,
                        page.samples.along);
}

template <class Word>
PageReads SeriesPages<Word>::counts() const {
  PageReads all = Stored::counts();
  if (before_ == nullptr) return all;
  const PageReads before = before_->counts();
  all.predictors += before.pages + before.predictors;
  all.copies += before.copies;
  return all;
}

template <class Word>
StepPages<Word>::StepPages(StoreFile& file, std::size_t memory)
    : file_(file), memory_(SeriesPages<Word>::memory_for(file, memory)) {}

template <class Word>
SeriesPages<Word>& StepPages<Word>::at(std::uint32_t step) {
  ++wants_;
  SeriesPages<Word>& pages = found(step);
  pages.touch();
  steps_.at(step).wanted = wants_;
  drop_old();
  return pages;
}

template <class Word>
SeriesPages<Word>& StepPages<Word>::ahead(std::uint32_t step, const StoredPages<Word>& current) {
  SeriesPages<Word>& pages = found(step);
  pages.touch(&current);
  steps_.at(step).wanted = wants_;
  return pages;
}

template <class Word>
SeriesPages<Word>& StepPages<Word>::found(std::uint32_t step) {
  const auto next = steps_.lower_bound(step);
  if (next != steps_.end() && next->first == step) return *next->second.pages;
  const std::uint32_t first = file_.header(step).first_step;
  const SeriesPages<Word>* alike = nullptr;
  if (next != steps_.begin()) alike = std::prev(next)->second.pages.get();
  if ((alike == nullptr || alike->step() < first) && next != steps_.end()) alike = next->second.pages.get();
  auto pages = std::make_shared<SeriesPages<Word>>(
      file_, step, memory_, [this](std::uint32_t other) -> SeriesPages<Word>& { return found(other); },
      alike);
  // Of the steps that one is decoded with, nearer ones are more valuable.
  if (next != steps_.end() && next->first == step + 1) pages->touch(next->second.pages.get());
  return *steps_.emplace_hint(next, step, Step{std::move(pages), wants_})->second.pages;
}

template <class Word>
void StepPages<Word>::drop_old() {
  while (steps_.size() > kMostSteps) {
    // Steps that are in use are dropped last.
    const auto oldest = std::ranges::min_element(steps_, {}, [](const auto& step) {
      return std::pair(step.second.pages.use_count() > 1, step.second.wanted);
    });
    if (oldest->second.pages.use_count() > 1) return;
    dropped_ += oldest->second.pages->counts();
    steps_.erase(oldest);
  }
}

template <class Word>
PageReads StepPages<Word>::counts() const {
  PageReads all = dropped_;
  for (const auto& [step, of_step] : steps_) all += of_step.pages->counts();
  all.bytes = file_.bytes_read();
  return all;
}

template class SeriesPages<std::uint8_t>;
template class SeriesPages<std::uint16_t>;
template class SeriesPages<std::uint32_t>;
template class StepPages<std::uint8_t>;
template class StepPages<std::uint16_t>;
template class StepPages<std::uint32_t>;

}  // namespace adamas::timevarying
