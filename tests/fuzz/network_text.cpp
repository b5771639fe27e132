#include "core/io/network_text.h"

#include <cstdint>

#include "core/base/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    adamas::to_interface_mesh(adamas::parse_labelled_network(text, "fuzz"), {}, "fuzz");
  } catch (const adamas::Error&) {
  }
  try {
    adamas::parse_region_names(text, "fuzz");
  } catch (const adamas::Error&) {
  }
  return 0;
}
