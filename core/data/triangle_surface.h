#pragma once

#include "adamas/meshes.h"
#include "core/geometry/vec3.h"
