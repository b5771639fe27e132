#include "datasets/local_scene.h"

#include <algorithm>
#include <limits>

#include "core/base/assert.h"
#include "core/base/sort_unique.h"

namespace adamas::datasets {

namespace {

// Ranges are exact to round-off; the slack, relative to the box's diagonal, keeps functions and candidates
// that only touch.
constexpr double kSlack = 1e-12;

}  // namespace

LocalScene::LocalScene(const Scene& scene)
    : scene_(&scene), pool_(scene.candidates()), count_(pool_.size()), ranges_(scene.functions().size()) {
  drop_dominated_candidates();
  collect_functions();
}

void LocalScene::restrict_to(const LocalScene& parent, const Box3& box) {
  ADAMAS_ASSERT(&parent != this && parent.scene_ == scene_);
  const double slack = kSlack * scene_->box().diagonal();
  for (const std::uint32_t index : parent.functions_) {
    ranges_[index] = scene_->functions()[index].range(box);
    ranges_[index].low -= slack;
    ranges_[index].high += slack;
  }
  double best_low = -std::numeric_limits<double>::infinity();
  const auto least = [this](const SceneCandidate& candidate) {
    FunctionRange range{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (const std::uint32_t index : candidate.functions) {
      range.low = std::min(range.low, ranges_[index].low);
      range.high = std::min(range.high, ranges_[index].high);
    }
    return range;
  };
  for (const SceneCandidate& candidate : parent.candidates()) {
    best_low = std::max(best_low, least(candidate).low);
  }
  count_ = 0;
  for (const SceneCandidate& candidate : parent.candidates()) {
    if (least(candidate).high < best_low) continue;
    if (count_ == pool_.size()) pool_.emplace_back();
    pool_[count_++] = candidate;
  }
  drop_functions_that_never_bind();
  drop_dominated_candidates();
  collect_functions();
}

void LocalScene::drop_functions_that_never_bind() {
  for (SceneCandidate& candidate : in_use()) {
    double least_high = std::numeric_limits<double>::infinity();
    for (const std::uint32_t index : candidate.functions)
      least_high = std::min(least_high, ranges_[index].high);
    std::erase_if(candidate.functions, [&](std::uint32_t index) { return ranges_[index].low > least_high; });
  }
}

void LocalScene::drop_dominated_candidates() {
  // A candidate that has all functions of another one of the same owner, and perhaps more, is never above it.
  for (std::size_t i = 0; i < count_;) {
    const auto dominates = [&](std::size_t j) {
      const SceneCandidate &a = pool_[i], &b = pool_[j];
      return j != i && a.owner == b.owner &&
             std::includes(a.functions.begin(), a.functions.end(), b.functions.begin(), b.functions.end());
    };
    bool dominated = false;
    for (std::size_t j = 0; j < count_ && !dominated; ++j) dominated = dominates(j);
    if (dominated) {
      std::rotate(pool_.begin() + static_cast<std::ptrdiff_t>(i),
                  pool_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                  pool_.begin() + static_cast<std::ptrdiff_t>(count_));
      --count_;
    } else {
      ++i;
    }
  }
}

void LocalScene::collect_functions() {
  functions_.clear();
  for (const SceneCandidate& candidate : candidates()) {
    functions_.insert(functions_.end(), candidate.functions.begin(), candidate.functions.end());
  }
  sort_unique(functions_);
  linear_ = std::all_of(functions_.begin(), functions_.end(),
                        [this](std::uint32_t index) { return scene_->functions()[index].is_linear(); });
}

std::optional<MaterialId> LocalScene::sole_owner() const {
  const MaterialId first = pool_.front().owner;
  const bool sole = std::all_of(candidates().begin(), candidates().end(),
                                [first](const SceneCandidate& c) { return c.owner == first; });
  return sole ? std::optional(first) : std::nullopt;
}

void CubeValues::sample(const LocalScene& local, const std::array<Vec3, 8>& corners) {
  const auto& functions = local.scene().functions();
  values_.resize(functions.size());
  for (const std::uint32_t index : local.functions()) {
    for (std::size_t c = 0; c < 8; ++c) values_[index][c] = functions[index].value(corners[c]);
  }
}

double CubeValues::value(std::uint32_t function, std::size_t corner) const {
  return values_[function][corner];
}

void CubeValues::problem(const LocalScene& local, std::size_t t, OwnershipProblem& result) const {
  const auto& corners = kCubeTetrahedra[t];
  result.clear();
  for (const SceneCandidate& candidate : local.candidates()) {
    result.add_candidate(candidate.owner.value);
    for (const std::uint32_t index : candidate.functions) {
      const auto& v = values_[index];
      result.add_function({v[corners[0]], v[corners[1]], v[corners[2]], v[corners[3]]}, index);
    }
  }
}

}  // namespace adamas::datasets
