#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"
#include "core/base/parallel.h"
#include "interfaces/source/grid_field_source.h"

namespace adamas::interfaces {

void GridFieldSource::place_owners(const std::vector<MaterialId>& owners) {
  const RectilinearGrid& grid = data_.grid;
  elements_.resize(grid.site_count());
  ADAMAS_ASSERT(owners.size() == elements_.size());
  owner_.resize(elements_.size());
  parallel_for(grid.sites(2), 1, [&](std::size_t k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i) {
        const std::size_t site = grid.site_index(i, j, k);
        owner_[site] = static_cast<std::uint16_t>(owners[site].value);
        const ElementKind kind = pure(site) ? ElementKind::kPure : ElementKind::kMixed;
        elements_[site] = {grid.site(i, j, k), owners[site], kind, site};
      }
    }
  });
}

void GridFieldSource::place_minorities() {
  if (data_.fractions.empty()) return;
  for (std::size_t site = 0; site < owner_.size(); ++site) {
    for (MaterialId m(0); m.value < data_.materials.size(); ++m.value) {
      bool any = false;
      for (std::size_t f = 0; f < fields_.size() && owner_[site] != m.value && !any; ++f)
        any = data_.fields[f].per_material() && states(f, m, site);
      if (any) elements_.push_back({elements_[site].position, m, ElementKind::kMinority, site});
    }
  }
}

void GridFieldSource::find_ranges() {
  struct Range {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();
  };
  const auto layers = static_cast<std::size_t>(sites(2));
  const std::size_t layer_size = elements_.size() / layers;
  std::vector<Range> ranges(layers * fields_.size());
  parallel_for(layers, 1, [&](std::size_t layer) {
    std::vector<double> row(row_size_);
    for (std::size_t site = layer * layer_size; site < (layer + 1) * layer_size; ++site) {
      native_values(elements_[site], row);
      for (std::size_t f = 0; f < fields_.size(); ++f) {
        const FieldInfo& info = fields_[f];
        double value = row[info.offset];
        if (info.components > 1) {
          value = 0;
          for (std::size_t c = 0; c < static_cast<std::size_t>(info.components); ++c)
            value = std::hypot(value, row[info.offset + c]);
        }
        if (std::isnan(value)) continue;
        Range& range = ranges[layer * fields_.size() + f];
        range.min = std::min(range.min, value);
        range.max = std::max(range.max, value);
      }
    }
  });
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    Range all;
    for (std::size_t layer = 0; layer < layers; ++layer) {
      all.min = std::min(all.min, ranges[layer * fields_.size() + f].min);
      all.max = std::max(all.max, ranges[layer * fields_.size() + f].max);
    }
    if (all.min <= all.max) fields_[f].min = all.min, fields_[f].max = all.max;
  }
}

}  // namespace adamas::interfaces
