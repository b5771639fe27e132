#pragma once

#include <string>
#include <string_view>

#include "core/base/typed_id.h"

namespace adamas {

/// The numbers that materials have among others, by name. Throws Error, in the name of `source`, for one that
/// is not there; `whose` tells whose materials were expected.
IdVector<MaterialId, MaterialId> material_numbers(const IdVector<MaterialId, std::string>& names,
                                                  const IdVector<MaterialId, std::string>& among,
                                                  std::string_view source, std::string_view whose);

}  // namespace adamas
