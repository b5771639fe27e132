#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/io/grid_file.h"

namespace adamas::io {

/// Labels as indices of names, which ascend as the labels do.
struct GridLabels {
  std::vector<std::uint16_t> index;
  std::vector<std::string> names;
};

/// Whole numbers as labels, called as `names` has them by their value, else like their value. Numbers with a
/// scale that does not make whole ones of them are taken without it; `note`, which may be empty, is told so.
/// Throws Error, in the name of `source`, at numbers that are not whole.
GridLabels name_labels(const std::string& source, GridArray array, const std::vector<std::string>& names,
                       const std::function<void(const std::string&)>& note);

}  // namespace adamas::io
