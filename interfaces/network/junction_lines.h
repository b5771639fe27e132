#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/data/interface_mesh.h"

namespace adamas {

/// The edges of a welded interface mesh round which three materials or more meet, each once, by its lower and
/// its higher point.
std::vector<std::array<std::uint32_t, 2>> junction_lines(const InterfaceMesh& mesh);

}  // namespace adamas
