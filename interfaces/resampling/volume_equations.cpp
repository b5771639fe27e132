#include "interfaces/resampling/volume_equations.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace adamas::interfaces {

namespace {

/// A step fails for a body if more than this part is left of what it is to gain. Then the body's damping
/// rises by kMoreDamping, and at least to 1; else it falls by as much, and below kLeastDamping to 0. After
/// kMostFailures in a row the body is given up.
constexpr double kFailingPart = 0.7, kMoreDamping = 4, kLeastDamping = 0.1;
constexpr int kMostFailures = 3;

/// The bodies that hang together by exchanges.
class Components {
 public:
  Components(std::size_t bodies, const std::vector<Exchange>& exchanges) : parents_(bodies) {
    std::iota(parents_.begin(), parents_.end(), 0u);
    for (const auto& [pair, by] : exchanges) parents_[root(pair[0])] = root(pair[1]);
  }
  std::uint32_t root(BodyId b) {
    std::uint32_t r = b.value;
    while (parents_[r] != r) r = parents_[r] = parents_[parents_[r]];
    return r;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace

bool UnknownVolume::is_given_up() const { return failures >= kMostFailures; }

void UnknownVolume::give_up() { failures = kMostFailures; }

void UnknownVolume::judge(double now, double small) {
  // A damped step is to bring the body nearer by this part.
  const double part = 1 / (1 + damping);
  if (std::abs(now) > std::max(small, (1 - (1 - kFailingPart) * part) * std::abs(missing))) {
    ++failures;
    damping = std::max(1.0, kMoreDamping * damping);
  } else {
    failures = 0;
    damping = damping < kLeastDamping * kMoreDamping ? 0 : damping / kMoreDamping;
  }
}

IdVector<BodyId, BodyId> largest_bodies(const std::vector<Exchange>& exchanges,
                                        const UnknownVolumes& unknowns,
                                        const IdVector<BodyId, double>& wanted) {
  Components components(unknowns.size(), exchanges);
  IdVector<BodyId, BodyId> largest(unknowns.size()), result(unknowns.size());
  const auto is_larger = [&](BodyId b, BodyId than) {
    if (!than.valid() || unknowns[b].is_given_up() != unknowns[than].is_given_up())
      return !than.valid() || unknowns[than].is_given_up();
    return wanted[b] > wanted[than];
  };
  for (BodyId b(0); b.value < unknowns.size(); ++b.value) {
    BodyId& other = largest[BodyId(components.root(b))];
    if (is_larger(b, other)) other = b;
  }
  for (BodyId b(0); b.value < unknowns.size(); ++b.value) result[b] = largest[BodyId(components.root(b))];
  return result;
}

IdVector<BodyId, double> offsets(const std::vector<Exchange>& exchanges, const UnknownVolumes& unknowns,
                                 const IdVector<BodyId, double>& wanted) {
  const std::size_t bodies = unknowns.size();
  IdVector<BodyId, double> result(bodies, 0.0), diagonal(bodies, 0.0);
  for (const auto& [pair, by] : exchanges) {
    for (const BodyId b : pair) diagonal[b] += by;
  }
  const IdVector<BodyId, BodyId> largest = largest_bodies(exchanges, unknowns, wanted);
  // The numbers of bodies in the equations; none for the largest ones, and for those that touch no other.
  IdVector<BodyId, int> number(bodies, -1);
  int count = 0;
  for (BodyId b(0); b.value < bodies; ++b.value) {
    if (diagonal[b] > 0 && largest[b] != b) number[b] = count++;
  }
  if (count == 0) return result;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(count);
  for (BodyId b(0); b.value < bodies; ++b.value) {
    if (number[b] < 0) continue;
    const UnknownVolume& unknown = unknowns[b];
    right[number[b]] = unknown.is_given_up() ? 0 : unknown.missing;
    entries.emplace_back(number[b], number[b],
                         diagonal[b] * (unknown.is_given_up() ? 1 : 1 + unknown.damping));
  }
  for (const auto& [pair, by] : exchanges) {
    const int a = number[pair[0]], b = number[pair[1]];
    if (a < 0 || b < 0) continue;
    entries.emplace_back(a, b, -by);
    entries.emplace_back(b, a, -by);
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd raised = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  for (BodyId b(0); b.value < bodies; ++b.value) {
    if (number[b] >= 0 && std::isfinite(raised[number[b]])) result[b] = raised[number[b]];
  }
  return result;
}

}  // namespace adamas::interfaces
