#pragma once

#include "adamas/progress.h"
#include "adamas/resample.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Returns the errors of a field of a mesh, without a target.
ResampleReport::Field field_report(const FieldInfo& field, const FieldFigures& errors);
/// Returns the materials of a source with their volumes in the input and in a mesh.
std::vector<ResampleReport::Material> material_reports(const ResamplingSource& source,
                                                       const IdVector<MaterialId, double>& volumes);
/// Measures the results of a resampler that has refined.
ResampleReport report_of(const Resampler& resampler, const Progress& progress);

}  // namespace adamas::interfaces
