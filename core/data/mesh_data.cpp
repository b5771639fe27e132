#include "core/data/mesh_data.h"

#include <algorithm>

#include "core/base/error.h"

namespace adamas::inline core {

void MeshData::normalise() {
  if (!labels.empty()) return;
  report = normalise_fractions(
      source, materials, [](std::size_t cell) { return fmt::format("cell {}", cell); }, fractions);
}

IdVector<MaterialId, double> MeshData::volumes() const {
  IdVector<MaterialId, double> result(materials.size(), 0.0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const double volume = mesh.cell_volume(c);
    if (!labels.empty()) {
      result[MaterialId(labels[c])] += volume;
      continue;
    }
    for (MaterialId m(0); m.value < result.size(); ++m.value)
      result[m] += volume * static_cast<double>(fractions[m][c]);
  }
  return result;
}

void MeshData::check() const {
  const std::size_t cells = mesh.cell_count();
  if (!labels.empty()) {
    if (!fractions.empty()) fail("{}: expected labels or volume fractions, found both", source);
    if (labels.size() != cells)
      fail("{}: labels: expected {} values, found {}", source, cells, labels.size());
    const auto bad = std::ranges::find_if(labels, [&](std::uint16_t m) { return m >= materials.size(); });
    if (bad != labels.end()) {
      fail("{}: labels: expected materials below {}, found {} at index {}", source, materials.size(), *bad,
           bad - labels.begin());
    }
  }
  check_fractions(source, materials, fractions, !labels.empty(), cells);
  for (const MeshField& field : fields)
    check_field(source, field, field.centering == Centering::kCells ? cells : mesh.points().size());
}

}  // namespace adamas::inline core
