#include "core/io/nrrd_header.h"

#include "core/base/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const adamas::NrrdHeader header = adamas::parse_nrrd_header(text, "fuzz");
    if (header.header_bytes > size || header.value_count() == 0) __builtin_trap();
  } catch (const adamas::Error&) {
  }
  return 0;
}
