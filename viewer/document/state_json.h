#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace adamas::viewer {

/// Lists within lists within lists: no state of the viewer has more. Texts that people have edited may, and
/// what copies or prints them calls itself at each depth.
inline constexpr int kMostDepthOfStates = 32;

/// The text as JSON, discarded where it is none. Throws Error, which begins with `name`, for depths beyond
/// kMostDepthOfStates.
inline nlohmann::json parsed_states(std::string_view text, const std::string& name) {
  const auto check = [&name](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > kMostDepthOfStates)
      fail("{}: expected lists within each other up to {} deep, found more", name, kMostDepthOfStates);
    return true;
  };
  return nlohmann::json::parse(text, check, false);
}

}  // namespace adamas::viewer
