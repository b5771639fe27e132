#include "cli/material_numbers.h"

#include <algorithm>

#include "core/base/error.h"

namespace adamas {

IdVector<MaterialId, MaterialId> material_numbers(const IdVector<MaterialId, std::string>& names,
                                                  const IdVector<MaterialId, std::string>& among,
                                                  std::string_view source, std::string_view whose) {
  IdVector<MaterialId, MaterialId> numbers;
  for (const std::string& name : names) {
    const auto found = std::find(among.begin(), among.end(), name);
    if (found == among.end()) {
      std::string known;
      for (const std::string& m : among) known += (known.empty() ? "" : ", ") + m;
      fail("{}: expected the materials of {} ({}), found '{}'", source, whose, known, name);
    }
    numbers.push_back(MaterialId(static_cast<std::size_t>(found - among.begin())));
  }
  return numbers;
}

}  // namespace adamas
