#include "isosurface/extraction/surface_normals.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/base/large_pages.h"
#include "core/base/parallel.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/gradients/gradient_estimator.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// Returns the unit vector that points to lesser values, or zero.
Vec3 downwards(const Vec3& gradient) {
  const double length = norm(gradient);
  return length > 0 && std::isfinite(length) ? -1 / length * gradient : Vec3{};
}

/// Gradients at lattice points; only directions if the store has them. Recent ones are not computed again,
/// since consecutive points are near each other in space.
template <class Sample>
class VertexGradients {
 public:
  explicit VertexGradients(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent = nullptr)
      : samples_(pages), stored_(lent) {
    if (lent == nullptr) open_stored();
  }

  void set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent) {
    samples_.set_pages(pages);
    if (lent != nullptr) {
      stored_ = lent;
    } else if (own_stored_ || stored_ == nullptr) {
      open_stored();
    }
    lost_.clear();
    missing_.clear();
    std::ranges::fill(known_, KnownGradient{});
  }

  /// Returns the stored gradient, or one from neighbours `step` away.
  Vec3 at(LatticePoint p, std::int32_t step) {
    KnownGradient& known = known_[hash_value(p) >> (64 - kKnownBits)];
    // Vertices of a finer mesh than this one have a gradient of their own.
    if (known.point != p || known.step != step) {
      known = {p, step, stored_ ? stored(p, step) : estimate(p, step)};
      // Data that may still come are looked up again.
      if (is_provisional_) forget(known);
    }
    return known.gradient;
  }

  /// Returns the damaged pages that some gradient was computed without.
  [[nodiscard]] const std::vector<PageId>& lost() const { return lost_; }
  std::vector<MissingNormals> take_missing() { return std::exchange(missing_, {}); }
  StoredGradients* stored() { return stored_; }

 private:
  void open_stored() {
    StoredPages<OrderedWord<Sample>>& pages = samples_.pages();
    if (!pages.file().header().gradients) return;
    stored_ = &own_stored_.emplace(pages.file(), pages.step(), StoredGradients::kMemory);
  }

  Vec3 stored(LatticePoint p, std::int32_t step) {
    if (const bool loads = samples_.pages().loads(); loads != stored_->loads()) stored_->set_loading(loads);
    const LatticePoint at = samples_.in_samples(p);
    const std::optional<Vec3> direction = stored_->direction(at);
    if (direction) return *direction;
    if (stored_->loads()) {
      note_lost(stored_->last_damaged());
    } else {
      note_missing(*stored_, {stored_->page_of(at), true});
    }
    return -downwards(estimate(p, step));
  }

  struct KnownGradient {
    LatticePoint point = kNoKey<LatticePoint>;
    std::int32_t step = 0;  ///< distance of the neighbours of the gradient
    Vec3 gradient;
  };
  [[gnu::cold]] void forget(KnownGradient& known) {
    known.point = kNoKey<LatticePoint>;
    is_provisional_ = false;
  }

  template <class Pages>
  [[gnu::cold]] void note_missing(const Pages& pages, const MissingNormals& missing) {
    // Data that are lost for good make no gradient provisional.
    if (pages.is_lost(missing.page)) return;
    is_provisional_ = true;
    if (std::find(missing_.begin(), missing_.end(), missing) == missing_.end()) missing_.push_back(missing);
  }

  void note_lost(const PageId& page) {
    if (std::find(lost_.begin(), lost_.end(), page) == lost_.end()) lost_.push_back(page);
  }

  /// Returns a lesser step, if along some axis there are no samples so far away.
  [[nodiscard]] std::int32_t step_inside(LatticePoint p, std::int32_t step) const {
    const LatticePoint last = samples_.last_sample();
    for (int axis = 0; axis < 3; ++axis) {
      while (samples_.lod({step, step, step}) > 0 && p[axis] - step < 0 && p[axis] + step > last[axis])
        step /= 2;
    }
    return step;
  }

  Vec3 estimate(LatticePoint p, std::int32_t wanted_step) {
    const std::int32_t step = step_inside(p, wanted_step);
    typename LatticeSamples<Sample>::Block words;
    Neighbourhood values;
    if (samples_.samples_round(p, step, words)) {
      // Differences of words are those of the samples.
      if constexpr (std::is_integral_v<Sample>) return estimator(step).central(words);
      std::ranges::transform(words, values.begin(), LatticeSamples<Sample>::value);
    } else {
      for (int dk = -1; dk <= 1; ++dk) {
        for (int dj = -1; dj <= 1; ++dj) {
          for (int di = -1; di <= 1; ++di)
            values[neighbour(di, dj, dk)] = sample(p + step * LatticePoint{di, dj, dk});
        }
      }
    }
    return estimator(step)(values);
  }

  double sample(LatticePoint p) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const LatticePoint last = samples_.last_sample();
    if (p.i < 0 || p.j < 0 || p.k < 0 || p.i > last.i || p.j > last.j || p.k > last.k) return kNone;
    try {
      return samples_.sample(p);
    } catch (const PageLost& missing) {
      if (samples_.pages().loads()) {
        note_lost(missing.damaged);
      } else {
        note_missing(samples_.pages(), {missing.page, false});
      }
      return kNone;
    }
  }

  const GradientEstimator& estimator(std::int32_t step) {
    auto& found = estimators_[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(step)))];
    if (!found) found = std::make_unique<GradientEstimator>(step * samples_.domain().spacing());
    return *found;
  }

  static constexpr int kKnownBits = 12;

  LatticeSamples<Sample> samples_;
  std::optional<StoredGradients> own_stored_;
  StoredGradients* stored_;  ///< null if the store keeps none
  std::array<std::unique_ptr<GradientEstimator>, kRootBits + 1> estimators_;
  std::vector<PageId> lost_;
  std::vector<MissingNormals> missing_;
  bool is_provisional_ = false;  ///< whether the last gradient was computed without data that may still come
  std::vector<KnownGradient> known_ = std::vector<KnownGradient>(std::size_t{1} << kKnownBits);
};

/// Returns the normal of a point, given the gradients at lattice points.
template <class Sample>
Vec3 normal_of(const EdgePoint& edge, VertexGradients<Sample>& gradients) {
  const Vec3 a = gradients.at(edge.first, edge.step()), b = gradients.at(edge.second, edge.step());
  return downwards((1 - edge.parameter) * a + edge.parameter * b);
}
template <class Sample>
Vec3 normal_of(const VertexPoint& point, VertexGradients<Sample>& gradients) {
  return downwards(gradients.at(point.vertex, point.step));
}
template <class Sample>
Vec3 normal_of(const MeanPoint& point, VertexGradients<Sample>& gradients) {
  Vec3 gradient;
  for (std::size_t v = 0; v < 4; ++v) {
    if (point.weights[v] != 0) gradient += point.weights[v] * gradients.at(point.vertices[v], point.step);
  }
  return downwards(gradient);
}

/// Computes the normals of the n-th of several parts of a surface's points of each kind.
template <class Sample>
class NormalsOfPart {
 public:
  NormalsOfPart(StoredPages<OrderedWord<Sample>>& pages, const Contour& contour, std::vector<Vec3>& normals)
      : gradients_(pages), contour_(contour), normals_(normals) {}

  void find(std::size_t n, std::size_t parts, Progress& progress) {
    std::size_t first = 0;
    const auto each = [&](const auto& points) {
      const std::size_t begin = points.size() * n / parts, end = points.size() * (n + 1) / parts;
      for (std::size_t p = begin; p < end; ++p) {
        if (p % 65536 == 0)
          progress.step("normals", static_cast<double>(first + p) / static_cast<double>(normals_.size()));
        normals_[first + p] = normal_of(points[p], gradients_);
      }
      first += points.size();
    };
    each(contour_.edge_points);
    each(contour_.vertex_points);
    each(contour_.mean_points);
  }
  [[nodiscard]] const std::vector<PageId>& lost() const { return gradients_.lost(); }

 private:
  VertexGradients<Sample> gradients_;
  const Contour& contour_;
  std::vector<Vec3>& normals_;
};

}  // namespace

template <class Sample>
SurfaceNormals surface_normals(StoredPages<OrderedWord<Sample>>& pages, const Contour& contour,
                               Progress& progress) {
  SurfaceNormals result;
  reserve_in_large_pages(result.normals, contour.points.size());
  result.normals.resize(contour.points.size());
  progress.step("normals", 0);
  // Threads do not pay for a few points. A thread has the same part of the surface for which it has read
  // pages before.
  constexpr std::size_t kLeastPoints = 20'000;
  const std::vector<StoredPages<OrderedWord<Sample>>*> thread_pages =
      pages.for_threads(std::clamp<std::size_t>(contour.points.size() / kLeastPoints, 1, thread_limit()));
  std::vector<std::vector<PageId>> lost(thread_pages.size());
  parallel_for(thread_pages.size(), 1, [&](std::size_t n) {
    NormalsOfPart<Sample> normals(*thread_pages[n], contour, result.normals);
    Progress& reported = n == 0 ? progress : SilentProgress::instance();
    normals.find(n, thread_pages.size(), reported);
    lost[n] = normals.lost();
  });
  for (const std::vector<PageId>& pages_of_thread : lost) {
    for (const PageId& page : pages_of_thread) {
      if (std::find(result.lost.begin(), result.lost.end(), page) == result.lost.end())
        result.lost.push_back(page);
    }
  }
  return result;
}

template <class Sample>
class PointNormals<Sample>::Gradients : public VertexGradients<Sample> {
  using VertexGradients<Sample>::VertexGradients;
};

template <class Sample>
PointNormals<Sample>::PointNormals(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent)
    : gradients_(std::make_unique<Gradients>(pages, lent)) {}
template <class Sample>
PointNormals<Sample>::~PointNormals() = default;
template <class Sample>
PointNormals<Sample>::PointNormals(PointNormals&&) noexcept = default;

template <class Sample>
void PointNormals<Sample>::set_pages(StoredPages<OrderedWord<Sample>>& pages, StoredGradients* lent) {
  gradients_->set_pages(pages, lent);
}

template <class Sample>
Vec3 PointNormals<Sample>::normal(const EdgePoint& point) {
  return normal_of<Sample>(point, *gradients_);
}
template <class Sample>
std::array<Vec3, 2> PointNormals<Sample>::at_ends(const EdgePoint& point) {
  return {gradients_->at(point.first, point.step()), gradients_->at(point.second, point.step())};
}
template <class Sample>
Vec3 PointNormals<Sample>::normal(const MeanPoint& point) {
  return normal_of<Sample>(point, *gradients_);
}

template <class Sample>
std::vector<MissingNormals> PointNormals<Sample>::take_missing() {
  return gradients_->take_missing();
}
template <class Sample>
StoredGradients* PointNormals<Sample>::stored() {
  return gradients_->stored();
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(PointNormals);

ADAMAS_INSTANTIATE_FUNCTION_FOR_SAMPLES(surface_normals);

}  // namespace adamas::isosurface
