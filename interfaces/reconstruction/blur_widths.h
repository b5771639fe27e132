#pragma once

#include <optional>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// Sets the widths of blurred entries. `blur`: the standard deviation, in cells, by which all fractions are
/// blurred, 0 for sharp ones; without it, widths are estimated from the fractions.
void find_widths(const MultiMaterialData& data, std::optional<double> blur, SiteValues& values);

/// Makes a blurred cell sharp if most of the mixed cells round it are sharp, and the reverse; makes all cells
/// sharp if few are blurred.
void settle_widths(const MultiMaterialData& data, const ThinSheets& sheets, SiteValues& values);
/// Sets the figures of `findings` about the widths of mixed cells.
void summarise_widths(const MultiMaterialData& data, const SiteValues& values, FractionFindings& findings);

}  // namespace adamas::interfaces
