#pragma once

#include "adamas/volume.h"
#include "core/geometry/vec3.h"
