#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/io/grid_file.h"

namespace adamas::io {

/// Labels as indices of names, in the order of the labels.
struct GridLabels {
  std::vector<std::uint16_t> index;
  std::vector<std::string> names;
};

/// Makes labels of whole numbers. The name of a label is the entry of `names` at its value, else the value
/// itself. A scale that does not lead to whole numbers is ignored, and a remark on it is appended to `note`
/// if it is given. Throws Error, with `source`, at numbers that are not whole.
GridLabels name_labels(const std::string& source, GridArray array, const std::vector<std::string>& names,
                       const std::function<void(const std::string&)>& note);

}  // namespace adamas::io
