#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/distance/closest_point_tree.h"

namespace adamas::inline core {

/// Builds the nodes of a ClosestPointTree from the top, by binned surface area. Parts below a fixed size are
/// built in parallel and joined in order, so that the tree does not depend on the number of threads.
class ClosestPointTreeBuilder {
 public:
  /// `tree` has its bounds, centre and scale; sets its nodes and `index_`.
  ClosestPointTreeBuilder(ClosestPointTree& tree, std::span<const Vec3> points,
                          std::span<const ClosestPointTree::Triangle> triangles);
  void build();

 private:
  struct FloatBox {
    std::array<float, 3> lower, upper;
    static FloatBox empty();
    void extend(const FloatBox& b);
    [[nodiscard]] float half_area() const;
  };
  struct Item {
    FloatBox box;
    std::uint32_t triangle;
  };
  struct Range {
    std::size_t begin, end;
    FloatBox box;
    int depth;
    [[nodiscard]] std::size_t count() const { return end - begin; }
  };
  /// A part whose nodes are built later; its root belongs in child `slot` of node `parent`.
  struct Deferred {
    Range range;
    std::uint32_t parent;
    int slot;
  };
  using Nodes = ClosestPointTree::Nodes;

  [[nodiscard]] FloatBox box_of(const ClosestPointTree::Triangle& t) const;
  [[nodiscard]] FloatBox box_of_items(std::size_t begin, std::size_t end) const;
  /// Orders the items of a range and divides it in two parts, none of them empty.
  std::array<Range, 2> split(const Range& range);
  std::size_t partition(const Range& range, int axis, float from, float to);
  std::uint32_t build_node(const Range& range, Nodes& nodes, std::vector<Deferred>* deferred);
  void build_deferred(const std::vector<Deferred>& deferred);

  ClosestPointTree& tree_;
  std::span<const Vec3> points_;
  std::span<const ClosestPointTree::Triangle> triangles_;
  std::vector<Item> items_;
};

}  // namespace adamas::inline core
