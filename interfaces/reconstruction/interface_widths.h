#pragma once

#include <optional>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// Finds the widths of the entries of a material's fractions and sets those that are blurred. `blur`: the
/// standard deviation in cells by which all are blurred, 0 for none; without it, widths are read off the
/// fractions.
void find_widths(const MultiMaterialData& data, std::optional<double> blur, SiteValues& values);

/// Makes cells that seem blurred sharp, and the other way round, where most of the mixed cells round them
/// are, and all sharp where few seem blurred.
void settle_widths(const MultiMaterialData& data, const ThinSheets& sheets, SiteValues& values);
/// Tells of the widths of mixed cells.
void summarise_widths(const MultiMaterialData& data, const SiteValues& values, FractionFindings& findings);

}  // namespace adamas::interfaces
