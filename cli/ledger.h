#pragma once

#include <string>
#include <vector>

#include "cli/figures.h"
#include "interfaces/probe/material_integrals.h"
#include "interfaces/source/field_source.h"

namespace adamas {

/// Volumes of the materials and integrals of their fields, in the input or in a mesh: of a density that is
/// mass.
struct Ledger {
  std::string of;  ///< what it is of: "input", "mesh", "cut mesh"
  IdVector<MaterialId, MaterialIntegral> materials;
};

/// Volumes alone, where there are no fields.
Ledger volume_ledger(const std::string& of, const IdVector<MaterialId, double>& volumes);

/// For `--json`: a row per ledger and material.
Figures ledger_figures(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<FieldInfo>& fields);
/// The same as CSV; what a material has not is left empty.
std::string ledger_csv(const std::vector<Ledger>& ledgers, const IdVector<MaterialId, std::string>& materials,
                       const std::vector<FieldInfo>& fields);

}  // namespace adamas
