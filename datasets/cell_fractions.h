#pragma once

#include <vector>

#include "core/geometry/partition.h"
#include "datasets/local_scene.h"

namespace adamas::datasets {

/// Integrates the volumes of a scene's materials over boxes. A box is divided in eight as long as it has no
/// certain owner and its functions are not linear; at the last depth its six tetrahedra are cut along linear
/// interpolations. The result is exact for planes, to round-off; for curved surfaces the results of two
/// depths are extrapolated to a spacing of zero.
class CellFractions {
 public:
  /// `depth` >= 1 is the number of divisions.
  CellFractions(const Scene& scene, int depth);
  /// Fractions of the box by material, adding up to 1. `parent` must cover the box.
  const std::vector<double>& integrate(const LocalScene& parent, const Box3& box);
  /// For each material the difference between the last two depths in the last box: in practice a bound of the
  /// error of its fraction.
  [[nodiscard]] const std::vector<double>& errors() const { return errors_; }

 private:
  void visit(const LocalScene& parent, const Box3& box, int level, double weight, bool on_coarse);
  void cut(const LocalScene& local, const Box3& box, double weight, std::vector<double>& sums);
  void cut_pair(const LocalScene& local, double weight, std::vector<double>& sums) const;
  void combine();

  int depth_;
  std::vector<LocalScene> levels_;
  CubeValues cube_;
  OwnershipProblem problem_;
  std::vector<OwnedTetrahedron> parts_;
  std::vector<double> fine_, coarse_, errors_;
};

/// Fraction of a tetrahedron where a linear function, given at the vertices, is positive.
double positive_fraction(const std::array<double, 4>& values);

}  // namespace adamas::datasets
