#include "interfaces/network/grid_bodies.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {

/// The number of sites along each side of the blocks that are processed in parallel.
constexpr std::size_t kBlock = 32;
/// The sites of blocks of at most this length are looked up one by one.
constexpr std::size_t kSmall = 2;

/// The sites from `first` to before `last` along each axis.
struct Block {
  std::array<std::size_t, 3> first, last;
};

class SiteBodies {
 public:
  SiteBodies(const InterfaceNetwork& network, const RectilinearGrid& grid, std::vector<BodyId>& bodies)
      : network_(network),
        grid_(grid),
        bodies_(bodies),
        closed_(!network.has_open_border() && network.inconsistencies() == 0) {}

  void fill(const Block& block) {
    const auto& [first, last] = block;
    std::size_t longest = 0, axis = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (last[a] - first[a] > longest) longest = last[a] - first[a], axis = a;
    }
    if (longest <= kSmall || !closed_)
      return for_each(block, [&](const Vec3& p) { return network_.body_at(p); });
    const Vec3 low = grid_.site(first[0], first[1], first[2]);
    const Box3 box{low, grid_.site(last[0] - 1, last[1] - 1, last[2] - 1)};
    if (!network_.tree().any_overlap(box)) {
      const BodyId body = network_.body_at(low);
      return for_each(block, [&](const Vec3&) { return body; });
    }
    Block lower = block, upper = block;
    lower.last[axis] = upper.first[axis] = first[axis] + longest / 2;
    fill(lower);
    fill(upper);
  }

 private:
  template <class Body>
  void for_each(const Block& block, Body&& body) {
    for (std::size_t k = block.first[2]; k < block.last[2]; ++k) {
      for (std::size_t j = block.first[1]; j < block.last[1]; ++j) {
        for (std::size_t i = block.first[0]; i < block.last[0]; ++i)
          bodies_[grid_.site_index(i, j, k)] = body(grid_.site(i, j, k));
      }
    }
  }

  const InterfaceNetwork& network_;
  const RectilinearGrid& grid_;
  std::vector<BodyId>& bodies_;
  bool closed_;
};

}  // namespace

std::vector<BodyId> bodies_at_sites(const InterfaceNetwork& network, const RectilinearGrid& grid) {
  std::vector<BodyId> bodies(grid.site_count());
  std::vector<Block> blocks;
  for (std::size_t k = 0; k < grid.sites(2); k += kBlock) {
    for (std::size_t j = 0; j < grid.sites(1); j += kBlock) {
      for (std::size_t i = 0; i < grid.sites(0); i += kBlock) {
        blocks.push_back({{i, j, k},
                          {std::min(i + kBlock, grid.sites(0)), std::min(j + kBlock, grid.sites(1)),
                           std::min(k + kBlock, grid.sites(2))}});
      }
    }
  }
  SiteBodies sites(network, grid, bodies);
  parallel_for(blocks.size(), 1, [&](std::size_t i) { sites.fill(blocks[i]); });
  return bodies;
}

}  // namespace adamas::interfaces
