#pragma once

#include <string>
#include <vector>

#include "adamas/probe.h"
#include "interfaces/probe/material_integrals.h"

namespace adamas::interfaces {

/// Returns the integrals with the names of the materials.
std::vector<MaterialTotals> to_totals(IdVector<MaterialId, MaterialIntegral>&& integrals,
                                      const IdVector<MaterialId, std::string>& materials);

}  // namespace adamas::interfaces
