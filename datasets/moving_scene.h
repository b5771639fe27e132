#pragma once

#include "datasets/scene.h"

namespace adamas::datasets {

/// Bodies in a "surrounding" that move and change as `time` goes from 0 to 1: a "left drop" and a "right
/// drop" that come together and press a flat disc between them, a "bubble" that goes round and grows, and a
/// "pool" that rises. Volumes are known exactly at any time.
SceneDescription moving_scene(const Box3& box, double time);

}  // namespace adamas::datasets
