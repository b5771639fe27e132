#include "interfaces/resampling/volume_equations.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/disjoint_sets.h"

namespace adamas::interfaces {

namespace {

/// A step fails for a body if more than this part is left of what it is to gain. Then the body's damping
/// rises by kMoreDamping, and at least to 1; else it falls by as much, and below kLeastDamping to 0. After
/// kMostFailures in a row the body is given up.
constexpr double kFailingPart = 0.7, kMoreDamping = 4, kLeastDamping = 0.1;
constexpr int kMostFailures = 3;
/// Failures count only if the body's functions were raised by more than this part of what interfaces can be
/// moved: a body that needs less suffers from the steps of others.
constexpr double kFarPart = 0.1;
/// A step is idle if it has left more than this part of what the bodies lack that are solved for.
constexpr double kIdlePart = 0.7;
/// A volume that is at most this part of the greatest one that was missing before a step has not failed: the
/// steps of other bodies change it, too.
constexpr double kSmallPart = 0.1;
/// Sums of missing volumes that differ by this part are equal.
constexpr double kRoundOff = 1e-9;
/// The greatest number of times that a step is computed anew because interfaces would be moved too far.
constexpr int kMostStops = 4;
/// A step leads past a body's volume if it leaves more than this part of what was missing, with the other
/// sign.
constexpr double kPassingPart = 0.5;
/// Bodies are led back by this part of the last step at least.
constexpr double kLeastLed = 0.1;

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
  DisjointSets components(unknowns.size());
  for (const auto& [pair, by] : exchanges) components.join(pair[0].value, pair[1].value);
  IdVector<BodyId, BodyId> largest(unknowns.size()), result(unknowns.size());
  const auto is_larger = [&](BodyId b, BodyId than) {
    if (!than.valid() || unknowns[b].is_given_up() != unknowns[than].is_given_up())
      return !than.valid() || unknowns[than].is_given_up();
    return wanted[b] > wanted[than];
  };
  for (BodyId b(0); b.value < unknowns.size(); ++b.value) {
    BodyId& other = largest[BodyId(components.find(b.value))];
    if (is_larger(b, other)) other = b;
  }
  for (BodyId b(0); b.value < unknowns.size(); ++b.value)
    result[b] = largest[BodyId(components.find(b.value))];
  return result;
}

IdVector<BodyId, double> filling_volumes(const ResamplingSource& source) {
  IdVector<BodyId, double> volumes = source.body_volumes;
  const double scale = source.box.volume() / std::accumulate(volumes.begin(), volumes.end(), 0.0);
  for (double& volume : volumes) volume *= scale;
  return volumes;
}

namespace {

using Moves = VolumeEquations::Moves;

/// Returns the offsets with which bodies gain their missing volumes, to first order. Those that are given up
/// keep the volumes that they have. Of bodies that exchange volume with each other, directly or not, the
/// largest one has no offset: it gets what the others leave.
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

/// Returns the moves after a step that raises the functions of bodies: each interface moves by half of the
/// difference, within its bounds.
Moves raised_moves(const VolumeEquations& equations, Moves moves, const IdVector<BodyId, double>& raised) {
  for (InterfaceId i(0); i.value < moves.size(); ++i.value) {
    const auto& [a, b] = equations.table.sides(i);
    const auto [least, greatest] = equations.range(i);
    moves[i] = std::clamp(moves[i] + 0.5 * (raised[a] - raised[b]), least, greatest);
  }
  return moves;
}

/// Returns whether the interface of two bodies is as far as it may be moved, and would be moved farther.
bool is_stopped(const VolumeEquations& equations, const Moves& moves, const Exchange& exchange,
                const IdVector<BodyId, double>& raised) {
  const auto& [a, b] = exchange.first;
  const auto interface = equations.table.find(a, b);
  if (!interface) return false;
  const auto [least, greatest] = equations.range(*interface);
  const double by = raised[a] - raised[b];
  return by > 0 ? moves[*interface] >= greatest : by < 0 && moves[*interface] <= least;
}

/// Returns the offsets of a step. What cannot be moved any farther exchanges nothing.
IdVector<BodyId, double> step(const VolumeEquations& equations, const Moves& moves,
                              std::vector<Exchange> exchanges, const UnknownVolumes& unknowns) {
  for (int stops = 0;; ++stops) {
    IdVector<BodyId, double> raised = offsets(exchanges, unknowns, equations.wanted);
    const auto stopped = std::erase_if(
        exchanges, [&](const Exchange& each) { return is_stopped(equations, moves, each, raised); });
    if (stopped == 0 || stops == kMostStops) return raised;
  }
}

/// Returns what bodies lack; an heir lacks, besides, what those lack whose heir it is.
IdVector<BodyId, double> missing_volumes(const IdVector<BodyId, double>& wanted,
                                         const IdVector<BodyId, double>& volumes,
                                         const UnknownVolumes& unknowns) {
  IdVector<BodyId, double> result = wanted;
  for (BodyId b(0); b.value < result.size(); ++b.value) result[b] -= volumes[b];
  for (BodyId b(0); b.value < result.size(); ++b.value) {
    if (!unknowns[b].heir.valid()) continue;
    result[unknowns[b].heir] += result[b];
  }
  return result;
}

/// Bodies whose steps have led past their volumes: their response is far from linear, so they are led back
/// between the last moves with too much and the last ones with too little.
class Brackets {
 public:
  explicit Brackets(const VolumeEquations& equations)
      : table_(equations.table),
        other_(equations.table.interface_count(), 0.0),
        missing_(equations.wanted.size(), 0.0),
        has_passed_(equations.wanted.size(), 0) {}

  [[nodiscard]] bool has(BodyId b) const { return missing_[b] != 0; }
  [[nodiscard]] bool has_side(const Exchange& exchange) const {
    return has(exchange.first[0]) || has(exchange.first[1]);
  }
  /// Notes what a body lacks after a step and lacked before it.
  void note(BodyId b, double now, double before) {
    const bool passed = (now > 0) != (before > 0);
    if (!has(b) && !(passed && std::abs(now) > kPassingPart * std::abs(before))) return;
    if (has(b) && std::abs(now) <= kPassingPart * kPassingPart * std::abs(before)) {
      missing_[b] = 0;
    } else if (passed) {
      missing_[b] = before;
      has_passed_[b] = 1;
    } else {
      // The other end of the bracket counts as nearer, so that it moves at last.
      missing_[b] *= 0.5;
    }
  }
  /// Keeps the moves before the step for the bodies that it led past their volumes.
  void keep(const Moves& before) {
    for (InterfaceId i(0); i.value < other_.size(); ++i.value) {
      for (const BodyId b : table_.sides(i)) {
        if (has_passed_[b] != 0) other_[i] = before[i];
      }
    }
    has_passed_.assign(has_passed_.size(), 0);
  }
  /// Leads the interfaces of these bodies back.
  void lead(const UnknownVolumes& known, const Moves& now, Moves& next) const {
    for (InterfaceId i(0); i.value < next.size(); ++i.value) {
      double part = 0, count = 0;
      for (const BodyId b : table_.sides(i)) {
        if (!has(b)) continue;
        part += std::clamp(known[b].missing / (known[b].missing - missing_[b]), kLeastLed, 1 - kLeastLed);
        ++count;
      }
      if (count > 0) next[i] = now[i] + part / count * (other_[i] - now[i]);
    }
  }

 private:
  const InterfaceTable& table_;
  Moves other_;                        ///< the moves of interfaces at the other ends of brackets
  IdVector<BodyId, double> missing_;   ///< what bodies lack there; 0 for those without a bracket
  IdVector<BodyId, char> has_passed_;  ///< by the last step
};

/// Newton's method for volumes, with what it knows so far.
class VolumeSolver {
 public:
  VolumeSolver(const VolumeEquations& equations, const Moves& moves, const UnknownVolumes& unknowns)
      : equations_(equations),
        now_(moves),
        before_(moves),
        known_(unknowns),
        raised_(unknowns.size(), 0.0),
        brackets_(equations) {
    for (InterfaceId i(0); i.value < moves.size(); ++i.value) {
      const auto [least, greatest] = equations.range(i);
      widest_ = std::max(widest_, greatest - least);
    }
  }

  /// Takes steps until volumes agree or get no better. The best moves go to `best`, and what is known of the
  /// bodies after them to `best_known`.
  void solve(Moves& best, UnknownVolumes& best_known) {
    double least = std::numeric_limits<double>::infinity(), last_open = least;
    int idle = 0;
    for (int steps = 0;; ++steps) {
      ExchangedVolumes measured = equations_.measure(now_);
      if (steps == 0) rest_ = largest_bodies(measured.exchanges, known_, equations_.wanted);
      judge(missing_volumes(equations_.wanted, measured.volumes, known_));
      // What one body leaves to another one does not change the sum.
      const double sum = missing();
      if (sum <= (1 + kRoundOff) * least) best = now_, best_known = known_;
      least = std::min(least, sum);
      if (steps == equations_.most_steps) return;
      std::erase_if(measured.exchanges, [&](const Exchange& each) { return brackets_.has_side(each); });
      raised_ = step(equations_, now_, std::move(measured.exchanges), known_);
      const double open = open_volume();
      idle = open < kIdlePart * last_open ? 0 : idle + 1;
      last_open = open;
      // Then all bodies have their volumes but those that cannot have theirs.
      if (open == 0) best = now_, best_known = known_;
      if (open == 0 || idle == equations_.most_idle_steps) return;
      before_ = now_;
      now_ = raised_moves(equations_, std::move(now_), raised_);
      brackets_.lead(known_, before_, now_);
    }
  }

 private:
  /// Returns whether a body lacks a volume for which steps are taken.
  [[nodiscard]] bool is_open(BodyId b) const {
    return (raised_[b] != 0 || brackets_.has(b)) && std::abs(known_[b].missing) > equations_.enough &&
           !known_[b].is_given_up();
  }
  [[nodiscard]] double open_volume() const {
    double sum = 0;
    for (BodyId b(0); b.value < known_.size(); ++b.value) sum += is_open(b) ? std::abs(known_[b].missing) : 0;
    return sum;
  }
  /// Returns the sum of what bodies lack but those that get what the others leave.
  [[nodiscard]] double missing() const {
    double sum = 0;
    for (BodyId b(0); b.value < known_.size(); ++b.value)
      sum += rest_[b] == b ? 0 : std::abs(known_[b].missing);
    return sum;
  }
  /// Judges the last step by what bodies lack now.
  void judge(const IdVector<BodyId, double>& missing) {
    double greatest = 0;
    for (BodyId b(0); b.value < known_.size(); ++b.value)
      greatest = std::max(greatest, is_open(b) ? std::abs(known_[b].missing) : 0);
    for (BodyId b(0); b.value < known_.size(); ++b.value) {
      if (is_open(b)) {
        if (!brackets_.has(b) && std::abs(raised_[b]) > kFarPart * widest_)
          known_[b].judge(missing[b], kSmallPart * greatest);
        brackets_.note(b, missing[b], known_[b].missing);
      }
      known_[b].missing = missing[b];
    }
    brackets_.keep(before_);
  }

  const VolumeEquations& equations_;
  Moves now_, before_;  ///< before the last step
  UnknownVolumes known_;
  IdVector<BodyId, double> raised_;  ///< the offsets of the last step
  IdVector<BodyId, BodyId> rest_;    ///< by body, that which gets what is left, in the beginning
  Brackets brackets_;
  double widest_ = 0;  ///< how far interfaces can be moved from one end to the other
};

}  // namespace

void solve_equations(const VolumeEquations& equations, Moves& moves, UnknownVolumes& unknowns) {
  VolumeSolver(equations, moves, unknowns).solve(moves, unknowns);
}

}  // namespace adamas::interfaces
