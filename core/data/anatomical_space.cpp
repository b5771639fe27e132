#include "core/data/anatomical_space.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace adamas::inline core {

namespace {

struct Space {
  const char* name;          ///< the name in VolumeGrid
  const char* long_name;     ///< the name in NRRD, in lower case
  const char* abbreviation;  ///< the abbreviation in NRRD; a 't' follows if there is a time axis
};

constexpr Space kSpaces[] = {
    {"RAS", "right-anterior-superior", "ras"},  {"LAS", "left-anterior-superior", "las"},
    {"LPS", "left-posterior-superior", "lps"},  {"scanner-xyz", "scanner-xyz", ""},
    {"3D-right-handed", "3d-right-handed", ""}, {"3D-left-handed", "3d-left-handed", ""}};

/// The signs of the x and y axes relative to those of RAS.
std::optional<std::array<double, 2>> signs_of(const std::string& space) {
  if (space == "RAS") return std::array{1.0, 1.0};
  if (space == "LAS") return std::array{-1.0, 1.0};
  if (space == "LPS") return std::array{-1.0, -1.0};
  return {};
}

}  // namespace

std::string space_of_nrrd(std::string_view name) {
  std::string text(name);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  constexpr std::string_view kTime = "-time";
  if (text.ends_with(kTime)) text.resize(text.size() - kTime.size());
  if (text.size() == 4 && text.ends_with('t')) text.pop_back();
  for (const Space& space : kSpaces) {
    if (text == space.long_name || (!text.empty() && text == space.abbreviation)) return space.name;
  }
  return {};
}

std::string nrrd_space(const std::string& space) {
  // NRRD writes these names with a capital letter, as VolumeGrid does.
  if (space.starts_with("3D")) return space;
  for (const Space& each : kSpaces) {
    if (space == each.name) return each.long_name;
  }
  return {};
}

bool is_space(const std::string& space) {
  return std::any_of(std::begin(kSpaces), std::end(kSpaces),
                     [&space](const Space& each) { return space == each.name; });
}

bool to_space(const std::string& space, VolumeGrid& grid) {
  const auto from = signs_of(grid.space), to = signs_of(space);
  if (!from || !to) return false;
  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if ((*from)[a] == (*to)[a]) continue;
    // Zero stays without a sign.
    const auto turn = [](double& value) { value = value == 0 ? 0 : -value; };
    turn(grid.origin[axis]);
    for (Vec3& direction : grid.directions) turn(direction[axis]);
  }
  grid.space = space;
  return true;
}

}  // namespace adamas::inline core
