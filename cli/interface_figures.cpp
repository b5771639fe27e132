#include "cli/interface_figures.h"

namespace adamas::cli {

namespace {

/// If there are more interfaces than these, only their number is printed.
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

Figures print_enclosed_volumes(const EnclosedVolumes& materials, const std::string& key,
                               const std::string& source, bool print, Console& console) {
  Figures figures = Figures::array();
  std::vector<std::vector<std::string>> rows{{"material", "volume"}};
  bool known = true;
  for (const auto& [name, volume] : materials) {
    known = known && volume.has_value();
    figures.push_back({{"name", name}, {key, figure(volume)}});
    rows.push_back({name, volume ? volume_text(*volume) : "-"});
  }
  if (print) console.table(rows);
  if (!known) console.note("{}: the interfaces are not closed, so that volumes are not known", source);
  return figures;
}

}  // namespace adamas::cli
