#include "interfaces/resampling/body_comparison.h"

#include <algorithm>

#include "core/base/sort_unique.h"
#include "interfaces/network/domain_faces.h"

namespace adamas::interfaces {

namespace {

using Pair = std::array<BodyId, 2>;

bool contains(Box3 box, std::span<const Vec3> points) {
  const double margin = kOnDomainFace * box.diagonal();
  box.min -= {margin, margin, margin};
  box.max += {margin, margin, margin};
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return box.contains(p); });
}

}  // namespace

IdVector<BodyId, BodyTopology> body_topology(ExtractedInterfaces shown, std::size_t bodies,
                                             const Box3& domain) {
  for (std::size_t t = 0; t < shown.bodies.size(); ++t) {
    shown.mesh.triangles[t].front = as_material(shown.bodies[t][0]);
    shown.mesh.triangles[t].back = as_material(shown.bodies[t][1]);
  }
  return body_topology(std::move(shown.mesh), bodies, domain);
}

BodyComparison::BodyComparison(const ResamplingSource& source)
    : source_(source), sizes_(source.network->table().body_count(), 0.0) {
  const InterfaceNetwork& network = *source.network;
  findings_.report.input = body_topology(network, source.box);
  findings_.report.comparable =
      !network.has_open_border() && network.inconsistencies() == 0 && contains(source.box, network.points());
  for (BodyId b(0); b.value < sizes_.size(); ++b.value) sizes_[b] = network.tree(b).bounds().diagonal();
  find_touching();
}

void BodyComparison::find_touching() {
  const InterfaceNetwork& network = *source_.network;
  const auto for_each_corner = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
      const Pair& bodies = network.table().sides(network.interface_of(t));
      for (const std::uint32_t p : network.triangles()[t]) visit(p, bodies);
    }
  };
  // Most points are on one interface only; the table has its bodies.
  std::vector<Pair> bodies_at(network.points().size());
  std::vector<char> has_more(bodies_at.size(), 0);
  for_each_corner([&](std::uint32_t p, const Pair& bodies) {
    if (!bodies_at[p][0].valid()) bodies_at[p] = bodies;
    if (bodies_at[p] != bodies) has_more[p] = 1;
  });
  std::vector<std::pair<std::uint32_t, BodyId>> at_points;
  for_each_corner([&](std::uint32_t p, const Pair& bodies) {
    if (has_more[p] == 0) return;
    for (const BodyId body : bodies) at_points.emplace_back(p, body);
  });
  sort_unique(at_points);
  for (std::size_t first = 0, last = 0; first < at_points.size(); first = last) {
    while (last < at_points.size() && at_points[last].first == at_points[first].first) ++last;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = i + 1; j < last; ++j)
        touching_.push_back({at_points[i].second, at_points[j].second});
    }
  }
  sort_unique(touching_);
}

void BodyComparison::measure(const ExtractedInterfaces& shown) {
  findings_.report.mesh = body_topology(shown, sizes_.size(), source_.box);
  findings_.report.contacts.clear();
  findings_.contact_triangles.clear();
  for (std::uint32_t t = 0; t < shown.bodies.size(); ++t) {
    const auto& [front, back] = shown.bodies[t];
    const Pair pair{std::min(front, back), std::max(front, back)};
    if (source_.network->table().find(front, back)) continue;
    if (std::binary_search(touching_.begin(), touching_.end(), pair)) continue;
    findings_.report.contacts.push_back(pair);
    findings_.contact_triangles.push_back(t);
  }
  sort_unique(findings_.report.contacts);
}

std::size_t BodyReport::torn(BodyId body) const {
  const auto between = [](auto a, auto b) { return static_cast<std::size_t>(a < b ? b - a : a - b); };
  return between(input[body].pieces, mesh[body].pieces) +
         (comparable ? between(input[body].euler, mesh[body].euler) : 0);
}

BodyFaults BodyComparison::faults(double size) const {
  BodyFaults faults{findings_.report.contacts.size(), 0};
  for (BodyId b(0); b.value < sizes_.size(); ++b.value) {
    if (findings_.report.keeps_topology(b) || sizes_[b] <= size) continue;
    if (findings_.report.mesh[b].pieces == 0)
      ++faults.lost_or_joined;
    else
      faults.torn += findings_.report.torn(b);
  }
  return faults;
}

}  // namespace adamas::interfaces
