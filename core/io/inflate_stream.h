#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace adamas {

/// Decompresses a zlib or gzip stream and hands it out piece by piece. Throws Error with `name` where it is
/// corrupt or ends early; what follows its end is left alone. Returns its size once decompressed.
std::size_t inflate_stream(std::string_view compressed, const std::string& name,
                           const std::function<void(std::string_view)>& receive);

}  // namespace adamas
