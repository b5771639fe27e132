#pragma once

#include <optional>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// How far fractions are to be trusted, as a standard deviation (docs/blurred_fractions.md, Errors of
/// fractions): each mixed cell is left out and told from a smooth surface through its neighbours' distances.
/// The scaled median of what is off is the noise. Cells at thin sheets, where there are two surfaces, are
/// left out, here and below; where there are too few others to say the noise is that at blurred sheets.
double fraction_noise(const MultiMaterialData& data, const SiteValues& values, const ThinSheets& sheets);

/// Smooths values and fractions of mixed entries by surfaces through their neighbours', as far as the noise
/// allows: what is off by far more than the noise stays.
void smooth_within_noise(const MultiMaterialData& data, const ThinSheets& sheets, double noise,
                         SiteValues& values);

}  // namespace adamas::interfaces
