#include "cli/ledger.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace adamas {

Ledger volume_ledger(const std::string& of, const IdVector<MaterialId, double>& volumes) {
  Ledger ledger{of, {}};
  for (const double volume : volumes) ledger.materials.push_back({volume, {}, {}});
  return ledger;
}

Figures ledger_figures(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<FieldInfo>& fields) {
  Figures rows = Figures::array();
  for (const Ledger& ledger : ledgers) {
    for (MaterialId m(0); m.value < materials.size(); ++m.value) {
      const MaterialIntegral& sums = ledger.materials[m];
      Figures integrals = Figures::object();
      for (const FieldInfo& field : fields) {
        if (sums.integral.empty()) continue;
        Figures components = Figures::array();
        for (int c = 0; c < field.components; ++c)
          components.push_back(sums.integral[field.offset + static_cast<std::size_t>(c)]);
        integrals[field.name] = field.components == 1 ? components[0] : components;
      }
      rows.push_back({{"of", ledger.of},
                      {"material", materials[m]},
                      {"volume", sums.volume},
                      {"integrals", std::move(integrals)}});
    }
  }
  return rows;
}

std::string ledger_csv(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<FieldInfo>& fields) {
  std::string text = "of,material,volume";
  for (const FieldInfo& field : fields) {
    for (int c = 0; c < field.components; ++c)
      text += "," + csv_text("integral of " + field.name +
                             (field.components > 1 ? fmt::format(" ({})", c) : std::string()));
  }
  text += "\n";
  for (const Ledger& ledger : ledgers) {
    for (MaterialId m(0); m.value < materials.size(); ++m.value) {
      const MaterialIntegral& sums = ledger.materials[m];
      text += fmt::format("{},{},{:.17g}", ledger.of, csv_text(materials[m]), sums.volume);
      for (const FieldInfo& field : fields) {
        for (int c = 0; c < field.components; ++c) {
          const std::size_t at = field.offset + static_cast<std::size_t>(c);
          const bool known = at < sums.integral.size() && !std::isnan(sums.integral[at]);
          text += known ? fmt::format(",{:.17g}", sums.integral[at]) : ",";
        }
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace adamas
