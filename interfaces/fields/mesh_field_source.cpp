#include "interfaces/fields/mesh_field_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/fields/fitted_values.h"
#include "interfaces/fields/linear_fit.h"

namespace adamas::interfaces {

namespace {

/// A cell states a value of a field per material if the material's fraction is at least this.
constexpr float kPresent = 1e-3f;
/// A cell states a value of a mixed field if its owner's fraction is at least this, or if no cell round it
/// with the same owner has so much.
constexpr float kPure = 0.99f;
/// A fit takes the sites within so many rings of cells as hold this many and extend along every axis, but at
/// most kReach if there are any.
constexpr std::size_t kWanted = 8;
constexpr int kReach = 6;
/// Softening of the weights of a fit, in sizes of cells: the first one at a site, which may be the only one,
/// the second one at any other place, which may be arbitrarily close to a site.
constexpr double kSoftAtSites = 1e-6;
constexpr double kSoftElsewhere = 0.5;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kChunk = 1024;

}  // namespace

/// Sites that state values, with their offsets from a place where none is stated.
struct MeshFieldSource::Sample {
  Vec3 origin;
  std::vector<Vec3> offsets{};
  std::vector<double> values{};
  Box3 extent{};
};

MeshFieldSource::~MeshFieldSource() = default;

MeshFieldSource::MeshFieldSource(const MeshData& data,
                                 const std::function<MaterialId(const Vec3&)>& material_at)
    : data_(data), subdivision_(data.mesh), locator_(subdivision_), cache_(std::make_unique<FittedValues>()) {
  const PolyhedralMesh& mesh = data.mesh;
  Box3 centers;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) centers.extend(mesh.cell_center(c));
  for (int axis = 0; axis < 3; ++axis)
    extends_[static_cast<std::size_t>(axis)] = centers.size()[axis] > 1e-9 * mesh.box().diagonal();
  for (const MeshField& field : data.fields) {
    fields_.push_back({field.name, field.unit, field.components, row_size_, 0, 0});
    row_size_ += static_cast<std::size_t>(field.components);
  }
  find_owners(material_at);
  find_stated_fields();
  find_ranges();
}

bool MeshFieldSource::belongs(std::size_t field, std::size_t site) const {
  return is_cell(site) == (data_.fields[field].centering == Centering::kCells);
}

Vec3 MeshFieldSource::site_position(std::size_t site) const {
  return is_cell(site) ? data_.mesh.cell_center(site) : data_.mesh.points()[index_in_field(site)];
}

/// Finds the owners of sites, and the native elements: the sites of fields.
void MeshFieldSource::find_owners(const std::function<MaterialId(const Vec3&)>& material_at) {
  const PolyhedralMesh& mesh = data_.mesh;
  const std::size_t cells = mesh.cell_count();
  const auto is_on = [&](Centering centering) {
    return std::ranges::any_of(data_.fields, [&](const MeshField& f) { return f.centering == centering; });
  };
  const bool on_cells = is_on(Centering::kCells), on_points = is_on(Centering::kPoints);
  owner_.assign(cells + mesh.points().size(), 0);
  parallel_for(owner_.size(), kChunk, [&](std::size_t site) {
    if (!is_cell(site) && (!on_points || mesh.cells_round(index_in_field(site)).empty())) return;
    if (is_cell(site) && !data_.labels.empty()) {
      owner_[site] = data_.labels[site];
    } else {
      owner_[site] = static_cast<std::uint16_t>(material_at(site_position(site)).value);
    }
  });
  const auto fraction = [&](std::size_t c, std::uint16_t m) {
    return m < data_.materials.size() ? data_.fraction(MaterialId(m), c) : 0.0f;
  };
  mixed_stated_.assign(cells, 1);
  parallel_for(cells, kChunk, [&](std::size_t c) {
    if (fraction(c, owner_[c]) >= kPure) return;
    for (const Index p : mesh.points_of_cell(c)) {
      for (const Index other : mesh.cells_round(p)) {
        if (owner_[other] == owner_[c] && fraction(other, owner_[c]) >= kPure) mixed_stated_[c] = 0;
      }
    }
  });
  for (std::size_t c = 0; on_cells && c < cells; ++c) {
    const ElementKind kind = fraction(c, owner_[c]) >= kPure ? ElementKind::kPure : ElementKind::kMixed;
    elements_.push_back({mesh.cell_center(c), MaterialId(owner_[c]), kind, c});
  }
  for (std::size_t p = 0; on_points && p < mesh.points().size(); ++p) {
    const std::span<const Index> round = mesh.cells_round(p);
    if (round.empty()) continue;
    const std::uint16_t owner = owner_[cells + p];
    // A point at the boundary that is found outside stands for no material.
    if (owner >= data_.materials.size()) continue;
    const bool pure = std::ranges::all_of(round, [&](Index c) { return fraction(c, owner) >= kPure; });
    elements_.push_back(
        {mesh.points()[p], MaterialId(owner), pure ? ElementKind::kPure : ElementKind::kMixed, cells + p});
  }
  for (std::size_t c = 0; on_cells && data_.labels.empty() && c < cells; ++c) {
    for (MaterialId m(0); m.value < data_.materials.size(); ++m.value) {
      bool any = false;
      for (std::size_t f = 0; f < fields_.size() && owner_[c] != m.value && !any; ++f)
        any = data_.fields[f].per_material() && states(f, m, c);
      if (any) elements_.push_back({mesh.cell_center(c), m, ElementKind::kMinority, c});
    }
  }
}

/// Finds the materials of which a field has any value: stated, or at cells with a part of them.
void MeshFieldSource::find_stated_fields() {
  stated_somewhere_.assign(fields_.size(), std::vector<char>(data_.materials.size(), 0));
  parallel_for(fields_.size(), 1, [&](std::size_t f) {
    for (MaterialId m(0); m.value < data_.materials.size(); ++m.value) {
      const bool any_part = !data_.fields[f].per_material() && data_.labels.empty();
      for (std::size_t site = 0; site < owner_.size() && stated_somewhere_[f][m.value] == 0; ++site) {
        const bool part =
            any_part && is_cell(site) && belongs(f, site) && data_.fractions[m][site] >= kPresent;
        stated_somewhere_[f][m.value] = part || states(f, m, site) ? 1 : 0;
      }
    }
  });
}

bool MeshFieldSource::states(std::size_t field, MaterialId material, std::size_t site) const {
  const MeshField& f = data_.fields[field];
  if (!belongs(field, site) || material.value >= data_.materials.size()) return false;
  if (f.per_material() && f.material_values[material].empty()) return false;
  if (is_cell(site)) {
    if (f.per_material() && data_.labels.empty()) return data_.fractions[material][site] >= kPresent;
    return mixed_stated_[site] != 0 && owner_[site] == material.value;
  }
  const std::span<const Index> round = data_.mesh.cells_round(index_in_field(site));
  if (!data_.labels.empty())
    return std::ranges::any_of(round, [&](Index c) { return data_.labels[c] == material.value; });
  return !round.empty() && owner_[site] == material.value;
}

double MeshFieldSource::stated(std::size_t field, MaterialId material, std::size_t site,
                               std::size_t c) const {
  const MeshField& f = data_.fields[field];
  const FieldValues& values = f.per_material() ? f.material_values[material] : f.values;
  return values[index_in_field(site) * static_cast<std::size_t>(f.components) + c];
}

void MeshFieldSource::native_values(const NativeElement& element, std::span<double> row) const {
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const bool known = belongs(f, element.site) &&
                       (data_.fields[f].per_material() ? states(f, element.material, element.site)
                                                       : element.kind != ElementKind::kMinority);
    for (std::size_t c = 0; c < static_cast<std::size_t>(fields_[f].components); ++c)
      row[fields_[f].offset + c] = known ? stated(f, element.material, element.site, c) : kNothing;
  }
}

bool MeshFieldSource::interpolates(const NativeElement& element, std::size_t field) const {
  return states(field, element.material, element.site);
}

/// Adds the sites of a field that belong to cells which are not known yet; returns whether there are enough.
bool MeshFieldSource::add_sites(std::size_t field, MaterialId material, std::span<const Index> cells,
                                const std::vector<char>& known, bool any_part, Sample& sample) const {
  const auto components = static_cast<std::size_t>(fields_[field].components);
  const auto add = [&](std::size_t site) {
    const bool part = any_part && is_cell(site) && data_.fractions[material][site] >= kPresent;
    if (!part && !states(field, material, site)) return;
    sample.offsets.push_back(site_position(site) - sample.origin);
    sample.extent.extend(site_position(site));
    for (std::size_t c = 0; c < components; ++c) sample.values.push_back(stated(field, material, site, c));
  };
  if (data_.fields[field].centering == Centering::kCells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (known[i] == 0) add(cells[i]);
    }
  } else {
    std::vector<Index> points, before;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::span<const Index> own = data_.mesh.points_of_cell(cells[i]);
      std::vector<Index>& list = known[i] == 0 ? points : before;
      list.insert(list.end(), own.begin(), own.end());
    }
    sort_unique(points);
    sort_unique(before);
    for (const Index p : points) {
      if (!std::ranges::binary_search(before, p)) add(data_.mesh.cell_count() + p);
    }
  }
  if (sample.offsets.size() < kWanted) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (extends_[static_cast<std::size_t>(axis)] && !(sample.extent.size()[axis] > 0)) return false;
  }
  return true;
}

/// Collects the values stated within `least` rings of cells round one, or within as many more as a fit needs.
void MeshFieldSource::collect(std::size_t field, MaterialId material, Index cell, int least,
                              Sample& sample) const {
  if (material.value >= data_.materials.size() || !stated_somewhere_[field][material.value]) return;
  const bool mixed = !data_.fields[field].per_material() && data_.labels.empty();
  for (const bool any_part : {false, true}) {
    if (any_part && !mixed) return;
    std::vector<Index> cells{cell}, wider;
    std::vector<char> known{0};
    for (int ring = 0;; ++ring) {
      const bool enough = add_sites(field, material, cells, known, any_part, sample);
      const bool far = ring >= kReach && (any_part || !sample.offsets.empty());
      if ((ring >= least && enough) || far) break;
      subdivision_.find_ring(cells, wider);
      // All cells that can be reached are known.
      if (wider.size() == cells.size()) break;
      known.assign(wider.size(), 0);
      for (std::size_t i = 0, n = 0; i < wider.size(); ++i) {
        if (n < cells.size() && cells[n] == wider[i]) known[i] = 1, ++n;
      }
      cells.swap(wider);
    }
    if (!sample.offsets.empty()) return;
  }
}

void MeshFieldSource::point_values(std::size_t field, MaterialId material, Index point,
                                   std::span<double> out) const {
  const PolyhedralMesh& mesh = data_.mesh;
  const auto components = static_cast<std::size_t>(fields_[field].components);
  const auto points = static_cast<Index>(mesh.points().size());
  const bool on_cells = data_.fields[field].centering == Centering::kCells;
  const Index first_center = subdivision_.cell_center(0);
  // The values of fields of points at centres are means.
  if (!on_cells && point >= points) {
    std::vector<double> one(components);
    std::ranges::fill(out, 0.0);
    const std::span<const Index> round =
        point >= first_center ? mesh.points_of_cell(point - first_center) : mesh.face(point - points);
    for (const Index p : round) {
      point_values(field, material, p, one);
      for (std::size_t c = 0; c < components; ++c) out[c] += one[c] / static_cast<double>(round.size());
    }
    return;
  }
  const bool at_site = on_cells ? point >= first_center : point < points;
  const std::size_t site = on_cells ? point - first_center : mesh.cell_count() + point;
  if (at_site && states(field, material, site)) {
    for (std::size_t c = 0; c < components; ++c) out[c] = stated(field, material, site, c);
    return;
  }
  const std::uint64_t key =
      (std::uint64_t{point} * data_.materials.size() + material.value) * fields_.size() + field;
  cache_->find(key, out.subspan(0, components), [&](std::span<double> found) {
    // The cell from which sites are collected must depend on the point alone.
    const Index from = point >= first_center ? point - first_center
                       : point >= points     ? mesh.cells_of_face(point - points)[0]
                                             : mesh.cells_round(point)[0];
    Sample sample{subdivision_.position(point)};
    collect(field, material, from, 1, sample);
    const double size = std::cbrt(std::abs(mesh.cell_volume(from)));
    fit_linear_at_origin(sample.offsets, sample.values, components, kSoftAtSites * size, found);
  });
}

void MeshFieldSource::values_and_gradients(MaterialId material, const Vec3& p, std::span<double> row,
                                           std::span<Vec3> gradients) const {
  const MeshLocator::Location at = locator_.locate(p);
  std::array<Vec3, 4> x, slopes;
  for (std::size_t i = 0; i < 4; ++i) x[i] = subdivision_.position(at.corners[i]);
  const double volume = 6 * signed_volume(x[0], x[1], x[2], x[3]);
  slopes[0] = (-1 / volume) * cross(x[2] - x[1], x[3] - x[1]);
  slopes[1] = (1 / volume) * cross(x[2] - x[0], x[3] - x[0]);
  slopes[2] = (-1 / volume) * cross(x[1] - x[0], x[3] - x[0]);
  slopes[3] = (1 / volume) * cross(x[1] - x[0], x[2] - x[0]);
  std::vector<double> one;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const auto components = static_cast<std::size_t>(fields_[f].components);
    one.resize(components);
    for (std::size_t c = 0; c < components; ++c) {
      row[fields_[f].offset + c] = 0;
      if (!gradients.empty()) gradients[fields_[f].offset + c] = {};
    }
    for (std::size_t i = 0; i < 4; ++i) {
      point_values(f, material, at.corners[i], one);
      for (std::size_t c = 0; c < components; ++c) {
        row[fields_[f].offset + c] += at.weights[i] * one[c];
        if (!gradients.empty()) gradients[fields_[f].offset + c] += one[c] * slopes[i];
      }
    }
  }
}

void MeshFieldSource::values(MaterialId material, const Vec3& p, std::span<double> row) const {
  values_and_gradients(material, p, row, {});
}

void MeshFieldSource::fitted_values(MaterialId material, const Vec3& p, const Vec3& near,
                                    std::span<double> row) const {
  const Index cell = locator_.locate(near).cell;
  const double size = std::cbrt(std::abs(data_.mesh.cell_volume(cell)));
  const int least = static_cast<int>(std::min<double>(norm(p - near) / size, kReach));
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    Sample sample{p};
    collect(f, material, cell, std::max(least, 1), sample);
    const auto components = static_cast<std::size_t>(fields_[f].components);
    fit_linear_at_origin(sample.offsets, sample.values, components, kSoftElsewhere * size,
                         row.subspan(fields_[f].offset, components));
  }
}

void MeshFieldSource::find_ranges() {
  std::vector<double> row(row_size_);
  std::vector<std::array<double, 2>> ranges(
      fields_.size(), {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  for (const NativeElement& element : elements_) {
    if (element.kind == ElementKind::kMinority) continue;
    native_values(element, row);
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const FieldInfo& info = fields_[f];
      double value = row[info.offset];
      if (info.components > 1) {
        value = 0;
        for (std::size_t c = 0; c < static_cast<std::size_t>(info.components); ++c)
          value = std::hypot(value, row[info.offset + c]);
      }
      if (std::isnan(value)) continue;
      ranges[f][0] = std::min(ranges[f][0], value);
      ranges[f][1] = std::max(ranges[f][1], value);
    }
  }
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (ranges[f][0] <= ranges[f][1]) fields_[f].min = ranges[f][0], fields_[f].max = ranges[f][1];
  }
}

}  // namespace adamas::interfaces
