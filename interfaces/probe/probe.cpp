#include "interfaces/probe/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas {

namespace {

constexpr std::size_t kChunk = 256;
constexpr std::size_t kMaxPoints = 100'000'000;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::size_t row_size(const std::vector<FieldInfo>& fields) {
  return fields.empty() ? 0 : fields.back().offset + static_cast<std::size_t>(fields.back().components);
}

ProbeSample outside(const Vec3& p, std::size_t values) {
  return {p, false, {}, {}, std::vector<double>(values, kNothing), kNothing};
}

/// Half of what the owner's function is ahead of the next one's: between two bodies, the distance to their
/// interface.
double distance_from_rivals(const OwnershipProblem& problem, std::uint32_t owner, const Weights& weights) {
  if (problem.candidates.size() < 2) return kNothing;
  double own = 0, rival = -std::numeric_limits<double>::infinity();
  for (const auto& candidate : problem.candidates) {
    const double value = problem.value(candidate, weights);
    if (candidate.owner == owner) {
      own = value;
    } else {
      rival = std::max(rival, value);
    }
  }
  return std::max(0.0, 0.5 * (own - rival));
}

}  // namespace

std::vector<ProbeSample> probe(const ResampledMesh& mesh, const CellLocator& locator,
                               std::span<const Vec3> points) {
  const std::size_t values = row_size(mesh.fields);
  std::vector<ProbeSample> samples(points.size());
  parallel_chunks(points.size(), kChunk, [&](std::size_t first, std::size_t last) {
    CellOwnership ownership;
    for (std::size_t i = first; i < last; ++i) {
      ProbeSample& sample = samples[i] = outside(points[i], values);
      const auto location = locator.locate(points[i]);
      if (!location) continue;
      mesh.ownership(location->cell, ownership);
      const std::uint32_t owner = ownership.pure() ? ownership.problem.candidates[0].owner
                                                   : ownership.problem.owner(location->weights);
      sample.inside = true;
      sample.body = BodyId(owner);
      sample.material = mesh.table.material(sample.body);
      sample.interface_distance = distance_from_rivals(ownership.problem, owner, location->weights);
      for (std::size_t c = 0; c < values; ++c)
        sample.values[c] = mesh.value(location->cell, sample.body, c, location->weights);
    }
  });
  return samples;
}

std::vector<ProbeSample> probe(const ResampledMesh& mesh, std::span<const Vec3> points) {
  return probe(mesh, CellLocator(mesh), points);
}

std::vector<ProbeSample> probe(const ResamplingSource& source, std::span<const Vec3> points) {
  const std::size_t values = source.fields ? source.fields->row_size() : 0;
  std::vector<ProbeSample> samples(points.size());
  parallel_for(points.size(), kChunk, [&](std::size_t i) {
    const Vec3& p = points[i];
    ProbeSample& sample = samples[i] = outside(p, values);
    if (!source.box.contains(p)) return;
    sample.inside = true;
    sample.body = source.body_at(p, nullptr);
    sample.material = source.network->table().material(sample.body);
    if (const auto closest = source.network->tree().closest(p))
      sample.interface_distance = std::sqrt(closest->squared_distance);
    if (source.fields) source.fields->values(sample.material, p, sample.values);
  });
  return samples;
}

std::vector<Vec3> line_points(const Vec3& a, const Vec3& b, std::size_t count) {
  for (const Vec3* p : {&a, &b}) {
    if (!std::isfinite(p->x) || !std::isfinite(p->y) || !std::isfinite(p->z))
      fail("line: expected finite ends, found ({}, {}, {})", p->x, p->y, p->z);
  }
  if (count < 2 || count > kMaxPoints) fail("line: expected 2 to {} points, found {}", kMaxPoints, count);
  std::vector<Vec3> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count - 1);
    points[i] = (1 - t) * a + t * b;
  }
  points.back() = b;
  return points;
}

}  // namespace adamas
