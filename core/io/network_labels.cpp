#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/io/network_text.h"

namespace adamas::io {

namespace {

struct Region {
  double volume = 0;  ///< as if the first label were the front
  Vec3 center;
  std::size_t corners = 0;
  std::size_t open_edges = 0;
};

/// Counts, per region, the edges whose triangles do not cancel each other's direction.
void count_open_edges(const LabelledNetwork& network, std::map<std::int32_t, Region>& regions) {
  std::vector<std::array<std::int64_t, 4>> edges;  // smaller point, greater point, label, direction
  edges.reserve(network.triangles.size() * 6);
  for (std::size_t t = 0; t < network.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t a = network.triangles[t][i], b = network.triangles[t][(i + 1) % 3];
      const std::int64_t direction = a < b ? 1 : -1;
      edges.push_back({std::min(a, b), std::max(a, b), network.labels[t][0], -direction});
      edges.push_back({std::min(a, b), std::max(a, b), network.labels[t][1], direction});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::int64_t sum = 0;
    std::size_t j = i;
    for (; j < edges.size() && std::equal(edges[i].begin(), edges[i].begin() + 3, edges[j].begin()); ++j) {
      sum += edges[j][3];
    }
    if (sum != 0) ++regions[static_cast<std::int32_t>(edges[i][2])].open_edges;
    i = j;
  }
}

std::map<std::int32_t, Region> measure(const LabelledNetwork& network) {
  std::map<std::int32_t, Region> regions;
  const auto each = [&network](const auto& visit) {
    for (std::size_t t = 0; t < network.triangles.size(); ++t) {
      if (network.labels[t][0] == network.labels[t][1]) continue;
      for (std::size_t side = 0; side < 2; ++side) visit(network.labels[t][side], network.triangles[t], side);
    }
  };
  each([&](std::int32_t label, const std::array<std::uint32_t, 3>& corners, std::size_t) {
    Region& region = regions[label];
    for (const std::uint32_t corner : corners) region.center += network.points[corner];
    region.corners += 3;
  });
  for (auto& [label, region] : regions) region.center *= 1.0 / static_cast<double>(region.corners);
  each([&](std::int32_t label, const std::array<std::uint32_t, 3>& corners, std::size_t side) {
    Region& region = regions[label];
    const auto& p = network.points;
    const double volume = signed_volume(region.center, p[corners[0]], p[corners[1]], p[corners[2]]);
    region.volume += side == 0 ? -volume : volume;
  });
  count_open_edges(network, regions);
  return regions;
}

}  // namespace

bool first_label_is_front(const LabelledNetwork& network) {
  const auto regions = measure(network);
  const bool any_closed = std::any_of(regions.begin(), regions.end(),
                                      [](const auto& entry) { return entry.second.open_edges == 0; });
  std::ptrdiff_t votes = 0;
  const Region* smallest = nullptr;
  for (const auto& [label, region] : regions) {
    if (any_closed && region.open_edges != 0) continue;
    if (smallest == nullptr) smallest = &region;
    votes += region.volume > 0 ? 1 : region.volume < 0 ? -1 : 0;
  }
  if (votes != 0) return votes > 0;
  return smallest == nullptr || smallest->volume <= 0;
}

InterfaceMesh to_interface_mesh(const LabelledNetwork& network,
                                const std::map<std::int32_t, std::string>& names, const std::string& source) {
  InterfaceMesh mesh;
  mesh.source = source;
  mesh.points = network.points;
  std::map<std::int32_t, MaterialId> materials;
  for (const auto& pair : network.labels) {
    for (const std::int32_t label : pair) materials.try_emplace(label);
  }
  std::set<std::string> taken;
  for (auto& [label, material] : materials) {
    material = mesh.materials.next_id();
    const auto name = names.find(label);
    mesh.materials.push_back(name != names.end() ? name->second : std::to_string(label));
    if (!taken.insert(mesh.materials.back()).second) {
      fail("{}: expected regions of different names, found '{}' twice", source, mesh.materials.back());
    }
  }
  const bool first_is_front = first_label_is_front(network);
  for (std::size_t t = 0; t < network.triangles.size(); ++t) {
    const auto [first, second] = network.labels[t];
    if (first == second) continue;
    const MaterialId a = materials.at(first), b = materials.at(second);
    mesh.triangles.push_back({network.triangles[t], first_is_front ? a : b, first_is_front ? b : a});
  }
  return mesh;
}

}  // namespace adamas::io
