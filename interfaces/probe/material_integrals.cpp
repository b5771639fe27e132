#include "interfaces/probe/material_integrals.h"

#include <limits>

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kChunk = 2048;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

using Integrals = IdVector<MaterialId, MaterialIntegral>;

Integrals zeros(std::size_t materials, std::size_t values) {
  return Integrals(materials, {0, std::vector<double>(values, 0.0), std::vector<double>(values, kNothing)});
}

void add(Integrals& to, const Integrals& from) {
  for (MaterialId m(0); m.value < to.size(); ++m.value) {
    to[m].volume += from[m].volume;
    for (std::size_t c = 0; c < to[m].integral.size(); ++c) to[m].integral[c] += from[m].integral[c];
  }
}

void find_means(Integrals& integrals) {
  for (MaterialIntegral& i : integrals) {
    for (std::size_t c = 0; c < i.mean.size(); ++c)
      i.mean[c] = i.volume > 0 ? i.integral[c] / i.volume : kNothing;
  }
}

Weights centroid(const std::array<Weights, 4>& corners) {
  Weights w{};
  for (std::size_t i = 0; i < 4; ++i)
    w[i] = 0.25 * (corners[0][i] + corners[1][i] + corners[2][i] + corners[3][i]);
  return w;
}

/// The values of a field that a material has; null if it has none.
const FieldValues* values_of(const Field& field, MaterialId m) {
  if (!field.per_material()) return &field.values;
  const bool has = m.value < field.material_values.size() && !field.material_values[m].empty();
  return has ? &field.material_values[m] : nullptr;
}

}  // namespace

IdVector<MaterialId, MaterialIntegral> material_integrals(const ResampledMesh& mesh) {
  std::size_t values = 0;
  for (const FieldInfo& field : mesh.fields) values += static_cast<std::size_t>(field.components);
  std::vector<Integrals> partial((mesh.cells.size() + kChunk - 1) / kChunk);
  parallel_chunks(mesh.cells.size(), kChunk, [&](std::size_t first, std::size_t last) {
    Integrals& sums = partial[first / kChunk] = zeros(mesh.materials.size(), values);
    CellOwnership ownership;
    std::vector<OwnedTetrahedron> parts;
    const auto add_part = [&](std::size_t cell, std::uint32_t owner, const Weights& center, double volume) {
      MaterialIntegral& sum = sums[mesh.table.material(BodyId(owner))];
      sum.volume += volume;
      for (std::size_t c = 0; c < values; ++c)
        sum.integral[c] += volume * mesh.value(cell, BodyId(owner), c, center);
    };
    for (std::size_t cell = first; cell < last; ++cell) {
      const auto x = mesh.corners(cell);
      const double volume = signed_volume(x[0], x[1], x[2], x[3]);
      mesh.ownership(cell, ownership);
      partition_cell(ownership, parts);
      for (const OwnedTetrahedron& part : parts)
        add_part(cell, part.owner, centroid(part.corners), volume * volume_fraction(part.corners));
    }
  });
  Integrals integrals = zeros(mesh.materials.size(), values);
  for (const Integrals& sums : partial) add(integrals, sums);
  find_means(integrals);
  return integrals;
}

IdVector<MaterialId, MaterialIntegral> material_integrals(const SolverMesh& cut) {
  std::size_t values = 0;
  for (const NamedArray& field : cut.fields) values += static_cast<std::size_t>(field.components);
  Integrals integrals = zeros(cut.blocks.size(), values);
  for (std::size_t t = 0; t < cut.tetrahedra.size(); ++t) {
    const auto& v = cut.tetrahedra[t];
    MaterialIntegral& sum = integrals[MaterialId(cut.block[t])];
    const double volume =
        signed_volume(cut.points[v[0]], cut.points[v[1]], cut.points[v[2]], cut.points[v[3]]);
    sum.volume += volume;
    std::size_t row = 0;
    for (const NamedArray& field : cut.fields) {
      const auto& means = std::get<std::vector<double>>(field.values);
      const auto components = static_cast<std::size_t>(field.components);
      for (std::size_t c = 0; c < components; ++c, ++row)
        sum.integral[row] += volume * means[t * components + c];
    }
  }
  find_means(integrals);
  return integrals;
}

IdVector<MaterialId, MaterialIntegral> material_integrals(const MultiMaterialData& data) {
  std::size_t values = 0;
  for (const Field& field : data.fields) values += static_cast<std::size_t>(field.components);
  std::vector<Integrals> layers(data.grid.sites(2));
  parallel_for(layers.size(), 1, [&](std::size_t k) {
    Integrals& sums = layers[k] = zeros(data.materials.size(), values);
    const auto add_site = [&](std::size_t site, double site_volume) {
      for (MaterialId m(0); m.value < sums.size(); ++m.value) {
        const double volume = site_volume * static_cast<double>(data.fraction(m, site));
        if (volume == 0) continue;
        sums[m].volume += volume;
        std::size_t row = 0;
        for (const Field& field : data.fields) {
          const auto components = static_cast<std::size_t>(field.components);
          const FieldValues* given = values_of(field, m);
          for (std::size_t c = 0; c < components; ++c, ++row)
            sums[m].integral[row] += volume * (given != nullptr ? (*given)[site * components + c] : kNothing);
        }
      }
    };
    for (std::size_t j = 0; j < data.grid.sites(1); ++j) {
      for (std::size_t i = 0; i < data.grid.sites(0); ++i)
        add_site(data.grid.site_index(i, j, k), data.grid.site_volume(i, j, k));
    }
  });
  Integrals integrals = zeros(data.materials.size(), values);
  for (const Integrals& sums : layers) add(integrals, sums);
  find_means(integrals);
  return integrals;
}

IdVector<MaterialId, MaterialIntegral> material_integrals(const MeshData& data,
                                                          const IdVector<MaterialId, double>& volumes) {
  std::size_t values = 0;
  for (const MeshField& field : data.fields) values += static_cast<std::size_t>(field.components);
  Integrals integrals = zeros(data.materials.size(), values);
  for (std::size_t cell = 0; cell < data.mesh.cell_count(); ++cell) {
    const auto points = data.mesh.points_of_cell(cell);
    for (MaterialId m(0); m.value < integrals.size(); ++m.value) {
      const double volume = data.mesh.cell_volume(cell) * static_cast<double>(data.fraction(m, cell));
      if (volume == 0) continue;
      integrals[m].volume += volume;
      std::size_t row = 0;
      for (const MeshField& field : data.fields) {
        const auto components = static_cast<std::size_t>(field.components);
        const FieldValues* given = values_of(field, m);
        for (std::size_t c = 0; c < components; ++c, ++row) {
          double value = given != nullptr ? 0 : kNothing;
          if (given != nullptr && field.centering == Centering::kCells)
            value = (*given)[cell * components + c];
          if (given != nullptr && field.centering == Centering::kPoints) {
            for (const auto p : points) value += (*given)[p * components + c];
            value /= static_cast<double>(points.size());
          }
          integrals[m].integral[row] += volume * value;
        }
      }
    }
  }
  for (MaterialId m(integrals.size()); m.value < volumes.size(); ++m.value)
    integrals.push_back({volumes[m], std::vector(values, kNothing), std::vector(values, kNothing)});
  find_means(integrals);
  return integrals;
}

}  // namespace adamas::interfaces
