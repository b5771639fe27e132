#include "timevarying/read_ahead.h"

#include <algorithm>
#include <memory>

#include "core/base/hash.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

/// A growing stretch of the file that contains whole pages of a group.
class GrowingStretch {
 public:
  GrowingStretch(const PageGroup& group, std::size_t place, const PageRuns& in_memory,
                 std::uint64_t file_size)
      : group_(group), in_memory_(in_memory), file_size_(file_size), first_(place), last_(place) {
    stretch_ = with(place, {group[place].offset, group[place].offset});
  }

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] std::size_t last() const { return last_; }
  [[nodiscard]] const FileStretch& stretch() const { return stretch_; }

  /// Extends the stretch to a place, or as far as no page is in memory, if it then has at most `most` bytes.
  /// Returns whether it has reached the place.
  bool grow(std::size_t place, std::uint64_t most) {
    const FileStretch all = with(place, stretch_);
    if (all.end - all.begin > most || all.end > file_size_) return false;
    while (place < first_ && !is_in_memory(first_ - 1)) stretch_ = with(--first_, stretch_);
    while (place > last_ && !is_in_memory(last_ + 1)) stretch_ = with(++last_, stretch_);
    return first_ <= place && place <= last_;
  }

 private:
  /// The stretch extended by another one. Pages without bytes lie at the beginning of the next ones.
  [[nodiscard]] FileStretch with(std::size_t place, const FileStretch& stretch) const {
    const PageEntry& page = group_[place];
    return {std::min(stretch.begin, page.offset), std::max(stretch.end, page.offset + page.size)};
  }
  [[nodiscard]] bool is_in_memory(std::size_t place) const {
    const PageEntry& page = group_[place];
    return page.size > 0 && in_memory_.has(page.offset, page.size);
  }

  const PageGroup& group_;
  const PageRuns& in_memory_;
  std::uint64_t file_size_;
  std::size_t first_, last_;
  FileStretch stretch_;
};

class StepPlan final : public ReadPlan {
 public:
  explicit StepPlan(const ReadAhead& ahead) : ahead_(ahead) {}

  [[nodiscard]] FileStretch stretch(const PageGroup& group, std::size_t place, std::size_t coded_with,
                                    const PageRuns& in_memory, std::uint64_t file_size) const override {
    return stretch_to_read(group, place, coded_with, ahead_, in_memory, file_size);
  }
  [[nodiscard]] std::size_t memory() const override { return ahead_.memory; }

 private:
  ReadAhead ahead_;
};

}  // namespace

std::uint64_t ReadAhead::length(std::uint64_t offset) const {
  const std::uint64_t spread = fibonacci_slot(offset, 8);
  return bytes - bytes / 4 + bytes / 2 * spread / 255;
}

void set_read_ahead(StoreFile& file, const ReadAhead& ahead) {
  file.set_read_plan(ahead.is_on() ? std::make_shared<StepPlan>(ahead) : nullptr);
}

FileStretch stretch_to_read(const PageGroup& group, std::size_t place, std::size_t coded_with,
                            const ReadAhead& ahead, const PageRuns& in_memory, std::uint64_t file_size) {
  const std::size_t pages = group.pages();
  const std::uint64_t length = ahead.length(group[place].offset);
  GrowingStretch read(group, place, in_memory, file_size);
  // If the group has only one page, its steps are all that is needed, whatever their size.
  const std::uint64_t most = pages == 1 ? file_size : length;
  for (std::size_t n = 1; n <= coded_with && read.grow(place - n * pages, most);) ++n;
  // Pages of a step are requested in ascending order, in whichever direction steps go.
  if (ahead.is_backward) {
    const std::size_t end_of_step = (read.last() / pages + 1) * pages;
    while (read.last() + 1 < end_of_step && read.grow(read.last() + 1, length)) continue;
    while (read.first() > 0 && read.grow(read.first() - 1, length)) continue;
  } else {
    read.grow(read.first() / pages * pages, length);
    while (read.last() + 1 < group.size() && read.grow(read.last() + 1, length)) continue;
  }
  return read.stretch();
}

}  // namespace adamas::timevarying
