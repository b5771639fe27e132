#pragma once

#include <cstdint>
#include <vector>

#include "isosurface/compression/context_counts.h"

namespace adamas {

/// Contexts put together where a table of their own would cost more than it saves.
struct ContextClusters {
  std::vector<std::uint8_t> map;                   ///< the cluster of each context
  std::vector<std::vector<std::uint64_t>> counts;  ///< of each cluster's symbols; at least one cluster
};

/// Joins, again and again, the two clusters that cost least to join, while that saves anything or there are
/// more than `most` (1 to 255). Contexts that never occur are put to the cluster of the one before them.
[[nodiscard]] ContextClusters context_clusters(const ContextCounts& counts, std::size_t most);

}  // namespace adamas
