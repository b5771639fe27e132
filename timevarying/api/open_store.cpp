#include "timevarying/api/open_store.h"

#include <cctype>
#include <string>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/notes.h"

namespace adamas {

bool is_store(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".adm";
}

namespace timevarying {

using namespace isosurface;

std::unique_ptr<StoreFile> open_store_file(const std::filesystem::path& path, const OpenOptions& options) {
  try {
    return std::make_unique<StoreFile>(path, options.mapped ? Paging::kMap : Paging::kRead);
  } catch (const Error& e) {
    std::error_code unknown;
    if (is_store(path) || !std::filesystem::is_regular_file(path, unknown)) throw;
    fail("{}: adamas store makes one of a volume", e.what());
  }
}

std::uint32_t wanted_step(const std::optional<std::uint64_t>& step, const StoreFile& file,
                          Progress& progress) {
  if (!step) {
    if (file.steps() > 1)
      note(progress, "{}: the first of {} steps; --step says which", file.name(), file.steps());
    return 0;
  }
  if (*step >= file.steps())
    wrong_usage("--step: expected less than {}, since {} has {}, found {}", file.steps(), file.name(),
                counted(file.steps(), "step"), *step);
  return static_cast<std::uint32_t>(*step);
}

}  // namespace timevarying

}  // namespace adamas
