#pragma once

#include <sstream>
#include <string>
#include <string_view>

#include "isosurface/view/flight.h"
#include "tests/fuzz/require.h"
#include "viewer/contents/view_state.h"

namespace adamas::fuzz {

using namespace isosurface;
using namespace viewer;

/// The bytes are a file of viewpoints, or, where they begin with '{', a state of the viewer, which its own
/// text restores.
inline void view_text(std::string_view bytes) {
  if (bytes.starts_with('{')) {
    const ViewState state = view_state(bytes, "fuzz");
    require(to_text(view_state(to_text(state), "again")) == to_text(state),
            "a state that changes in its text");
    return;
  }
  std::istringstream file{std::string(bytes)};
  const auto viewpoints = read_viewpoints(file, "fuzz", Viewpoint{});
  for (const Viewpoint& viewpoint : viewpoints) const View view(viewpoint);
}

}  // namespace adamas::fuzz
