#include "core/io/centering.h"

#include <algorithm>
#include <array>

namespace adamas {

std::vector<float> average_to(Centering to, const RectilinearGrid& from, std::size_t components,
                              const std::vector<float>& values) {
  if (to == from.centering) return values;
  RectilinearGrid target{from.nodes, to};
  // Along an axis site i of the target touches sites i + first .. i + first + 1 of the source, where they
  // exist.
  const std::ptrdiff_t first = to == Centering::kCells ? 0 : -1;
  std::vector<float> result(target.site_count() * components);
  std::array<std::size_t, 3> index{}, begin{}, end{};
  for (std::size_t site = 0; site < target.site_count(); ++site) {
    index = {site % target.sites(0), site / target.sites(0) % target.sites(1),
             site / (target.sites(0) * target.sites(1))};
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::ptrdiff_t low = static_cast<std::ptrdiff_t>(index[axis]) + first;
      const auto limit = static_cast<std::ptrdiff_t>(from.sites(static_cast<int>(axis)));
      begin[axis] = static_cast<std::size_t>(std::max<std::ptrdiff_t>(low, 0));
      end[axis] = static_cast<std::size_t>(std::min(low + 2, limit));
      count *= end[axis] - begin[axis];
    }
    for (std::size_t c = 0; c < components; ++c) {
      double sum = 0;
      for (std::size_t k = begin[2]; k < end[2]; ++k) {
        for (std::size_t j = begin[1]; j < end[1]; ++j) {
          for (std::size_t i = begin[0]; i < end[0]; ++i) {
            sum += static_cast<double>(values[from.site_index(i, j, k) * components + c]);
          }
        }
      }
      result[site * components + c] = static_cast<float>(sum / static_cast<double>(count));
    }
  }
  return result;
}

}  // namespace adamas
