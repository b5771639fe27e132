#include "interfaces/resampling/conservation.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

namespace {

/// Volumes agree if they differ by at most this, relative to the domain's volume.
constexpr double kAgree = 1e-10;
/// The greatest number of steps of Newton's method. Usually four or five are enough, unless bodies are about
/// to vanish.
constexpr int kMostSteps = 20;
/// Cells are not split to conserve volumes if their estimates are below half this part of the interface
/// error.
constexpr double kFinestForVolumes = 0.1;
/// A shift that brings an interface too far away is reduced to kLessShift of it, or to 0 if it becomes less
/// than kLeastShift of the interface error.
constexpr double kLessShift = 0.25, kLeastShift = 0.01;
/// This makes the equations regular, which do not determine a common offset of all bodies.
constexpr double kDamping = 1e-12;

/// Two bodies, the lower number first, and the derivative of the volume that they exchange with respect to
/// the offset of one.
using Exchange = std::pair<std::array<BodyId, 2>, double>;

/// Returns the least of a candidate's functions at a point, which determines what the candidate owns there.
const LinearFunction& binding(const OwnershipProblem& problem, std::uint32_t owner, const Weights& at) {
  const auto candidate =
      std::find_if(problem.candidates.begin(), problem.candidates.end(),
                   [owner](const OwnershipProblem::Candidate& c) { return c.owner == owner; });
  const auto value = [&](const LinearFunction& f) {
    return f.values[0] * at[0] + f.values[1] * at[1] + f.values[2] * at[2] + f.values[3] * at[3];
  };
  const auto first = problem.functions.begin() + candidate->first;
  return *std::min_element(first, first + candidate->count,
                           [&](const auto& f, const auto& g) { return value(f) < value(g); });
}

/// Returns the derivative of the volume exchanged at a contact with respect to the difference of the two
/// bodies' functions: the area divided by the slope of that difference.
double exchanged(const Tetrahedron& cell, const OwnershipProblem& problem, const ContactPolygon& contact) {
  Vec3 area;
  Weights middle{};
  const auto& corners = contact.corners;
  const Vec3 origin = cell.point(corners[0].weights);
  for (std::size_t i = 2; i < corners.size(); ++i)
    area += 0.5 * cross(cell.point(corners[i - 1].weights) - origin, cell.point(corners[i].weights) - origin);
  for (const auto& corner : corners) {
    for (std::size_t v = 0; v < 4; ++v) middle[v] += corner.weights[v] / static_cast<double>(corners.size());
  }
  std::array<double, 4> difference{};
  const auto &front = binding(problem, contact.front, middle), &back = binding(problem, contact.back, middle);
  for (std::size_t v = 0; v < 4; ++v) difference[v] = front.values[v] - back.values[v];
  const double slope = norm(cell.gradient(difference));
  return slope > 0 ? norm(area) / slope : 0;
}

/// Returns the offsets of the bodies' functions with which they gain their missing volumes.
IdVector<BodyId, double> solve(std::size_t bodies, const std::vector<Exchange>& exchanges,
                               const IdVector<BodyId, double>& missing) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> diagonal(bodies, 0.0);
  const auto index = [](BodyId b) { return static_cast<int>(b.value); };
  for (const auto& [pair, by] : exchanges) {
    const auto& [a, b] = pair;
    entries.emplace_back(index(a), index(b), -by);
    entries.emplace_back(index(b), index(a), -by);
    diagonal[a.value] += by;
    diagonal[b.value] += by;
  }
  const double greatest = *std::max_element(diagonal.begin(), diagonal.end());
  const auto n = static_cast<Eigen::Index>(bodies);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  double sum = 0, count = 0;
  // A body that touches no other one cannot gain anything.
  const auto touches = [&](BodyId b) { return diagonal[b.value] > 0; };
  for (BodyId b(0); b.value < bodies; ++b.value) {
    if (touches(b)) sum += missing[b], ++count;
  }
  for (BodyId b(0); b.value < bodies; ++b.value) {
    // The mean of all missing volumes cannot be gained by any of them.
    if (touches(b)) right[index(b)] = missing[b] - sum / count;
    entries.emplace_back(index(b), index(b), diagonal[b.value] + kDamping * greatest);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd raised = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  IdVector<BodyId, double> result(bodies, 0.0);
  for (BodyId b(0); b.value < bodies; ++b.value)
    result[b] = std::isfinite(raised[index(b)]) ? raised[index(b)] : 0;
  return result;
}

double greatest(const IdVector<BodyId, double>& values) {
  double result = 0;
  for (const double v : values) result = std::max(result, std::abs(v));
  return result;
}

/// Returns the missing volume of each body of the mesh, with all volumes of the input scaled to fill the
/// domain.
IdVector<BodyId, double> missing_volumes(const ResamplingState& state) {
  const IdVector<BodyId, double>& wanted = state.source.body_volumes;
  IdVector<BodyId, double> missing = state.volumes();
  const double scale = state.source.box.volume() / std::accumulate(wanted.begin(), wanted.end(), 0.0);
  for (BodyId b(0); b.value < missing.size(); ++b.value) missing[b] = scale * wanted[b] - missing[b];
  return missing;
}

/// Returns the exchanges at all contacts of the leaves, summed for each pair of bodies.
std::vector<Exchange> find_exchanges(const ResamplingState& state) {
  const std::vector<TetrahedronId> all = state.leaves();
  const auto find = [&](std::size_t first, std::size_t last, std::vector<Exchange>& exchanges) {
    CellOwnership owners;
    std::vector<ContactPolygon> contacts;
    for (std::size_t i = first; i < last; ++i) {
      state.ownership(all[i], owners);
      if (owners.pure()) continue;
      keep_owners(owners.problem);
      contacts.clear();
      contact_polygons(owners.problem, contacts);
      const Tetrahedron cell = state.frame(all[i]);
      for (const ContactPolygon& contact : contacts) {
        const auto [a, b] = std::minmax(contact.front, contact.back);
        exchanges.push_back({{BodyId(a), BodyId(b)}, exchanged(cell, owners.problem, contact)});
      }
    }
  };
  auto result = parallel_collect<Exchange>(all.size(), 2048, find);
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  std::size_t count = 0;
  for (const Exchange& exchange : result) {
    if (count > 0 && result[count - 1].first == exchange.first) {
      result[count - 1].second += exchange.second;
    } else {
      result[count++] = exchange;
    }
  }
  result.resize(count);
  return result;
}

}  // namespace

Conservation::Conservation(ResamplingState& state)
    : state_(state), most_shifts_(state.shifts.size(), state.options.interface_error) {}

/// Moves each interface by half of the difference of its two bodies' offsets, within its bound.
void Conservation::shift_interfaces(const IdVector<BodyId, double>& raised) {
  const InterfaceTable& table = state_.source.network->table();
  IdVector<InterfaceId, double> by(table.interface_count(), 0.0);
  for (InterfaceId i(0); i.value < by.size(); ++i.value) {
    const auto& [a, b] = table.sides(i);
    const double moved =
        std::clamp(state_.shifts[i] + 0.5 * (raised[a] - raised[b]), -most_shifts_[i], most_shifts_[i]);
    by[i] = moved - state_.shifts[i];
    state_.shifts[i] = moved;
  }
  state_.hierarchy.for_each_vertex([&](VertexId v) {
    for (NearDistance& near : state_.hierarchy.payload(v).distances.near) near.distance += by[near.interface];
  });
  state_.forget_contacts();
}

void Conservation::conserve() {
  IdVector<BodyId, double> missing = missing_volumes(state_);
  const double enough = kAgree * state_.source.box.volume();
  for (int step = 0; step < kMostSteps && greatest(missing) > enough; ++step) {
    state_.report("conserving volumes");
    const auto raised = solve(missing.size(), find_exchanges(state_), missing);
    const double before = greatest(missing);
    double part = 1;
    shift_interfaces(raised);
    missing = missing_volumes(state_);
    // The step is halved while it goes too far.
    for (; greatest(missing) >= before && part > 1.0 / 64; part *= 0.5) {
      IdVector<BodyId, double> back = raised;
      for (double& w : back) w *= -0.5 * part;
      shift_interfaces(back);
      missing = missing_volumes(state_);
    }
    if (greatest(missing) >= before) break;
  }
  unconserved_.assign(missing.size(), 0);
  for (BodyId b(0); b.value < missing.size(); ++b.value)
    unconserved_[b] = std::abs(missing[b]) > enough ? 1 : 0;
}

std::vector<TetrahedronId> Conservation::leaves_of_unconserved_bodies() const {
  if (state_.options.volume_error) return {};
  if (std::count(unconserved_.begin(), unconserved_.end(), 1) == 0) return {};
  const InterfaceNetwork& network = *state_.source.network;
  std::vector<TetrahedronId> result = state_.leaves();
  std::erase_if(result, [&](TetrahedronId t) {
    const CellRecord& cell = state_.hierarchy.payload(t);
    return std::none_of(cell.triangles.begin(), cell.triangles.end(), [&](std::uint32_t triangle) {
      const auto& [a, b] = network.table().sides(network.interface_of(triangle));
      return unconserved_[a] != 0 || unconserved_[b] != 0;
    });
  });
  double worst = kFinestForVolumes * state_.options.interface_error;
  for (const TetrahedronId t : result)
    worst = std::max(worst, state_.hierarchy.payload(t).interface.distance);
  std::erase_if(
      result, [&](TetrahedronId t) { return state_.hierarchy.payload(t).interface.distance < 0.5 * worst; });
  return result;
}

bool Conservation::allow_smaller_shifts(const ExtractedInterfaces& shown,
                                        const InterfaceComparison& comparison) {
  if (!state_.options.conserve) return false;
  const InterfaceNetwork& network = *state_.source.network;
  IdVector<BodyId, char> too_far(network.table().body_count(), 0);
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    if (!comparison.too_far(t, 0) && !comparison.too_far(t, 1)) continue;
    for (const BodyId b : network.table().sides(network.interface_of(t))) too_far[b] = 1;
  }
  for (const std::uint32_t t : comparison.far_shown()) {
    for (const BodyId b : shown.bodies[t]) too_far[b] = 1;
  }
  bool any = false;
  for (InterfaceId i(0); i.value < state_.shifts.size(); ++i.value) {
    const auto& [a, b] = network.table().sides(i);
    if ((too_far[a] == 0 && too_far[b] == 0) || state_.shifts[i] == 0) continue;
    const double less = kLessShift * std::abs(state_.shifts[i]);
    most_shifts_[i] = less < kLeastShift * state_.options.interface_error ? 0 : less;
    any = true;
  }
  shift_interfaces(IdVector<BodyId, double>(too_far.size(), 0.0));
  return any;
}

}  // namespace adamas::interfaces
