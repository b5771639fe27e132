#pragma once

// The version of these headers; the build reads it from here.
#define ADAMAS_VERSION_MAJOR 0
#define ADAMAS_VERSION_MINOR 1
#define ADAMAS_VERSION_PATCH 0

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Returns the version of the linked library, as "0.1.0".
const char* version();

}  // namespace adamas
