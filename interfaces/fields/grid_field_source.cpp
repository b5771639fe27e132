#include "interfaces/fields/grid_field_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"
#include "core/base/parallel.h"
#include "interfaces/fields/fitted_values.h"
#include "interfaces/fields/linear_fit.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas::interfaces {

namespace {

/// A site states a value of a field per material if the material's fraction is at least this.
constexpr float kPresent = 1e-3f;
/// A site states a value of a mixed field if the material's fraction is at least this, or if no neighbouring
/// site has a greater one.
constexpr float kPure = 0.99f;
/// The sites for a fit lie within this many steps.
constexpr std::int32_t kReach = 6;
/// A fit takes sites from the smallest window that has this many and extends along every axis.
constexpr std::size_t kWanted = 8;
/// Softening of the weights of a fit, in steps of the grid: the first one at a site, which may be the only
/// one, the second one at any other point, which may be arbitrarily close to a site.
constexpr double kSoftAtSites = 1e-6;
constexpr double kSoftElsewhere = 0.5;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
/// The number of sites per task.
constexpr std::size_t kChunk = 4096;

}  // namespace

struct GridFieldSource::Cell {
  Site low;
  std::array<double, 3> local;
  std::array<double, 3> size;
};

GridFieldSource::~GridFieldSource() = default;

GridFieldSource::GridFieldSource(const MultiMaterialData& data, const std::vector<MaterialId>& owners)
    : data_(data), cache_(std::make_unique<FittedValues>()) {
  for (int axis = 0; axis < 3; ++axis) {
    auto& x = coordinates_[static_cast<std::size_t>(axis)];
    const std::size_t n = data.grid.sites(axis);
    for (std::size_t i = 0; i < n; ++i) x.push_back(data.grid.site_coordinate(axis, i));
    const double step_low = n > 1 ? x[1] - x[0] : data.grid.domain().size()[axis];
    const double step_high = n > 1 ? x[n - 1] - x[n - 2] : step_low;
    x.insert(x.begin(), x.front() - step_low);
    x.push_back(x.back() + step_high);
  }
  for (const Field& field : data.fields) {
    fields_.push_back({field.name, field.unit, field.components, row_size_, 0, 0});
    row_size_ += static_cast<std::size_t>(field.components);
  }
  place_owners(owners);
  find_mixed_sites();
  find_stated_fields();
  find_ranges();
  place_minorities();
}

bool GridFieldSource::pure(std::size_t site) const {
  return data_.fractions.empty() || data_.fractions[MaterialId(owner_[site])][site] >= kPure;
}

bool GridFieldSource::inside(const Site& s) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (s[a] < 0 || s[a] >= sites(a)) return false;
  }
  return true;
}

Vec3 GridFieldSource::spacing(const Site& s) const {
  Vec3 result;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t low = std::min(s[a], sites(a) - 1);
    result[static_cast<int>(a)] = coordinate(a, low + 1) - coordinate(a, low);
  }
  return result;
}

std::size_t GridFieldSource::index(const Site& s) const {
  return data_.grid.site_index(static_cast<std::size_t>(s[0]), static_cast<std::size_t>(s[1]),
                               static_cast<std::size_t>(s[2]));
}

bool GridFieldSource::has_stated_value(std::size_t field, MaterialId material, std::size_t site) const {
  const Field& f = data_.fields[field];
  if (!f.per_material()) return mixed_stated_[site] != 0 && owner_[site] == material.value;
  if (material.value >= f.material_values.size() || f.material_values[material].empty()) return false;
  const bool fractions = data_.labels.empty() && !data_.fractions.empty();
  return fractions ? data_.fractions[material][site] >= kPresent : owner_[site] == material.value;
}

void GridFieldSource::find_mixed_sites() {
  mixed_stated_.assign(owner_.size(), 1);
  if (data_.fractions.empty()) return;
  const GridSites grid_sites(data_.grid);
  parallel_for(owner_.size(), kChunk, [&](std::size_t site) {
    const auto is_purer = [&](std::size_t other) { return owner_[other] == owner_[site] && pure(other); };
    if (!pure(site) && grid_sites.any_neighbour(site, is_purer)) mixed_stated_[site] = 0;
  });
}

void GridFieldSource::find_stated_fields() {
  stated_somewhere_.resize(fields_.size());
  parallel_for(fields_.size(), 1, [&](std::size_t f) {
    stated_somewhere_[f].assign(data_.materials.size(), 0);
    for (MaterialId m(0); m.value < data_.materials.size(); ++m.value) {
      for (std::size_t site = 0; site < owner_.size() && stated_somewhere_[f][m] == 0; ++site)
        stated_somewhere_[f][m] = has_stated_value(f, m, site) ? 1 : 0;
    }
  });
}

double GridFieldSource::stated_value(std::size_t field, MaterialId material, std::size_t site,
                                     int component) const {
  const Field& f = data_.fields[field];
  const auto& values = f.per_material() ? f.material_values[material] : f.values;
  return values[site * static_cast<std::size_t>(f.components) + static_cast<std::size_t>(component)];
}

void GridFieldSource::native_values(const NativeElement& element, std::span<double> row) const {
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const bool known = data_.fields[f].per_material() ? has_stated_value(f, element.material, element.site)
                                                      : element.kind != ElementKind::kMinority;
    for (int c = 0; c < fields_[f].components; ++c) {
      row[fields_[f].offset + static_cast<std::size_t>(c)] =
          known ? stated_value(f, element.material, element.site, c) : kNothing;
    }
  }
}

void GridFieldSource::site_values(std::size_t field, MaterialId material, const Site& site,
                                  std::span<double> out) const {
  if (inside(site) && has_stated_value(field, material, index(site))) {
    for (int c = 0; c < fields_[field].components; ++c)
      out[static_cast<std::size_t>(c)] = stated_value(field, material, index(site), c);
    return;
  }
  std::uint64_t key = material.value * fields_.size() + field;
  for (std::size_t a = 0; a < 3; ++a)
    key = key * static_cast<std::uint64_t>(sites(a) + 2) + static_cast<std::uint64_t>(site[a] + 1);
  const auto components = static_cast<std::size_t>(fields_[field].components);
  cache_->find(key, out.subspan(0, components),
               [&](std::span<double> found) { fit(field, material, site, found); });
}

/// Sites that state values, with their offsets from a place where none is stated.
struct GridFieldSource::Sample {
  Vec3 origin;
  std::vector<Vec3> offsets{};
  std::vector<double> values{};
  std::array<Site, 2> extent{Site{1 << 30, 1 << 30, 1 << 30}, Site{-1, -1, -1}};
};

template <class States>
void GridFieldSource::add_shell(std::size_t field, MaterialId material, const Site& site, std::int32_t reach,
                                const States& states, Sample& sample) const {
  for (std::int32_t dk = -reach; dk <= reach; ++dk) {
    for (std::int32_t dj = -reach; dj <= reach; ++dj) {
      const bool face = std::abs(dk) == reach || std::abs(dj) == reach;
      for (std::int32_t di = -reach; di <= reach; di += face ? 1 : 2 * reach) {
        const Site other{site[0] + di, site[1] + dj, site[2] + dk};
        if (!inside(other) || !states(index(other))) continue;
        sample.offsets.push_back(site_position(other) - sample.origin);
        for (int c = 0; c < fields_[field].components; ++c)
          sample.values.push_back(stated_value(field, material, index(other), c));
        for (std::size_t a = 0; a < 3; ++a) {
          sample.extent[0][a] = std::min(sample.extent[0][a], other[a]);
          sample.extent[1][a] = std::max(sample.extent[1][a], other[a]);
        }
      }
    }
  }
}

void GridFieldSource::collect(std::size_t field, MaterialId material, const Site& site, std::int32_t least,
                              Sample& sample) const {
  // A slope along an axis needs sites at two positions along it.
  const auto enough = [&] {
    if (sample.offsets.size() < kWanted) return false;
    for (std::size_t a = 0; a < 3; ++a) {
      if (sites(a) > 1 && sample.extent[0][a] == sample.extent[1][a]) return false;
    }
    return true;
  };
  const auto add_shells = [&](const auto& states) {
    for (std::int32_t reach = 0; reach <= kReach && (reach <= least || !enough()); ++reach)
      add_shell(field, material, site, reach, states, sample);
  };
  const auto own = [&](std::size_t other) { return has_stated_value(field, material, other); };
  add_shells(own);
  // In a layer thinner than the cells, sites with some of the material are used for a mixed field.
  const bool mixed = !data_.fields[field].per_material();
  if (sample.offsets.empty() && mixed && !data_.fractions.empty())
    add_shells([&](std::size_t other) { return data_.fractions[material][other] >= kPresent; });
  // Far from all sites of the material, the nearest site is used.
  if (sample.offsets.empty() && stated_somewhere_[field][material] != 0) {
    const std::int32_t farthest = std::max({sites(0), sites(1), sites(2)});
    for (std::int32_t reach = kReach + 1; reach <= farthest && sample.offsets.empty(); ++reach)
      add_shell(field, material, site, reach, own, sample);
  }
}

void GridFieldSource::fit(std::size_t field, MaterialId material, const Site& site,
                          std::span<double> out) const {
  Sample sample{site_position(site)};
  collect(field, material, site, 0, sample);
  const auto components = static_cast<std::size_t>(fields_[field].components);
  const Vec3 h = spacing(site);
  fit_linear_at_origin(sample.offsets, sample.values, components, kSoftAtSites * std::min({h.x, h.y, h.z}),
                       out.subspan(0, components));
}

void GridFieldSource::fitted_values(MaterialId material, const Vec3& p, const Vec3& near,
                                    std::span<double> row) const {
  const Site site = nearest_site(near);
  const Vec3 h = spacing(site);
  const double steps = norm(p - near) / std::max({h.x, h.y, h.z});
  const auto least = static_cast<std::int32_t>(std::min<double>(steps, kReach));
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    Sample sample{p};
    collect(f, material, site, least, sample);
    const auto components = static_cast<std::size_t>(fields_[f].components);
    fit_linear_at_origin(sample.offsets, sample.values, components,
                         kSoftElsewhere * std::min({h.x, h.y, h.z}),
                         row.subspan(fields_[f].offset, components));
  }
}

GridFieldSource::Cell GridFieldSource::locate(const Vec3& p) const {
  Cell cell{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& x = coordinates_[a];
    const double q = std::clamp(p[static_cast<int>(a)], x.front(), x.back());
    const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, q);
    const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
    cell.low[a] = static_cast<std::int32_t>(i) - 1;
    cell.size[a] = x[i + 1] - x[i];
    cell.local[a] = (q - x[i]) / cell.size[a];
  }
  return cell;
}

GridFieldSource::Site GridFieldSource::nearest_site(const Vec3& p) const {
  const Cell cell = locate(p);
  Site site{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t i = cell.low[a] + (cell.local[a] < 0.5 ? 0 : 1);
    site[a] = std::clamp(i, 0, sites(a) - 1);
  }
  return site;
}

void GridFieldSource::values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                                           std::span<Vec3> gradients) const {
  const Cell cell = locate(p);
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const auto components = static_cast<std::size_t>(fields_[f].components);
    std::array<double, 8> weight{};
    std::array<Vec3, 8> slope;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      std::array<double, 3> w{}, d{};
      for (std::size_t a = 0; a < 3; ++a) {
        const bool high = (corner >> a & 1u) != 0;
        w[a] = high ? cell.local[a] : 1 - cell.local[a];
        d[a] = (high ? 1 : -1) / cell.size[a];
      }
      weight[corner] = w[0] * w[1] * w[2];
      slope[corner] = {d[0] * w[1] * w[2], w[0] * d[1] * w[2], w[0] * w[1] * d[2]};
    }
    std::vector<double> at(components);
    for (std::size_t c = 0; c < components; ++c) {
      row[fields_[f].offset + c] = 0;
      if (!gradients.empty()) gradients[fields_[f].offset + c] = {};
    }
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if (weight[corner] == 0 && gradients.empty()) continue;
      Site site = cell.low;
      for (std::size_t a = 0; a < 3; ++a) site[a] += static_cast<std::int32_t>(corner >> a & 1u);
      site_values(f, material, site, at);
      for (std::size_t c = 0; c < components; ++c) {
        row[fields_[f].offset + c] += weight[corner] * at[c];
        if (!gradients.empty()) gradients[fields_[f].offset + c] += at[c] * slope[corner];
      }
    }
  }
}

void GridFieldSource::values(MaterialId material, const Vec3& p, std::span<double> row) const {
  values_and_gradients(material, p, row, {});
}

void GridFieldSource::place_owners(const std::vector<MaterialId>& owners) {
  const GridSites grid_sites(data_.grid);
  elements_.resize(data_.grid.site_count());
  ADAMAS_ASSERT(owners.size() == elements_.size());
  owner_.resize(elements_.size());
  parallel_for(elements_.size(), kChunk, [&](std::size_t site) {
    owner_[site] = static_cast<std::uint16_t>(owners[site].value);
    const ElementKind kind = pure(site) ? ElementKind::kPure : ElementKind::kMixed;
    elements_[site] = {grid_sites.position(site), owners[site], kind, site};
  });
}

void GridFieldSource::place_minorities() {
  if (data_.fractions.empty()) return;
  for (std::size_t site = 0; site < owner_.size(); ++site) {
    for (MaterialId m(0); m.value < data_.materials.size(); ++m.value) {
      bool any = false;
      for (std::size_t f = 0; f < fields_.size() && owner_[site] != m.value && !any; ++f)
        any = data_.fields[f].per_material() && has_stated_value(f, m, site);
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
