#include "datasets/cell_fractions.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace adamas::datasets {

namespace {

constexpr double kTetrahedron = 1.0 / 6;

Box3 octant(const Box3& box, unsigned o) {
  const Vec3 middle = box.center();
  Box3 part;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = ((o >> axis) & 1u) != 0;
    part.min[axis] = upper ? middle[axis] : box.min[axis];
    part.max[axis] = upper ? box.max[axis] : middle[axis];
  }
  return part;
}

}  // namespace

double positive_fraction(const std::array<double, 4>& values) {
  std::array<double, 4> v = values;
  std::sort(v.begin(), v.end(), std::greater<>());
  const auto [a, b, c, d] = v;
  if (!(a > 0)) return 0;
  if (d > 0) return 1;
  if (!(b > 0)) return a / (a - b) * (a / (a - c)) * (a / (a - d));
  if (c > 0) return 1 - d / (d - a) * (d / (d - b)) * (d / (d - c));
  // The part is a wedge between the edge of the two positive vertices and the cut; it is divided into three
  // tetrahedra.
  const double ac = a / (a - c), ad = a / (a - d), bc = b / (b - c), bd = b / (b - d);
  return ac * ad + bc * bd * (1 - ac) + ac * bd * (1 - ad);
}

CellFractions::CellFractions(const Scene& scene, int depth)
    : depth_(depth),
      levels_(static_cast<std::size_t>(depth) + 1, LocalScene(scene)),
      fine_(scene.materials().size()),
      coarse_(scene.materials().size()),
      errors_(scene.materials().size()) {
  ADAMAS_ASSERT(depth >= 1);
}

const std::vector<double>& CellFractions::integrate(const LocalScene& parent, const Box3& box) {
  std::fill(fine_.begin(), fine_.end(), 0.0);
  std::fill(coarse_.begin(), coarse_.end(), 0.0);
  visit(parent, box, 0, 1, true);
  combine();
  return fine_;
}

void CellFractions::visit(const LocalScene& parent, const Box3& box, int level, double weight,
                          bool on_coarse) {
  LocalScene& local = levels_[static_cast<std::size_t>(level)];
  local.restrict_to(parent, box);
  if (const auto owner = local.sole_owner()) {
    fine_[owner->value] += weight;
    if (on_coarse) coarse_[owner->value] += weight;
    return;
  }
  if (local.linear()) {
    std::vector<double> sums(fine_.size());
    cut(local, box, weight, sums);
    for (std::size_t m = 0; m < sums.size(); ++m) {
      fine_[m] += sums[m];
      if (on_coarse) coarse_[m] += sums[m];
    }
    return;
  }
  if (level == depth_) return cut(local, box, weight, fine_);
  const bool last = level + 1 == depth_;
  if (last) cut(local, box, weight, coarse_);
  for (unsigned o = 0; o < 8; ++o) visit(local, octant(box, o), level + 1, weight / 8, !last);
}

void CellFractions::cut(const LocalScene& local, const Box3& box, double weight, std::vector<double>& sums) {
  cube_.sample(local, box.corners());
  const auto candidates = local.candidates();
  if (candidates.size() == 2 && local.functions().size() == 2) return cut_pair(local, weight, sums);
  for (std::size_t t = 0; t < kCubeTetrahedra.size(); ++t) {
    cube_.problem(local, t, problem_);
    parts_.clear();
    partition_tetrahedron(problem_, parts_);
    for (const OwnedTetrahedron& part : parts_) {
      sums[part.owner] += weight * kTetrahedron * volume_fraction(part.corners);
    }
  }
}

void CellFractions::cut_pair(const LocalScene& local, double weight, std::vector<double>& sums) const {
  const SceneCandidate &a = local.candidates()[0], &b = local.candidates()[1];
  double above = 0;
  for (const auto& corners : kCubeTetrahedra) {
    std::array<double, 4> difference;
    for (std::size_t i = 0; i < 4; ++i) {
      difference[i] = cube_.value(a.functions[0], corners[i]) - cube_.value(b.functions[0], corners[i]);
    }
    above += kTetrahedron * positive_fraction(difference);
  }
  sums[a.owner.value] += weight * above;
  sums[b.owner.value] += weight * (1 - above);
}

void CellFractions::combine() {
  bool inside = true;
  for (std::size_t m = 0; m < fine_.size(); ++m) {
    errors_[m] = std::abs(fine_[m] - coarse_[m]);
    // The error of linear interpolation falls by a factor of four from depth to depth.
    coarse_[m] = fine_[m] + (fine_[m] - coarse_[m]) / 3;
    inside = inside && coarse_[m] >= 0 && coarse_[m] <= 1;
  }
  if (inside) std::swap(fine_, coarse_);
}

}  // namespace adamas::datasets
