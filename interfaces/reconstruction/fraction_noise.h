#pragma once

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// Estimates the noise, the standard deviation of errors of fractions (docs/blurred_fractions.md, Errors of
/// fractions): each mixed cell is predicted from a smooth surface through its neighbours' distances, and the
/// scaled median of the differences is the noise. Cells at thin sheets, which have two surfaces, do not
/// count, here and below; if there are too few others, the noise is that at blurred sheets.
double fraction_noise(const MultiMaterialData& data, const SiteValues& values, const ThinSheets& sheets);

/// Smooths values and fractions of mixed entries by surfaces through their neighbours, as far as the noise
/// allows: entries whose differences are far greater than the noise do not change.
void smooth_within_noise(const MultiMaterialData& data, const ThinSheets& sheets, double noise,
                         SiteValues& values);

}  // namespace adamas::interfaces
