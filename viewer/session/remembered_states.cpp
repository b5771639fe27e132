#include "viewer/session/remembered_states.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/picture/picture_file.h"
#include "viewer/contents/state_json.h"

namespace adamas::viewer {

using namespace io;
using namespace isosurface;
using namespace picture;

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostStates = 50;

/// The canonical names of files, which are the same for all names of a file.
Json key_of(const std::vector<std::string>& documents) {
  Json key = Json::array();
  for (const std::string& name : documents) {
    std::error_code code;
    const std::filesystem::path whole =
        std::filesystem::weakly_canonical(std::filesystem::absolute(name), code);
    key.push_back(code ? name : whole.string());
  }
  return key;
}

/// Reads a list of states with their files, the last one first.
Json states_of(const std::filesystem::path& file) {
  try {
    Json all = parsed_states(read_file(file), file.string());
    return all.is_array() ? all : Json::array();
  } catch (const Error&) {
    return Json::array();
  }
}

}  // namespace

std::filesystem::path remembered_states_file() {
  const auto folder = [](const char* variable) -> std::filesystem::path {
    const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets it
    return value == nullptr ? "" : value;
  };
  if (const auto state = folder("XDG_STATE_HOME"); state.is_absolute()) return state / "adamas" / "view.json";
  const auto home = folder("HOME");
  return home.empty() ? "" : home / ".local" / "state" / "adamas" / "view.json";
}

std::optional<ViewState> remembered_state(const std::filesystem::path& file,
                                          const std::vector<std::string>& documents) {
  const Json key = key_of(documents);
  for (const Json& each : states_of(file)) {
    if (!each.is_object() || each.value("files", Json()) != key || !each.contains("state")) continue;
    try {
      return view_state(each["state"].dump(), file.string());
    } catch (const Error&) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

void remember_state(const std::filesystem::path& file, const std::vector<std::string>& documents,
                    const ViewState& state) {
  const Json key = key_of(documents);
  Json all = Json::array();
  all.push_back({{"files", key}, {"state", Json::parse(to_text(state))}});
  for (const Json& each : states_of(file)) {
    if (all.size() < kMostStates && each.is_object() && each.value("files", Json()) != key)
      all.push_back(each);
  }
  std::error_code code;
  std::filesystem::create_directories(file.parent_path(), code);
  write_bytes(file, all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace adamas::viewer
