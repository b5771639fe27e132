#include "interfaces/network/vertex_tree.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <cmath>
#include <utility>
#include <vector>

namespace adamas {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Numbered = std::pair<Kernel::Point_3, std::uint32_t>;
using Traits = CGAL::Search_traits_adapter<Numbered, CGAL::First_of_pair_property_map<Numbered>,
                                           CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;

/// Squared distances that agree so well may be equal, but for the order of sums.
constexpr double kTie = 1e-14;

std::vector<Numbered> numbered(std::span<const Vec3> points) {
  std::vector<Numbered> result;
  result.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    result.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), i);
  return result;
}

}  // namespace

struct VertexTree::Tree {
  explicit Tree(const std::vector<Numbered>& points) : tree(points.begin(), points.end()) {
    // Otherwise built by the first query, which others would have to wait for.
    if (!points.empty()) tree.build();
  }
  Search::Tree tree;
};

VertexTree::VertexTree(std::span<const Vec3> points) : tree_(std::make_unique<Tree>(numbered(points))) {}
VertexTree::VertexTree(VertexTree&&) noexcept = default;
VertexTree& VertexTree::operator=(VertexTree&&) noexcept = default;
VertexTree::~VertexTree() = default;

std::optional<NearestVertex> VertexTree::nearest(const Vec3& q, double max_distance) const {
  const Search::Tree& tree = tree_->tree;
  if (tree.size() == 0 || !std::isfinite(q.x + q.y + q.z)) return std::nullopt;
  std::optional<NearestVertex> best;
  // More and more of them, until one is farther: of equally near ones the lowest is wanted.
  for (unsigned count = 2;; count *= 2) {
    const Search search(tree, Kernel::Point_3(q.x, q.y, q.z), count);
    const double least = search.begin()->second;
    double last = least;
    best.reset();
    for (const auto& [point, squared] : search) {
      last = squared;
      if (squared > (1 + kTie) * least) break;
      const Kernel::Point_3& p = point.first;
      const double own = squared_norm(q - Vec3{p.x(), p.y(), p.z()});
      if (!best || own < best->squared_distance ||
          (own == best->squared_distance && point.second < best->index))
        best = {point.second, own};
    }
    if (last > (1 + kTie) * least || count >= tree.size()) break;
  }
  if (best->squared_distance > max_distance * max_distance) return std::nullopt;
  return best;
}

}  // namespace adamas
