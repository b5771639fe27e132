#include "cli/reference_program.h"

#include "cli/usage.h"
#include "core/base/child_process.h"

namespace adamas::cli {

std::filesystem::path find_reference_program(const std::string& what) {
  if (!ADAMAS_WITH_REFERENCE)
    fail("{}: this build is without adamas-reference (ADAMAS_WITH_REFERENCE=OFF)", what);
  return find_own_program("adamas-reference", "ADAMAS_REFERENCE_PROGRAM");
}

}  // namespace adamas::cli
