#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "core/base/typed_id.h"
#include "core/data/field_values.h"
#include "core/data/label_array.h"
#include "core/data/site_array.h"

namespace adamas::inline core {

/// A field on the sites of a grid: scalar or vector, mixed (one value per site whatever the material) or with
/// values of its own for each material.
struct Field {
  std::string name;
  std::string unit;  ///< empty where the source states none
  int components = 1;
  /// The values of a mixed field: `values[site * components + c]`. Empty for a field per material.
  FieldValues values;
  /// The values of a field per material, each in the same layout; empty for a material without the field.
  IdVector<MaterialId, FieldValues> material_values;

  [[nodiscard]] bool per_material() const { return values.empty(); }
};

/// Smaller fractions are remains of mixing and rounding, and count as zero.
inline constexpr float kFractionTrace = 1e-6f;

/// What was found and corrected in volume fractions while they were read.
struct FractionReport {
  double sum_min = 1, sum_max = 1;  ///< range of the sums over materials, before normalisation
  std::size_t negative = 0;         ///< fractions below zero, set to zero
  std::size_t traces = 0;           ///< fractions too small to matter, set to zero
  std::size_t renormalised = 0;     ///< sites whose fractions did not add up to one, but for round-off
  double step = 0;  ///< difference of successive stored fractions; 0 where they are no integers
};

/// Volume fractions in [0, 1] per material and site: `fractions[m][site]`.
using Fractions = IdVector<MaterialId, SiteArray<float>>;

/// Sets negative fractions and traces to zero and scales each site to 1; returns what was found. Throws
/// Error, naming the source, at NaN, at sites whose fractions are all zero, and where sums are off by more
/// than `tolerance`. `site_name`: the name of a site in messages.
FractionReport normalise_fractions(const std::string& source,
                                   const IdVector<MaterialId, std::string>& materials,
                                   const std::function<std::string(std::size_t)>& site_name,
                                   Fractions& fractions, double tolerance = 0.05);

/// Throws Error, naming the source and the array, unless fractions, where there are any, are those of all
/// materials, have one finite value per site, and there is a material.
void check_fractions(const std::string& source, const IdVector<MaterialId, std::string>& materials,
                     const Fractions& fractions, bool has_labels, std::size_t sites);
/// Throws Error, naming the source and the array, unless all arrays of a field have a finite value per
/// component and site.
void check_field(const std::string& source, const Field& field, std::size_t sites);

/// Simulation data with several materials on a rectilinear grid: volume fractions per material and site, or a
/// label per site, and fields. Its arrays may be borrowed from an owner that outlives it.
struct MultiMaterialData {
  std::string source;  ///< the file or generator, for messages
  RectilinearGrid grid;
  IdVector<MaterialId, std::string> materials;
  /// `fractions[m][site]` in [0, 1], adding up to 1 at each site; empty where `labels` is given.
  Fractions fractions;
  /// Index of the one material at each site; empty where `fractions` is given.
  LabelArray labels;
  std::vector<Field> fields;
  FractionReport report;

  [[nodiscard]] float fraction(MaterialId m, std::size_t site) const {
    return labels.empty() ? fractions[m][site] : (labels[site] == m.value ? 1.0f : 0.0f);
  }
  /// Does what normalise_fractions() does, and fills `report`.
  void normalise(double tolerance = 0.05);
  /// The volume of each material, as the fractions or labels say, in the cube of the unit of length.
  [[nodiscard]] IdVector<MaterialId, double> volumes() const;

  /// Checks the data: throws Error that names the first array whose length is not that of the grid, a grid
  /// without volume, unsorted or non-finite nodes, non-finite field values, no material, labels beyond the
  /// materials or beside fractions.
  void check() const;
};

}  // namespace adamas::inline core
