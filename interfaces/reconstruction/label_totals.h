#pragma once

#include <cstdint>

#include "adamas/progress.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/label_lattice.h"

namespace adamas::interfaces {

/// Moves the values of materials of a lattice of labels by one offset each, by Newton's method as
/// close_totals() does, until each material has the volume that is wanted, that of its sites. Returns the
/// volumes that materials own then. The sums are over the tetrahedra of the lattice; of tetrahedra whose
/// volumes depend on the owners of their corners alone, one of each kind is measured. The result does not
/// depend on the number of threads.
IdVector<MaterialId, double> close_label_totals(const MultiMaterialData& data,
                                                const IdVector<MaterialId, double>& wanted,
                                                LabelLattice& lattice, Progress& progress);

}  // namespace adamas::interfaces
