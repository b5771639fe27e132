#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
