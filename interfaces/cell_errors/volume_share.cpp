#include "interfaces/cell_errors/volume_share.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adamas::interfaces {

namespace {

/// A triangle's part in a cell.
struct Part {
  double area = 0;
  Weights middle{};  ///< the centroid of the part
};

Part part_in(const Tetrahedron& cell, const std::array<Vec3, 3>& corners) {
  const ClippedTriangle clipped(cell, corners[0], corners[1], corners[2]);
  Part part;
  if (clipped.end() - clipped.begin() < 3) return part;
  const Weights& origin = *clipped.begin();
  const Vec3 x = cell.point(origin);
  for (const Weights* w = clipped.begin() + 2; w != clipped.end(); ++w) {
    const double area = 0.5 * norm(cross(cell.point(w[-1]) - x, cell.point(w[0]) - x));
    for (std::size_t v = 0; v < 4; ++v) part.middle[v] += area / 3 * (origin[v] + w[-1][v] + w[0][v]);
    part.area += area;
  }
  for (double& w : part.middle) w /= part.area;
  return part;
}

class ShareEstimator {
 public:
  ShareEstimator(const InterfaceNetwork& network, const Tetrahedron& cell, CellOwnership& ownership)
      : network_(network), cell_(cell), ownership_(ownership), diameter_(cell.diameter()) {}

  void add_triangle(std::uint32_t triangle) {
    const Part part = part_in(cell_, network_.triangle_corners(triangle));
    if (!(part.area > 0)) return;
    const InterfaceId id = network_.interface_of(triangle);
    const double slope = slope_of(id);
    for (const BodyId body : network_.table().sides(id)) {
      VolumeShare& share = share_of(body);
      share.area += part.area;
      share.gained += part.area * moved(body, part.middle, slope);
    }
  }

  /// Limits the estimates to the cell's volume and adds the bodies without a boundary here in the input.
  std::vector<VolumeShare> finish() {
    for (VolumeShare& share : shares_) share.gained = std::clamp(share.gained, -cell_.volume, cell_.volume);
    const bool uncut = shares_.empty();
    if (!(uncut && ownership_.pure())) add_owned();
    if (uncut && !shares_.empty()) {
      // The input has one body here; it is assumed to be the one that owns the most.
      VolumeShare& whole = *std::ranges::max_element(shares_, {}, &VolumeShare::gained);
      whole.gained -= cell_.volume;
    }
    std::ranges::sort(shares_, {}, &VolumeShare::body);
    return std::move(shares_);
  }

 private:
  VolumeShare& share_of(BodyId body) {
    const auto found = std::ranges::find(shares_, body, &VolumeShare::body);
    if (found != shares_.end()) return *found;
    shares_.push_back({body});
    return shares_.back();
  }

  /// Returns the slope of the difference of two bodies' functions, per unit of length; 0 if the cell does not
  /// know their interface.
  [[nodiscard]] double slope_of(InterfaceId id) const {
    const CellOwnership::Interface* known = ownership_.find(id);
    if (known == nullptr) return 0;
    const auto& first = ownership_.problem.functions[known->towards_first].values;
    const auto& second = ownership_.problem.functions[known->towards_second].values;
    std::array<double, 4> difference{};
    for (std::size_t v = 0; v < 4; ++v) difference[v] = first[v] - second[v];
    return norm(cell_.gradient(difference));
  }

  /// Returns the distance by which the cell moves a body's boundary outwards at a point, computed from the
  /// body's value there minus the greatest of the others.
  [[nodiscard]] double moved(BodyId body, const Weights& at, double slope) const {
    const auto& problem = ownership_.problem;
    const std::size_t own = ownership_.candidate(body);
    if (own == problem.candidates.size()) return -diameter_;
    if (ownership_.pure()) return diameter_;
    double others = -std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
      if (c != own) others = std::max(others, problem.value(problem.candidates[c], at));
    }
    const double above = problem.value(problem.candidates[own], at) - others;
    if (above == 0) return 0;
    return std::abs(above) < slope * diameter_ ? above / slope : std::copysign(diameter_, above);
  }

  void add_owned() {
    const std::size_t bounded = shares_.size();
    std::vector<OwnedTetrahedron> parts;
    partition_cell(ownership_, parts);
    for (const OwnedTetrahedron& part : parts) {
      const std::size_t place = static_cast<std::size_t>(
          std::ranges::find(shares_, BodyId(part.owner), &VolumeShare::body) - shares_.begin());
      if (place < bounded) continue;
      share_of(BodyId(part.owner)).gained += cell_.volume * volume_fraction(part.corners);
    }
  }

  const InterfaceNetwork& network_;
  const Tetrahedron& cell_;
  CellOwnership& ownership_;
  double diameter_;
  std::vector<VolumeShare> shares_;
};

}  // namespace

std::vector<VolumeShare> estimate_volume_shares(const InterfaceNetwork& network, const Tetrahedron& cell,
                                                CellOwnership& ownership,
                                                std::span<const std::uint32_t> triangles) {
  ShareEstimator estimator(network, cell, ownership);
  for (const std::uint32_t t : triangles) estimator.add_triangle(t);
  return estimator.finish();
}

}  // namespace adamas::interfaces
