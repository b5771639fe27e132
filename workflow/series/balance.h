#pragma once

#include <string>
#include <vector>

#include "adamas/resample_series.h"
#include "core/data/multi_material_data.h"
#include "interfaces/fields/field_source.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/probe/material_integrals.h"

namespace adamas::workflow {

/// Returns the field whose integral is mass: the one of that name or, for an empty name, one called density;
/// empty where there is none. Throws Error for a name that no field has, and for a vector.
std::string density_field(const std::string& name, const std::vector<interfaces::FieldInfo>& fields,
                          const std::string& source);

/// Returns names, units and ranges of fields.
std::vector<FieldRange> summarize(const std::vector<interfaces::FieldInfo>& fields);

/// Returns the volumes and masses in integrals of an input and of a mesh, by material. `mass_input` and
/// `mass_mesh`: the index of the density in the integrals; none: there are no masses.
std::vector<MaterialBalance> balance_of(const IdVector<MaterialId, std::string>& materials,
                                        const IdVector<MaterialId, interfaces::MaterialIntegral>& input,
                                        const IdVector<MaterialId, interfaces::MaterialIntegral>& mesh,
                                        std::optional<std::size_t> mass_input,
                                        std::optional<std::size_t> mass_mesh);

/// Returns the volumes and masses in data and in a mesh of them. `density`: the name of a scalar field;
/// empty: there are no masses.
std::vector<MaterialBalance> balance_of(const MultiMaterialData& data, const interfaces::ResampledMesh& mesh,
                                        const std::string& density);

}  // namespace adamas::workflow
