#include "isosurface/storage/page_runs.h"

#include <algorithm>
#include <iterator>

namespace adamas::isosurface {

std::list<PageRuns::Run>::const_iterator PageRuns::find(std::uint64_t offset, std::uint64_t size) const {
  const auto after = by_offset_.upper_bound(offset);
  if (after == by_offset_.begin()) return runs_.end();
  const std::list<Run>::const_iterator run = std::prev(after)->second;
  const std::uint64_t from = offset - run->offset;
  return from > run->bytes.size() || size > run->bytes.size() - from ? runs_.end() : run;
}

bool PageRuns::has(std::uint64_t offset, std::uint64_t size) const {
  const std::lock_guard lock(mutex_);
  return find(offset, size) != runs_.end();
}

bool PageRuns::copy(std::uint64_t offset, std::span<std::byte> to) {
  const std::lock_guard lock(mutex_);
  const std::list<Run>::const_iterator run = find(offset, to.size());
  if (run == runs_.end()) return false;
  std::copy_n(run->bytes.begin() + static_cast<std::ptrdiff_t>(offset - run->offset), to.size(), to.begin());
  runs_.splice(runs_.end(), runs_, run);
  return true;
}

void PageRuns::put(std::uint64_t offset, std::span<const std::byte> bytes, std::size_t memory) {
  const std::lock_guard lock(mutex_);
  const auto remove = [this](std::list<Run>::iterator run) {
    taken_ -= run->bytes.size();
    by_offset_.erase(run->offset);
    runs_.erase(run);
  };
  if (const auto known = by_offset_.find(offset); known != by_offset_.end()) remove(known->second);
  while (!runs_.empty() && taken_ + bytes.size() > memory) remove(runs_.begin());
  runs_.push_back({offset, {bytes.begin(), bytes.end()}});
  by_offset_[offset] = std::prev(runs_.end());
  taken_ += bytes.size();
}

}  // namespace adamas::isosurface
