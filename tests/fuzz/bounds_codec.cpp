#include <cstdint>

#include "tests/fuzz/bounds_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    adamas::fuzz::bounds_codec({reinterpret_cast<const char*>(data), size});
  } catch (const adamas::Error&) {
  }
  return 0;
}
