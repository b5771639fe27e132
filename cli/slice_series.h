#pragma once

#include "cli/slice_steps.h"

namespace adamas::cli {

/// Cuts the steps of a series: a picture or polygons of each, or a film, with one scale of colours and one
/// legend over all of them. Throws Error.
void slice_series(const SliceRequest& request, const SliceSteps& steps, Session& session);

}  // namespace adamas::cli
