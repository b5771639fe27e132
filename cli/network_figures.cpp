#include "cli/network_figures.h"

#include <nlohmann/json.hpp>

#include "interfaces/library/interface_areas.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

/// Of more interfaces than these only the number is printed.
constexpr std::size_t kMostRows = 40;

}  // namespace

Figures print_interfaces(const std::vector<InterfaceArea>& interfaces,
                         const std::vector<std::string>& materials, bool areas, bool print,
                         Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"interface", "triangles"}};
  if (areas) rows[0].push_back("area");
  for (const InterfaceArea& of : interfaces) {
    const std::string &a = materials[of.materials[0]], &b = materials[of.materials[1]];
    Figures figure{{"materials", {a, b}}, {"triangles", of.triangles}};
    if (areas) figure["area"] = of.area;
    figures.push_back(std::move(figure));
    if (rows.size() > kMostRows) continue;
    rows.push_back({a + " | " + b, std::to_string(of.triangles)});
    if (areas) rows.back().push_back(volume_text(of.area));
  }
  if (!print) return figures;
  console.table(rows);
  if (interfaces.size() > kMostRows) console.print("  ... and {} more\n", interfaces.size() - kMostRows);
  return figures;
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
  return print_interfaces(interface_areas(source), {source.materials.begin(), source.materials.end()}, true,
                          print, console);
}

}  // namespace adamas::cli
