#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "isosurface/storage/stored_pages.h"

namespace adamas::isosurface {

/// The pages of the steps of a store, in one memory: where it is full, pages leave of the step that was
/// wanted least recently. What steps have decoded serves the steps that are coded with them.
template <class Word>
class StepPages {
 public:
  /// `memory`: bytes that decoded pages may take. The file must outlive this.
  StepPages(StoreFile& file, std::size_t memory);
  StepPages(const StepPages&) = delete;
  StepPages& operator=(const StepPages&) = delete;

  [[nodiscard]] StoreFile& file() const { return file_; }
  /// The pages of a step. They stay until kMostSteps others were wanted. Throws Error where tables are
  /// damaged.
  StoredPages<Word>& at(std::uint32_t step);
  static constexpr std::size_t kMostSteps = 32;
  /// The pages of a step as at() gives them, which stay as long as somebody holds them.
  std::shared_ptr<StoredPages<Word>> shared(std::uint32_t step) {
    at(step);
    return steps_.at(step).pages;
  }
  /// The pages of a step that comes after another one, to be read before it is wanted: they leave before
  /// those of that one.
  StoredPages<Word>& ahead(std::uint32_t step, const StoredPages<Word>& current);
  /// Calls for the pages of each step that has some, in ascending order, and leaves alone which leave first.
  template <class Visit>
  void for_each_in_memory(const Visit& visit) const {
    for (const auto& [step, of_step] : steps_) visit(std::as_const(*of_step.pages));
  }
  void set_memory(std::size_t bytes) { memory_->limit = bytes; }
  /// Whether bounds that a reader has done with stay, since other readers may need them.
  void set_keeps_bounds(bool keeps) { memory_->keeps_bounds = keeps; }
  /// Bytes that the decoded pages of all steps take.
  [[nodiscard]] std::size_t bytes_held() const { return memory_->taken(); }
  /// Of all steps, those that were dropped included.
  [[nodiscard]] PageCounts counts() const;

 private:
  StoredPages<Word>& found(std::uint32_t step);
  void drop_old();

  struct Step {
    std::shared_ptr<StoredPages<Word>> pages;
    std::uint64_t wanted = 0;  ///< when it was wanted last, or first for another step to be decoded
  };
  StoreFile& file_;
  std::shared_ptr<PageMemory<Word>> memory_;
  std::map<std::uint32_t, Step> steps_;
  std::uint64_t wants_ = 0;
  PageCounts dropped_;  ///< of steps that were dropped
};

extern template class StepPages<std::uint8_t>;
extern template class StepPages<std::uint16_t>;
extern template class StepPages<std::uint32_t>;

}  // namespace adamas::isosurface
