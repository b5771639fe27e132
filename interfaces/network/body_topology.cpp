#include "interfaces/network/body_topology.h"

#include "core/base/disjoint_sets.h"
#include "interfaces/network/bodies.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

/// Returns the number of a corner of a side of a triangle; both sides have three.
std::uint32_t corner_index(std::uint32_t triangle, int side, std::size_t corner) {
  return 6 * triangle + 3 * static_cast<std::uint32_t>(side) + static_cast<std::uint32_t>(corner);
}

class EulerCounter {
 public:
  EulerCounter(const InterfaceMesh& mesh, const EdgeFans& fans, IdVector<BodyId, BodyTopology>& result)
      : mesh_(mesh), fans_(fans), corners_(6 * mesh.triangles.size()), result_(result) {}

  void count() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (int side = 0; side < 2; ++side) ++euler(t, side);
    }
    EdgeFans::Fan fan;
    for (std::size_t edge = 0; edge < fans_.size(); ++edge) {
      fans_.wedges(edge, fan);
      count_edge(edge, fan);
    }
    for (std::uint32_t c = 0; c < 6 * mesh_.triangles.size(); ++c) {
      if (corners_.find(c) == c) ++euler(c / 6, static_cast<int>(c % 6 / 3));
    }
  }

 private:
  std::int64_t& euler(std::uint32_t triangle, int side) {
    return result_[BodyId(fans_.material(triangle, side).value)].euler;
  }

  /// Counts one edge for each wedge of one body between two sides, and one for a side without a neighbour.
  void count_edge(std::size_t edge, const EdgeFans::Fan& fan) {
    const auto ends = fans_.ends(edge);
    const std::size_t n = fan.blades.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Blade &a = fan.blades[i], &b = fan.blades[(i + 1) % n];
      const int ahead = EdgeFans::side_ahead(a), behind = EdgeFans::side_behind(b);
      --euler(a.triangle, ahead);
      if (n > 1 && i != fan.outside_wedge &&
          fans_.material(a.triangle, ahead) == fans_.material(b.triangle, behind)) {
        for (const std::uint32_t end : ends)
          corners_.join(corner_index(a.triangle, ahead, corner_at(a.triangle, end)),
                        corner_index(b.triangle, behind, corner_at(b.triangle, end)));
      } else {
        --euler(b.triangle, behind);
      }
    }
  }

  [[nodiscard]] std::size_t corner_at(std::uint32_t triangle, std::uint32_t point) const {
    const auto& p = mesh_.triangles[triangle].points;
    return fans_.welded(p[0]) == point ? 0 : fans_.welded(p[1]) == point ? 1 : 2;
  }

  const InterfaceMesh& mesh_;
  const EdgeFans& fans_;
  DisjointSets corners_;
  IdVector<BodyId, BodyTopology>& result_;
};

}  // namespace

IdVector<BodyId, BodyTopology> body_topology(InterfaceMesh mesh, std::size_t bodies, const Box3& domain,
                                             const ClosestPointTree* tree) {
  mesh.materials.assign(bodies, {});
  const EdgeFans fans(mesh, &domain);
  IdVector<BodyId, BodyTopology> result(bodies);
  for (const MaterialId body : find_bodies(mesh, fans, &domain, tree).materials)
    ++result[BodyId(body.value)].pieces;
  EulerCounter(mesh, fans, result).count();
  return result;
}

}  // namespace adamas::interfaces
