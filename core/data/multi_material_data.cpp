#include "core/data/multi_material_data.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace adamas {

namespace {

constexpr float kTrace = 1e-6f;

void check_nodes(const std::string& source, const RectilinearGrid& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto& nodes = grid.nodes[static_cast<std::size_t>(axis)];
    const char name = "xyz"[axis];
    if (nodes.size() < 2) {
      fail("{}: expected a grid with volume, found {} node(s) along {}", source, nodes.size(), name);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!std::isfinite(nodes[i]))
        fail("{}: expected finite coordinates, found {} along {}", source, nodes[i], name);
      if (i > 0 && !(nodes[i] > nodes[i - 1])) {
        fail("{}: expected ascending coordinates along {}, found {} after {}", source, name, nodes[i],
             nodes[i - 1]);
      }
    }
  }
}

void check_array(const std::string& source, const std::string& name, const std::vector<float>& values,
                 std::size_t expected) {
  if (values.size() != expected) {
    fail("{}: array '{}': expected {} values, found {}", source, name, expected, values.size());
  }
  const auto bad = std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
  if (bad != values.end()) {
    fail("{}: array '{}': expected finite values, found {} at index {}", source, name, *bad,
         bad - values.begin());
  }
}

}  // namespace

void MultiMaterialData::check() const {
  check_nodes(source, grid);
  const std::size_t count = grid.site_count();
  if (materials.empty()) fail("{}: expected at least one material, found none", source);
  if (labels.empty() && fractions.size() != materials.size()) {
    fail("{}: expected volume fractions of {} materials, found {}", source, materials.size(),
         fractions.size());
  }
  if (!labels.empty() && labels.size() != count) {
    fail("{}: labels: expected {} values, found {}", source, count, labels.size());
  }
  for (MaterialId m(0); m.value < fractions.size(); ++m.value)
    check_array(source, materials[m], fractions[m], count);
  for (const Field& field : fields) {
    const std::size_t expected = count * static_cast<std::size_t>(field.components);
    if (!field.per_material()) check_array(source, field.name, field.values, expected);
    for (const auto& values : field.material_values) {
      if (!values.empty()) check_array(source, field.name, values, expected);
    }
  }
}

IdVector<MaterialId, double> MultiMaterialData::volumes() const {
  IdVector<MaterialId, double> result(materials.size(), 0.0);
  std::size_t site = 0;
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i, ++site) {
        const double volume = grid.site_volume(i, j, k);
        if (!labels.empty()) {
          result[MaterialId(labels[site])] += volume;
          continue;
        }
        for (MaterialId m(0); m.value < result.size(); ++m.value) {
          result[m] += volume * static_cast<double>(fractions[m][site]);
        }
      }
    }
  }
  return result;
}

void MultiMaterialData::normalise(double tolerance) {
  if (!labels.empty()) return;
  report = {};
  const std::size_t count = grid.site_count();
  bool first = true;
  for (std::size_t site = 0; site < count; ++site) {
    double sum = 0;
    for (MaterialId m(0); m.value < fractions.size(); ++m.value) {
      float& f = fractions[m][site];
      if (!std::isfinite(f)) {
        fail("{}: volume fraction of '{}': expected a number in [0, 1], found {} at index {}", source,
             materials[m], f, site);
      }
      sum += static_cast<double>(f);
      if (f < 0) ++report.negative;
      if (f > 0 && f < kTrace) ++report.traces;
      if (f < kTrace) f = 0;
    }
    report.sum_min = first ? sum : std::min(report.sum_min, sum);
    report.sum_max = first ? sum : std::max(report.sum_max, sum);
    first = false;
    if (!(std::abs(sum - 1) <= tolerance)) {
      fail("{}: volume fractions: expected a sum of 1 within {}, found {:.6g} at index {}", source, tolerance,
           sum, site);
    }
    double kept = 0;
    for (auto& f : fractions) kept += static_cast<double>(f[site]);
    if (std::abs(kept - 1) > 1e-6) ++report.renormalised;
    for (auto& f : fractions) f[site] = static_cast<float>(static_cast<double>(f[site]) / kept);
  }
}

}  // namespace adamas
