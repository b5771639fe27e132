#include <cstdint>

#include "tests/fuzz/store_file_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    adamas::fuzz::store_file({reinterpret_cast<const char*>(data), size});
  } catch (const adamas::Error& error) {
    adamas::fuzz::require(std::string_view(error.what()).find('\n') == std::string_view::npos, "two lines");
  }
  return 0;
}
