#include "interfaces/api/interface_areas.h"

#include <algorithm>
#include <map>
#include <utility>

#include "interfaces/network/network_measures.h"

namespace adamas::interfaces {

namespace {

using Areas = std::map<std::pair<MaterialId, MaterialId>, InterfaceArea>;

InterfaceArea& area_between(MaterialId a, MaterialId b, Areas& areas) {
  InterfaceArea& area = areas[std::minmax(a, b)];
  area.materials = {std::min(a, b).value, std::max(a, b).value};
  return area;
}

std::vector<InterfaceArea> listed(const Areas& areas) {
  std::vector<InterfaceArea> result;
  for (const auto& [pair, area] : areas) result.push_back(area);
  return result;
}

}  // namespace

std::vector<InterfaceArea> interface_areas(const InterfaceMesh& mesh) {
  Areas areas;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t.points[0]], &b = mesh.points[t.points[1]], &c = mesh.points[t.points[2]];
    InterfaceArea& sum = area_between(t.front, t.back, areas);
    ++sum.triangles;
    sum.area += 0.5 * norm(cross(b - a, c - a));
  }
  return listed(areas);
}

std::vector<InterfaceArea> interface_areas(const ResamplingSource& source) {
  const InterfaceNetwork& network = *source.network;
  const NetworkMeasures measures = measure_network(network, source.box, source.materials.size());
  Areas areas;
  for (InterfaceId i(0); i.value < measures.areas.size(); ++i.value) {
    const auto& [a, b] = network.table().sides(i);
    InterfaceArea& sum = area_between(network.table().material(a), network.table().material(b), areas);
    sum.triangles += network.interface(i).count;
    sum.area += measures.areas[i];
  }
  return listed(areas);
}

}  // namespace adamas::interfaces
