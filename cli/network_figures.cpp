#include "cli/network_figures.h"

#include <map>
#include <nlohmann/json.hpp>

#include "interfaces/network/network_measures.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

/// Of more interfaces than these only the number is printed.
constexpr std::size_t kMostRows = 40;

using Pair = std::pair<MaterialId, MaterialId>;

struct Sum {
  std::size_t triangles = 0;
  double area = 0;
};

Figures print_sums(const std::map<Pair, Sum>& sums, const IdVector<MaterialId, std::string>& materials,
                   bool areas, bool print, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"interface", "triangles"}};
  if (areas) rows[0].push_back("area");
  for (const auto& [pair, sum] : sums) {
    const std::string &a = materials[pair.first], &b = materials[pair.second];
    Figures figure{{"materials", {a, b}}, {"triangles", sum.triangles}};
    if (areas) figure["area"] = sum.area;
    figures.push_back(std::move(figure));
    if (rows.size() > kMostRows) continue;
    rows.push_back({a + " | " + b, std::to_string(sum.triangles)});
    if (areas) rows.back().push_back(volume_text(sum.area));
  }
  if (!print) return figures;
  console.table(rows);
  if (sums.size() > kMostRows) console.print("  ... and {} more\n", sums.size() - kMostRows);
  return figures;
}

}  // namespace

Figures print_interfaces(const InterfaceMesh& mesh, bool areas, Console& console) {
  std::map<Pair, Sum> sums;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t.points[0]], &b = mesh.points[t.points[1]], &c = mesh.points[t.points[2]];
    Sum& sum = sums[std::minmax(t.front, t.back)];
    ++sum.triangles;
    sum.area += 0.5 * norm(cross(b - a, c - a));
  }
  return print_sums(sums, mesh.materials, areas, true, console);
}

Figures print_network_volumes(const ResamplingSource& source, const char* key, bool print, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  const bool known = !source.volumes.empty();
  for (MaterialId m(0); m.value < source.materials.size(); ++m.value) {
    figures.push_back(
        {{"name", source.materials[m]}, {key, known ? Figures(source.volumes[m]) : Figures(nullptr)}});
    rows.push_back({source.materials[m], known ? volume_text(source.volumes[m]) : "-"});
  }
  if (print) console.table(rows);
  if (!known) console.note("{}: the interfaces are not closed, so that volumes are not known", source.name);
  return figures;
}

Figures print_interface_areas(const ResamplingSource& source, bool print, Console& console) {
  const InterfaceNetwork& network = *source.network;
  const NetworkMeasures measures = measure_network(network, source.box, source.materials.size());
  std::map<Pair, Sum> sums;
  for (InterfaceId i(0); i.value < measures.areas.size(); ++i.value) {
    const auto& [a, b] = network.table().sides(i);
    Sum& sum = sums[std::minmax(network.table().material(a), network.table().material(b))];
    sum.triangles += network.interface(i).count;
    sum.area += measures.areas[i];
  }
  return print_sums(sums, source.materials, true, print, console);
}

}  // namespace adamas::cli
