#include "interfaces/cell_errors/interface_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "core/base/hash.h"
#include "core/base/sort_unique.h"
#include "core/geometry/divider.h"

namespace adamas::interfaces {

namespace {

/// A cell that may show more bodies than this is split before its partition is computed; its interfaces count
/// as lost.
constexpr std::size_t kCrowd = 16;
/// The number of triangles that are tried before the cell's own interfaces are computed.
constexpr std::size_t kFewTriangles = 8;
/// Owners are compared at this many steps along an edge, and between two different ones by halving.
constexpr int kEdgeSteps = 4, kHalvings = 8;
/// If there are at least this many triangles, only some of them are used at first.
constexpr std::size_t kManyTriangles = 256;
/// The distance of interfaces that the cell does not know.
constexpr double kFar = std::numeric_limits<double>::max();

class Estimator {
 public:
  /// `bodies`: the ownership problem without functions that do not matter. `owners`: one from which bodies
  /// that own no part of the cell may be missing too.
  Estimator(const InterfaceNetwork& network, const Tetrahedron& cell, const CellOwnership& ownership,
            const OwnershipProblem& bodies, const OwnershipProblem& owners)
      : network_(network),
        cell_(cell),
        ownership_(ownership),
        diameter_(cell.diameter()),
        bodies_(bodies),
        owners_(owners) {}

  /// Finds the interfaces that the cell shows, for the functions below that need them.
  void find_contacts() { contact_polygons(owners_, contacts_); }
  [[nodiscard]] std::vector<ContactPolygon> take_contacts() { return std::move(contacts_); }

  /// Returns whether one of a few triangles is farther than `target` from the cell's interfaces.
  [[nodiscard]] bool has_far_triangle(std::span<const std::uint32_t> triangles, double target) const {
    const std::size_t stride = (triangles.size() + kFewTriangles - 1) / kFewTriangles;
    for (std::size_t i = stride / 2; i < triangles.size(); i += stride) {
      if (std::min(diameter_, distance_of_triangle(triangles[i])) > target) return true;
    }
    return false;
  }

  /// Returns whether an interface that the cell shows on one of its edges is surely farther than `target`
  /// from the input's. This needs no contact polygons.
  [[nodiscard]] bool shows_far_on_edges(double target) const {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (shows_far_on_edge(i, j, target)) return true;
      }
    }
    return false;
  }

  /// Returns the greatest distance of the triangles' parts in the cell from the cell's interfaces, at most
  /// the diameter; only one triangle in `stride` is used. A result above `enough` may be less than the
  /// greatest.
  [[nodiscard]] double distance_of_triangles(std::span<const std::uint32_t> triangles, std::size_t stride,
                                             double enough) const {
    double greatest = 0;
    for (const std::uint32_t t : triangles) {
      if (stride > 1 && digest(t) % stride != 0) continue;
      greatest = std::max(greatest, std::min(diameter_, distance_of_triangle(t)));
      if (greatest >= diameter_ || greatest > enough) break;
    }
    return greatest;
  }

  /// Returns the greatest distance of the parts of triangles whose interface the cell does not show; a result
  /// above `enough` may be less than the greatest.
  [[nodiscard]] double distance_of_hidden(std::span<const std::uint32_t> triangles, double enough) const {
    double greatest = 0;
    InterfaceId last;
    bool hidden = false;
    for (const std::uint32_t t : triangles) {
      const InterfaceId id = network_.interface_of(t);
      if (id != last) hidden = !shows(id), last = id;
      if (hidden) greatest = std::max(greatest, distance_of_triangle(t));
      if (greatest > enough) break;
    }
    return greatest;
  }

  /// Returns the greatest distance of the cell's interfaces from the input's; interfaces between bodies that
  /// do not touch in the input are measured from all of its interfaces. A result above `enough` may be less
  /// than the greatest.
  [[nodiscard]] double distance_of_contacts(double enough) const {
    double greatest = 0;
    for (const ContactPolygon& contact : contacts_) {
      const ClosestPointTree& tree = tree_between(contact.front, contact.back);
      std::uint32_t last = ClosestPointTree::kNoTriangle;
      for (const auto& corner : contact.corners) {
        const auto closest = tree.closest_from(cell_.point(corner.weights), last);
        if (!closest) return diameter_;
        greatest = std::max(greatest, std::sqrt(closest->squared_distance));
        last = closest->triangle;
      }
      if (greatest > enough) break;
    }
    return std::min(greatest, diameter_);
  }

  [[nodiscard]] bool shows(InterfaceId id) const {
    const auto& [a, b] = network_.table().sides(id);
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [&, first = a, second = b](const ContactPolygon& c) {
                         return (c.front == first.value && c.back == second.value) ||
                                (c.front == second.value && c.back == first.value);
                       });
  }

 private:
  [[nodiscard]] const ClosestPointTree& tree_between(std::uint32_t front, std::uint32_t back) const {
    const auto id = network_.table().find(BodyId(front), BodyId(back));
    return id ? network_.tree(*id) : network_.tree();
  }

  /// Returns whether two successive owners of points of an edge meet surely farther than `target` from the
  /// input's interface between them.
  [[nodiscard]] bool shows_far_on_edge(std::size_t i, std::size_t j, double target) const {
    const auto at = [&](double t) {
      Weights w{};
      w[i] = 1 - t, w[j] = t;
      return w;
    };
    std::uint32_t last = owners_.owner(at(0));
    for (int step = 1; step <= kEdgeSteps; ++step) {
      double low = static_cast<double>(step - 1) / kEdgeSteps, high = static_cast<double>(step) / kEdgeSteps;
      const std::uint32_t next = owners_.owner(at(high));
      const std::uint32_t before = std::exchange(last, next);
      if (before == next) continue;
      std::uint32_t below = before, above = next;
      for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (low + high);
        const std::uint32_t owner = owners_.owner(at(middle));
        (owner == below ? low : high) = middle;
        if (owner != below) above = owner;
      }
      const double reach = target + (high - low) * diameter_;
      if (!tree_between(below, above).is_within(cell_.point(at(low)), reach)) return true;
    }
    return false;
  }

  /// Returns a number of a triangle that does not depend on the order of triangles and their corners.
  [[nodiscard]] std::uint64_t digest(std::uint32_t triangle) const {
    std::uint64_t bits = 0;
    for (const Vec3& p : network_.triangle_corners(triangle)) {
      std::uint64_t corner = 0;
      for (const double x : {p.x, p.y, p.z}) corner = hash_combine(corner, std::bit_cast<std::uint64_t>(x));
      bits ^= corner;
    }
    return bits >> 32;
  }

  /// Returns the greatest value of a candidate at a point, at least `least`.
  [[nodiscard]] double greatest_value(const Weights& w, double least) const {
    double greatest = least;
    for (const auto& candidate : owners_.candidates) {
      double value = std::numeric_limits<double>::infinity();
      for (std::uint32_t f = 0; f < candidate.count && value > greatest; ++f)
        value = std::min(value, evaluate(owners_.functions[candidate.first + f].values, w));
      greatest = std::max(greatest, value);
    }
    return greatest;
  }

  [[nodiscard]] double distance_of_triangle(std::uint32_t triangle) const {
    const InterfaceId id = network_.interface_of(triangle);
    const CellOwnership::Interface* known = ownership_.find(id);
    if (known == nullptr) return kFar;
    const auto& [a, b] = network_.table().sides(id);
    const auto& first = bodies_.candidates[ownership_.candidate(a)];
    const auto& second = bodies_.candidates[ownership_.candidate(b)];
    const auto& towards_first = ownership_.problem.functions[known->towards_first].values;
    const auto& towards_second = ownership_.problem.functions[known->towards_second].values;
    std::array<double, 4> phi{};
    for (std::size_t v = 0; v < 4; ++v) phi[v] = 0.5 * (towards_first[v] - towards_second[v]);
    const double slope = norm(cell_.gradient(phi));
    const auto& corners = network_.triangle_corners(triangle);
    double greatest = 0;
    for (const Weights& w : ClippedTriangle(cell_, corners[0], corners[1], corners[2])) {
      const double own = std::min(bodies_.value(first, w), bodies_.value(second, w));
      const double gap = greatest_value(w, own) - own;
      greatest = std::max(greatest, gap <= 0                      ? 0
                                    : gap < 2 * slope * diameter_ ? gap / (2 * slope)
                                                                  : diameter_);
    }
    return greatest;
  }

  const InterfaceNetwork& network_;
  const Tetrahedron& cell_;
  const CellOwnership& ownership_;
  double diameter_;
  const OwnershipProblem &bodies_, &owners_;
  std::vector<ContactPolygon> contacts_;
};

}  // namespace

std::vector<InterfaceId> interfaces_of(const InterfaceNetwork& network,
                                       std::span<const std::uint32_t> triangles) {
  std::vector<InterfaceId> interfaces;
  for (const std::uint32_t t : triangles) {
    const InterfaceId id = network.interface_of(t);
    if (interfaces.empty() || interfaces.back() != id) interfaces.push_back(id);
  }
  sort_unique(interfaces);
  return interfaces;
}

bool holds_crowd(const InterfaceNetwork& network, std::span<const std::uint32_t> triangles) {
  std::array<BodyId, kCrowd> bodies;
  std::size_t count = 0;
  InterfaceId last;
  for (const std::uint32_t t : triangles) {
    const InterfaceId id = network.interface_of(t);
    if (id == last) continue;
    last = id;
    for (const BodyId b : network.table().sides(id)) {
      const auto end = bodies.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(bodies.begin(), end, b) != end) continue;
      if (count == kCrowd) return true;
      bodies[count++] = b;
    }
  }
  return false;
}

InterfaceError estimate_interface_error(const InterfaceNetwork& network, const Tetrahedron& cell,
                                        const CellOwnership& ownership,
                                        std::span<const std::uint32_t> triangles,
                                        const InterfaceErrorOptions& options, ShownContacts* shown) {
  const double diameter = cell.diameter(), target = options.target;
  if (ownership.pure()) return {triangles.empty() ? 0 : diameter, !triangles.empty()};
  const InterfaceError partial{diameter, !triangles.empty(), true};
  const bool may_be_partial = options.may_be_partial && diameter > target;
  thread_local OwnershipProblem bodies;
  bodies = ownership.problem;
  drop_high_functions(bodies);
  OwnershipProblem owners = bodies;
  drop_dominated(owners);
  if (owners.candidates.size() > kCrowd && diameter > target) return {diameter, !triangles.empty()};
  if (may_be_partial) {
    const Estimator estimator(network, cell, ownership, bodies, owners);
    if (estimator.has_far_triangle(triangles, target) || estimator.shows_far_on_edges(target)) return partial;
  }
  keep_owners(owners);
  if (triangles.empty() && owners.candidates.size() == 1) return {};
  Estimator estimator(network, cell, ownership, bodies, owners);
  InterfaceError error;
  if (may_be_partial) {
    error.distance = estimator.distance_of_triangles(triangles, 1, target);
    if (error.distance > target) return partial;
  }
  estimator.find_contacts();
  if (!may_be_partial) {
    if (triangles.size() >= kManyTriangles) {
      const std::size_t stride = triangles.size() / (kManyTriangles / 4);
      error.distance = estimator.distance_of_triangles(triangles, stride, kFar);
      if (error.distance > target) {
        error.lost = estimator.distance_of_hidden(triangles, target) > target;
        return error;
      }
    }
    error.distance = estimator.distance_of_triangles(triangles, 1, kFar);
  }
  error.distance = std::max(error.distance, estimator.distance_of_contacts(may_be_partial ? target : kFar));
  if (may_be_partial && error.distance > target) return partial;
  double hidden = estimator.distance_of_hidden(triangles, kFar);
  if (hidden > 0 && diameter > options.trusted) hidden = kFar;
  error.lost = hidden > target;
  error.distance = std::max(error.distance, hidden);
  if (shown != nullptr && error.distance <= target) *shown = {owners, estimator.take_contacts()};
  return error;
}

}  // namespace adamas::interfaces
