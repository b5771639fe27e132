#pragma once

#include "adamas/simplify.h"
#include "interfaces/simplification/interface_simplification.h"

namespace adamas::interfaces {

/// Simplifies the interfaces of a source within the error of the options, which must be set, and reports
/// progress.
SimplifiedNetwork simplify_source(const ResamplingSource& source, const SimplifyOptions& options,
                                  SimplificationReport& report, Progress& progress);

}  // namespace adamas::interfaces
