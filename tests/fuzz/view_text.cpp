#include <cstdint>

#include "core/base/error.h"
#include "tests/fuzz/viewer_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    adamas::fuzz::view_text({reinterpret_cast<const char*>(data), size});
  } catch (const adamas::Error&) {
  }
  return 0;
}
