#pragma once

#include "adamas/grid_data.h"
#include "core/geometry/vec3.h"
