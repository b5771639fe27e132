#include "core/data/multi_material_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/repeated_sum.h"
#include "core/geometry/length_limits.h"

namespace adamas::inline core {

namespace {

/// Sums of fractions that differ from 1 by less are right up to the rounding of numbers in files.
constexpr double kRoundOff = 1e-5;

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
      if (i > 0 && !within_length_limits(nodes[i - 1], nodes[i])) {
        fail("{}: expected coordinates below {} that are more than {} apart, found {} after {} along {}",
             source, kGreatestCoordinate, kLeastLength, nodes[i], nodes[i - 1], name);
      }
    }
  }
}

/// Values of fields are squared, so greater numbers are refused.
constexpr double kGreatestNumber = 1e150;

template <class Values>
void check_array(const std::string& source, const std::string& name, const Values& values,
                 std::size_t expected) {
  if (values.size() != expected) {
    fail("{}: array '{}': expected {} values, found {}", source, name, expected, values.size());
  }
  const auto bad = std::find_if(values.begin(), values.end(), [](auto v) {
    return !(std::abs(static_cast<double>(v)) <= kGreatestNumber);
  });
  if (bad == values.end()) return;
  const std::string what =
      std::isfinite(*bad) ? fmt::format("values of at most {}", kGreatestNumber) : "finite values";
  fail("{}: array '{}': expected {}, found {} at index {}", source, name, what, *bad, bad - values.begin());
}

void check_labels(const MultiMaterialData& data) {
  if (!data.fractions.empty()) fail("{}: expected labels or volume fractions, found both", data.source);
  if (data.labels.size() != data.grid.site_count()) {
    fail("{}: labels: expected {} values, found {}", data.source, data.grid.site_count(), data.labels.size());
  }
  if (const auto bad = data.labels.find_from(data.materials.size())) {
    fail("{}: labels: expected materials below {}, found {} at index {}", data.source, data.materials.size(),
         data.labels[*bad], *bad);
  }
}

/// Returns the sums of the volumes of sites with each label, in the order of sites.
IdVector<MaterialId, double> volumes_of_labels(const MultiMaterialData& data) {
  const RectilinearGrid& grid = data.grid;
  IdVector<MaterialId, double> result(data.materials.size(), 0.0);
  std::vector<double> extents;
  for (std::size_t i = 0; i < grid.sites(0); ++i) extents.push_back(grid.site_extent(0, i));
  const AxisLengths along(std::move(extents));
  std::size_t row = 0;
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    const double depth = grid.site_extent(2, k);
    for (std::size_t j = 0; j < grid.sites(1); ++j, ++row) {
      const double height = grid.site_extent(1, j);
      data.labels.for_each_run(
          row, grid.sites(0), [&](std::size_t begin, std::size_t end, std::uint16_t label) {
            double& sum = result[MaterialId(label)];
            sum = along.add(sum, begin, end, [&](double length) { return length * height * depth; });
          });
    }
  }
  return result;
}

/// "cell (1, 2, 3)", counted from 0.
std::string site_name(const RectilinearGrid& grid, std::size_t site) {
  const std::size_t nx = grid.sites(0), ny = grid.sites(1);
  return fmt::format("{} ({}, {}, {})", grid.centering == Centering::kCells ? "cell" : "point", site % nx,
                     site / nx % ny, site / (nx * ny));
}

/// A hint at what may be wrong with fractions that have this sum: their greatest value shows another scale,
/// such as 255 or percent.
std::string scale_hint(const Fractions& fractions) {
  float greatest = 0;
  for (const auto& values : fractions) {
    for (const float v : values) greatest = std::max(greatest, v);
  }
  if (greatest > 0.5f && greatest < 2) return {};
  return fmt::format("; values go up to {:.6g}: are they scaled?", greatest);
}

}  // namespace

void MultiMaterialData::check() const {
  check_nodes(source, grid);
  if (!labels.empty()) check_labels(*this);
  check_fractions(source, materials, fractions, !labels.empty(), grid.site_count());
  for (const Field& field : fields) check_field(source, field, grid.site_count());
}

void check_fractions(const std::string& source, const IdVector<MaterialId, std::string>& materials,
                     const Fractions& fractions, bool has_labels, std::size_t sites) {
  if (materials.empty()) fail("{}: expected at least one material, found none", source);
  if (!has_labels && fractions.size() != materials.size()) {
    fail("{}: expected volume fractions of {} materials, found {}", source, materials.size(),
         fractions.size());
  }
  for (MaterialId m(0); m.value < fractions.size(); ++m.value)
    check_array(source, materials[m], fractions[m], sites);
}

void check_field(const std::string& source, const Field& field, std::size_t sites) {
  const std::size_t expected = sites * static_cast<std::size_t>(field.components);
  const auto check = [&](const auto& values) { check_array(source, field.name, values, expected); };
  if (!field.per_material()) field.values.visit(check);
  for (const auto& values : field.material_values) {
    if (!values.empty()) values.visit(check);
  }
}

IdVector<MaterialId, double> MultiMaterialData::volumes() const {
  if (!labels.empty()) return volumes_of_labels(*this);
  IdVector<MaterialId, double> result(materials.size(), 0.0);
  std::size_t site = 0;
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i, ++site) {
        const double volume = grid.site_volume(i, j, k);
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
  report = normalise_fractions(
      source, materials, [this](std::size_t site) { return site_name(grid, site); }, fractions, tolerance);
}

FractionReport normalise_fractions(const std::string& source,
                                   const IdVector<MaterialId, std::string>& materials,
                                   const std::function<std::string(std::size_t)>& site_name,
                                   Fractions& fractions, double tolerance) {
  FractionReport report;
  const std::size_t count = fractions.empty() ? 0 : fractions[MaterialId(0)].size();
  bool first = true;
  const auto at = [&](MaterialId m, std::size_t site) { return std::as_const(fractions)[m][site]; };
  // Only values that change are written, since the array may be borrowed.
  const auto set = [&](MaterialId m, std::size_t site, float value) {
    if (std::bit_cast<std::uint32_t>(at(m, site)) != std::bit_cast<std::uint32_t>(value))
      fractions[m].own()[site] = value;
  };
  for (std::size_t site = 0; site < count; ++site) {
    double sum = 0;
    for (MaterialId m(0); m.value < fractions.size(); ++m.value) {
      const float f = at(m, site);
      if (!std::isfinite(f)) {
        fail("{}: volume fraction of '{}': expected a number in [0, 1], found {} in {}", source, materials[m],
             f, site_name(site));
      }
      sum += static_cast<double>(f);
      if (f < 0) ++report.negative;
      if (f > 0 && f < kFractionTrace) ++report.traces;
      if (f < kFractionTrace) set(m, site, 0);
    }
    report.sum_min = first ? sum : std::min(report.sum_min, sum);
    report.sum_max = first ? sum : std::max(report.sum_max, sum);
    first = false;
    if (!(std::abs(sum - 1) <= tolerance)) {
      fail("{}: volume fractions: expected a sum of 1 within {}, found {:.6g} in {}{}", source, tolerance,
           sum, site_name(site), scale_hint(fractions));
    }
    double kept = 0;
    MaterialId sole;
    for (MaterialId m(0); m.value < fractions.size(); ++m.value) {
      const float f = at(m, site);
      if (f > 0) sole = kept > 0 ? MaterialId() : m;
      kept += static_cast<double>(f);
    }
    if (!(kept > 0)) {
      fail("{}: volume fractions: expected a material, found none in {}", source, site_name(site));
    }
    if (std::abs(kept - 1) <= static_cast<double>(kFractionTrace)) {
      // A material that is left alone fills the cell: the others were traces.
      if (sole.valid()) set(sole, site, 1);
      continue;
    }
    if (std::abs(kept - 1) > kRoundOff) ++report.renormalised;
    for (MaterialId m(0); m.value < fractions.size(); ++m.value)
      set(m, site, static_cast<float>(static_cast<double>(at(m, site)) / kept));
  }
  return report;
}

}  // namespace adamas::inline core
