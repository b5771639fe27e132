#include <cstdint>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    adamas::fuzz::spy_dump({reinterpret_cast<const char*>(data), size});
  } catch (const adamas::Error&) {
  }
  return 0;
}
