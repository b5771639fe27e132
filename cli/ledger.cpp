#include "cli/ledger.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "adamas/text.h"

namespace adamas::cli {

Figures component_figures(const std::vector<double>& values, std::size_t first, int count) {
  if (count == 1) return values[first];
  Figures list = Figures::array();
  for (int c = 0; c < count; ++c) list.push_back(values[first + static_cast<std::size_t>(c)]);
  return list;
}

Figures ledger_figures(const std::vector<Ledger>& ledgers, const std::vector<FieldDescription>& fields) {
  Figures rows = Figures::array();
  for (const Ledger& ledger : ledgers) {
    for (const MaterialTotals& totals : ledger.materials) {
      Figures integrals = Figures::object();
      std::size_t at = 0;
      for (const FieldDescription& field : fields) {
        if (totals.integrals.empty()) break;
        integrals[field.name] = component_figures(totals.integrals, at, field.components);
        at += static_cast<std::size_t>(field.components);
      }
      rows.push_back({{"of", ledger.subject},
                      {"material", totals.name},
                      {"volume", totals.volume},
                      {"integrals", std::move(integrals)}});
    }
  }
  return rows;
}

std::string ledger_csv(const std::vector<Ledger>& ledgers, const std::vector<FieldDescription>& fields) {
  std::string text = "of,material,volume";
  for (const FieldDescription& field : fields) {
    for (int c = 0; c < field.components; ++c)
      text += "," + csv_text("integral of " + field.name +
                             (field.components > 1 ? fmt::format(" ({})", c) : std::string()));
  }
  text += "\n";
  for (const Ledger& ledger : ledgers) {
    for (const MaterialTotals& totals : ledger.materials) {
      text += fmt::format("{},{},{:.17g}", ledger.subject, csv_text(totals.name), totals.volume);
      std::size_t at = 0;
      for (const FieldDescription& field : fields) {
        for (int c = 0; c < field.components; ++c, ++at) {
          const bool known = at < totals.integrals.size() && !std::isnan(totals.integrals[at]);
          text += known ? fmt::format(",{:.17g}", totals.integrals[at]) : ",";
        }
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace adamas::cli
