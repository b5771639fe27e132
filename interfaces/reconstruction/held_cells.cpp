#include "interfaces/reconstruction/held_cells.h"

#include <algorithm>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/base/release_memory.h"

namespace adamas::interfaces {

HeldCells::HeldCells(const MultiMaterialData& data, const SiteValues& values)
    : values_(values), row_(data.grid.sites(0)) {
  const std::size_t ny = data.grid.sites(1), nz = data.grid.sites(2);
  std::vector<std::vector<Run>> rows(ny * nz);
  parallel_for(rows.size(), 64, [&](std::size_t row) { rows[row] = runs_of_row(row * row_); });
  first_of_row_.push_back(0);
  for (std::vector<Run>& row : rows) {
    runs_.insert(runs_.end(), row.begin(), row.end());
    first_of_row_.push_back(static_cast<std::uint32_t>(runs_.size()));
    release_memory(row);
  }
  DisjointSets sets(runs_.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    LoopProgress::check_step(row);
    const std::size_t j = row % ny, k = row / ny;
    if (j > 0) join_rows(row, row - 1, sets);
    if (k == 0) continue;
    for (std::size_t other = j > 0 ? j - 1 : j; other < std::min(j + 2, ny); ++other)
      join_rows(row, other + ny * (k - 1), sets);
  }
  number_groups(std::move(sets).roots());
}

/// Finds the runs of the row that begins at a site, by material.
std::vector<HeldCells::Run> HeldCells::runs_of_row(std::size_t first) const {
  std::vector<Run> runs;
  for (std::size_t site = first; site < first + row_; ++site) {
    const auto begin = static_cast<std::uint32_t>(site);
    for (const SiteValues::Entry& entry : values_.at(site)) {
      const MaterialId material = values_.material(entry.material);
      if (!(entry.fraction > kFractionTrace)) continue;
      const auto last =
          std::find_if(runs.rbegin(), runs.rend(), [&](const Run& run) { return run.material == material; });
      if (last != runs.rend() && last->end >= begin) {
        last->end = begin + 1;
      } else {
        runs.push_back({material, begin, begin + 1});
      }
    }
  }
  std::sort(runs.begin(), runs.end());
  return runs;
}

/// Joins the runs of two rows that touch by faces, edges or corners.
void HeldCells::join_rows(std::size_t row, std::size_t other, DisjointSets& sets) const {
  const auto away = static_cast<std::uint32_t>((row - other) * row_);
  std::uint32_t a = first_of_row_[row], b = first_of_row_[other];
  while (a < first_of_row_[row + 1] && b < first_of_row_[other + 1]) {
    const Run &one = runs_[a], &two = runs_[b];
    const std::uint32_t begin = two.begin + away, end = two.end + away;
    if (one.material != two.material) {
      ++(one.material < two.material ? a : b);
      continue;
    }
    if (one.begin <= end && begin <= one.end) sets.join(a, b);
    // Runs of one material in a row do not touch each other.
    ++(one.end < end ? a : b);
  }
}

/// Numbers the groups in the order of their first cells, and at one cell in that of the materials' names.
void HeldCells::number_groups(const std::vector<std::uint32_t>& roots) {
  struct First {
    std::uint32_t site;
    std::uint16_t material;
    std::uint32_t run;
    auto operator<=>(const First&) const = default;
  };
  std::vector<First> firsts;
  for (std::uint32_t run = 0; run < runs_.size(); ++run) {
    if (roots[run] != run) continue;
    const SiteValues::Entry& entry = *find(runs_[run].begin, runs_[run].material);
    firsts.push_back({runs_[run].begin, values_.material_number(entry.material), run});
  }
  std::sort(firsts.begin(), firsts.end());
  for (std::uint32_t group = 0; group < firsts.size(); ++group) runs_[firsts[group].run].group = group;
  first_runs_.assign(firsts.size() + 1, 0);
  for (std::uint32_t run = 0; run < runs_.size(); ++run) {
    runs_[run].group = runs_[roots[run]].group;
    ++first_runs_[runs_[run].group + 1];
  }
  for (std::size_t group = 1; group < first_runs_.size(); ++group)
    first_runs_[group] += first_runs_[group - 1];
  std::vector<std::uint32_t> next(first_runs_.begin(), first_runs_.end());
  runs_of_groups_.resize(runs_.size());
  for (std::uint32_t run = 0; run < runs_.size(); ++run) runs_of_groups_[next[runs_[run].group]++] = run;
}

const SiteValues::Entry* HeldCells::find(std::size_t site, MaterialId material) const {
  const SiteValues::Entry* found = nullptr;
  for (const SiteValues::Entry& entry : values_.at(site)) {
    if (values_.material(entry.material) == material && entry.fraction > kFractionTrace &&
        (found == nullptr || entry.fraction > found->fraction))
      found = &entry;
  }
  return found;
}

std::uint32_t HeldCells::group(std::size_t site, MaterialId material) const {
  const std::size_t row = site / row_;
  const auto begin = runs_.begin() + first_of_row_[row], end = runs_.begin() + first_of_row_[row + 1];
  const auto at = static_cast<std::uint32_t>(site);
  // The last run that begins at the site or before it.
  const auto behind = std::upper_bound(begin, end, at, [&](std::uint32_t s, const Run& run) {
    return material < run.material || (material == run.material && s < run.begin);
  });
  if (behind == begin) return kNone;
  const Run& run = *(behind - 1);
  return run.material == material && at < run.end ? run.group : kNone;
}

}  // namespace adamas::interfaces
