#include "cli/reference_program.h"

#include <unistd.h>

#include <cstdlib>

#include "core/base/error.h"

namespace adamas {

namespace {

constexpr const char* kVariable = "ADAMAS_REFERENCE_PROGRAM";
constexpr const char* kName = "adamas-reference";

bool can_run(const std::filesystem::path& path) {
  std::error_code code;
  return std::filesystem::is_regular_file(path, code) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::filesystem::path find_reference_program() {
  const char* given = std::getenv(kVariable);
  if (given != nullptr && *given != '\0') {
    if (!can_run(given)) fail("{}: expected a program, found none at '{}'", kVariable, given);
    return given;
  }
  std::error_code code;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", code).parent_path();
  const std::filesystem::path beside = folder / kName;
  const std::filesystem::path installed = folder / ".." / "libexec" / kName;
  if (can_run(beside)) return beside;
  if (can_run(installed)) return installed;
  fail("expected the program '{}' beside adamas or in ../libexec, found none (the variable {} can name it)",
       kName, kVariable);
}

}  // namespace adamas
