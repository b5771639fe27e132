#include "datasets/flow/flow_output.h"

#include "core/base/parallel.h"

namespace adamas::datasets {

namespace {

RectilinearGrid flow_grid(const Box3& box, const std::array<std::size_t, 3>& cells) {
  RectilinearGrid grid;
  const std::array<double, 3> low{box.min.x, box.min.y, box.min.z}, high{box.max.x, box.max.y, box.max.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = static_cast<double>(cells[axis]);
    for (std::size_t i = 0; i <= cells[axis]; ++i) {
      const double part = static_cast<double>(i) / n;
      grid.nodes[axis].push_back(low[axis] * (1 - part) + high[axis] * part);
    }
  }
  return grid;
}

/// Writes one cell into the arrays.
template <std::size_t N>
void put(const FlowCell<N>& cell, std::size_t site, MultiMaterialData& data) {
  double kept = 0;
  for (const double f : cell.fractions) kept += f < kLeastFraction ? 0 : f;
  for (std::size_t m = 0; m < N; ++m) {
    if (cell.fractions[m] < kLeastFraction) continue;
    data.fractions[MaterialId(m)][site] = static_cast<float>(cell.fractions[m] / kept);
    data.fields[0].material_values[MaterialId(m)].set(site, cell.densities[m]);
  }
  data.fields[1].values.set(site, cell.pressure);
  data.fields[2].values.set(3 * site, cell.velocity.x);
  data.fields[2].values.set(3 * site + 1, cell.velocity.y);
  data.fields[2].values.set(3 * site + 2, cell.velocity.z);
}

}  // namespace

template <std::size_t N>
MultiMaterialData flow_data(const FlowSolver<N>& flow, const std::string& source, const FlowUnits& units) {
  const auto& cells = flow.problem().cells;
  const std::size_t count = cells[0] * cells[1] * cells[2];
  MultiMaterialData data;
  data.source = source;
  data.grid = flow_grid(flow.problem().box, cells);
  for (const FlowMaterial& material : flow.problem().materials) data.materials.push_back(material.name);
  data.fractions.assign(N, SiteArray<float>(count));
  data.fields.resize(3);
  data.fields[0] = {"density", units.density, 1, {}, {}};
  data.fields[0].material_values.assign(N, std::vector<float>(count));
  data.fields[1] = {"pressure", units.pressure, 1, std::vector<float>(count), {}};
  data.fields[2] = {"velocity", units.velocity, 3, std::vector<float>(3 * count), {}};
  parallel_for(cells[2], 1, [&](std::size_t k) {
    for (std::size_t j = 0; j < cells[1]; ++j) {
      for (std::size_t i = 0; i < cells[0]; ++i) {
        put(flow.cell(i, j, k), i + cells[0] * (j + cells[1] * k), data);
      }
    }
  });
  return data;
}

template MultiMaterialData flow_data(const FlowSolver<1>&, const std::string&, const FlowUnits&);
template MultiMaterialData flow_data(const FlowSolver<2>&, const std::string&, const FlowUnits&);
template MultiMaterialData flow_data(const FlowSolver<3>&, const std::string&, const FlowUnits&);

}  // namespace adamas::datasets
