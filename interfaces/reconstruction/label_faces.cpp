#include "interfaces/reconstruction/label_faces.h"

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas {

LabelFaces::LabelFaces(const MultiMaterialData& data)
    : data_(data), n_{data.grid.sites(0), data.grid.sites(1), data.grid.sites(2)} {
  const std::size_t count = data.grid.site_count();
  mask_.resize(count);
  parallel_for(count, 1 << 14, [&](std::size_t site) {
    unsigned mask = 0;
    for (int d = 0; d < kDirections; ++d) {
      const std::size_t other = step(site, d);
      if (other < count && data.labels[other] != data.labels[site]) mask |= 1u << static_cast<unsigned>(d);
    }
    mask_[site] = static_cast<std::uint8_t>(mask);
  });
  std::uint64_t total = 0;
  first_.resize(count);
  for (std::size_t site = 0; site < count; ++site) {
    first_[site] = static_cast<std::uint32_t>(total);
    total += static_cast<std::uint64_t>(std::popcount(unsigned{mask_[site]}));
    if (total >= kNone) fail("{}: expected fewer faces between labels, found too many", data.source);
  }
  faces_.resize(total);
  parallel_for(count, 1 << 14, [&](std::size_t site) {
    for (int d = 0; d < kDirections; ++d) {
      const std::uint32_t face = find(site, d);
      if (face != kNone) faces_[face] = {static_cast<std::uint32_t>(site), d};
    }
  });
}

std::size_t LabelFaces::step(std::size_t site, int direction) const {
  const auto axis = static_cast<std::size_t>(direction / 2);
  const std::size_t at = place(site)[axis], stride = axis == 0 ? 1 : axis == 1 ? n_[0] : n_[0] * n_[1];
  if (direction % 2 == 0) return at + 1 < n_[axis] ? site + stride : n_[0] * n_[1] * n_[2];
  return at > 0 ? site - stride : n_[0] * n_[1] * n_[2];
}

std::array<std::uint32_t, 4> LabelFaces::neighbours(std::size_t face) const {
  const auto [site, out] = faces_[face];
  const std::uint16_t label = data_.labels[site];
  std::array<std::uint32_t, 4> result{};
  for (int e = 0; e < 4; ++e) {
    const int axis = (out / 2 + 1 + e / 2) % 3, along = 2 * axis + e % 2, back = along ^ 1;
    const std::size_t beside = step(site, along);
    auto& found = result[static_cast<std::size_t>(e)];
    if (beside >= mask_.size()) {
      found = kNone;
    } else if (data_.labels[beside] != label) {
      found = find(site, along);  // round the voxel
    } else {
      const std::size_t ahead = step(beside, out);
      found = data_.labels[ahead] == label ? find(ahead, back) : find(beside, out);
    }
  }
  return result;
}

Vec3 LabelFaces::middle(std::size_t face) const {
  const auto [site, out] = faces_[face];
  const std::array<std::size_t, 3> p = place(site);
  Vec3 result = data_.grid.site(p[0], p[1], p[2]);
  const int axis = out / 2;
  const std::size_t i = p[static_cast<std::size_t>(axis)], low = out % 2 == 0 ? i : i - 1;
  const auto& x = data_.grid.nodes[static_cast<std::size_t>(axis)];
  result[axis] = data_.grid.centering == Centering::kCells ? x[low + 1] : 0.5 * (x[low] + x[low + 1]);
  return result;
}

}  // namespace adamas
