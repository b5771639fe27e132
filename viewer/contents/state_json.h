#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace adamas::viewer {

/// The greatest depth of nested lists in a state. Deeper ones are refused, since the functions that copy or
/// print JSON are recursive.
inline constexpr int kMostDepthOfStates = 32;

/// Parses a text; the result is discarded if the text is no JSON. Throws Error, which begins with `name`, for
/// depths beyond kMostDepthOfStates.
inline nlohmann::json parsed_states(std::string_view text, const std::string& name) {
  const auto check = [&name](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > kMostDepthOfStates)
      fail("{}: expected lists within each other up to {} deep, found more", name, kMostDepthOfStates);
    return true;
  };
  return nlohmann::json::parse(text, check, false);
}

}  // namespace adamas::viewer
