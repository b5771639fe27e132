#pragma once

#include <mutex>
#include <optional>

#include "interfaces/network/body_winding.h"
#include "interfaces/network/interface_network.h"

namespace adamas {

/// Winding numbers, for networks with gaps.
struct InterfaceNetwork::LazyWinding {
  std::once_flag built;
  std::optional<BodyWinding> winding;
};

}  // namespace adamas
