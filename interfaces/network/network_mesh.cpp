#include "interfaces/network/network_mesh.h"

namespace adamas::interfaces {

InterfaceMesh network_mesh(const InterfaceNetwork& network,
                           const IdVector<MaterialId, std::string>& materials, const std::string& source) {
  InterfaceMesh mesh;
  mesh.source = source;
  mesh.materials = materials;
  mesh.points.assign(network.points().begin(), network.points().end());
  mesh.triangles.reserve(network.triangles().size());
  const InterfaceTable& table = network.table();
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& [front, back] = table.sides(network.interface_of(t));
    mesh.triangles.push_back({network.triangles()[t], table.material(front), table.material(back)});
  }
  return mesh;
}

}  // namespace adamas::interfaces
