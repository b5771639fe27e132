#pragma once

#include <string>
#include <vector>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// A table of text, which is printed or becomes a part of a report.
struct TextTable {
  std::string caption{};
  std::vector<std::string> header{};
  std::vector<std::vector<std::string>> rows{};  ///< rows with as many cells as the header
};

}  // namespace adamas
