#include "viewer/contents/view_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/picture/colour_map.h"
#include "isosurface/storage/store_format.h"
#include "viewer/contents/state_json.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;
using namespace timevarying;

namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 2> kShadings{"lit", "sphere"};
constexpr std::array<const char*, 3> kCameraModes{"trackball", "turntable", "fly"};
constexpr std::array<const char*, 3> kRepeats{"once", "loop", "there and back"};

Json json(const Vec3& v) { return {v.x, v.y, v.z}; }

Json json(const Viewpoint& v) {
  return {{"eye", json(v.eye)},       {"target", json(v.target)}, {"up", json(v.up)},
          {"angle", v.field_of_view}, {"height", v.height},       {"near", v.near}};
}

Json json(const StepPace& pace) {
  return {{"speed", pace.steps_per_second},
          {"repeat", kRepeats[static_cast<std::size_t>(pace.repeat)]},
          {"backward", pace.is_backward}};
}

Json json(const DocumentState& state) {
  Json surfaces = Json::array();
  for (const SurfaceState& s : state.surfaces)
    surfaces.push_back({{"isovalue", s.isovalue},
                        {"colour", {s.colour.r, s.colour.g, s.colour.b}},
                        {"opacity", s.opacity},
                        {"shown", s.is_shown}});
  Json result{{"surfaces", surfaces}, {"hidden", state.hidden}, {"field", state.field}};
  if (state.range) result["range"] = *state.range;
  if (state.step > 0) result["step"] = state.step;
  return result;
}

/// A few words on a value that was found instead of the expected one.
std::string shown(const Json& found) {
  constexpr std::size_t kMost = 60;
  if (found.is_array()) return fmt::format("a list of {}", found.size());
  if (found.is_object()) return "an object";
  std::string text = found.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kMost) text.replace(kMost, std::string::npos, "...");
  return text;
}

/// Reads a state from JSON, and refuses values that no picture can have.
class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  double number(const Json& from, const char* key, double least, double most) const {
    const Json& found = at(from, key);
    const double value = found.is_number() ? found.get<double>() : std::nan("");
    if (!(value >= least && value <= most))
      fail("{}: {}: expected a number from {} to {}, found {}", name_, key, least, most, shown(found));
    return value;
  }
  bool flag(const Json& from, const char* key) const {
    const Json& found = at(from, key);
    if (!found.is_boolean()) fail("{}: {}: expected true or false, found {}", name_, key, shown(found));
    return found.get<bool>();
  }
  std::string text(const Json& from, const char* key) const {
    const Json& found = at(from, key);
    if (!found.is_string()) fail("{}: {}: expected a text, found {}", name_, key, shown(found));
    return found.get<std::string>();
  }
  const Json& list(const Json& from, const char* key) const {
    const Json& found = at(from, key);
    if (!found.is_array()) fail("{}: {}: expected a list, found {}", name_, key, shown(found));
    return found;
  }
  template <class Enum, std::size_t kCount>
  Enum choice(const Json& from, const char* key, const std::array<const char*, kCount>& names) const {
    const std::string found = text(from, key);
    const auto it = std::ranges::find(names, found);
    if (it == names.end()) fail("{}: {}: found the unknown word {}", name_, key, shown(found));
    return static_cast<Enum>(it - names.begin());
  }
  std::array<double, 3> triple(const Json& from, const char* key, double least, double most) const {
    const Json& found = list(from, key);
    if (found.size() != 3) fail("{}: {}: expected three numbers, found {}", name_, key, shown(found));
    std::array<double, 3> result{};
    for (std::size_t n = 0; n < 3; ++n) result[n] = number(Json{{key, found[n]}}, key, least, most);
    return result;
  }
  Vec3 vector(const Json& from, const char* key) const {
    const auto [x, y, z] = triple(from, key, -1e300, 1e300);
    return {x, y, z};
  }
  Viewpoint viewpoint(const Json& from) const {
    Viewpoint result;
    result.eye = vector(from, "eye");
    result.target = vector(from, "target");
    result.up = vector(from, "up");
    result.field_of_view = number(from, "angle", 0, 3.2);
    result.height = number(from, "height", 0, 1e300);
    result.near = number(from, "near", 0, 1e300);
    try {
      const View checked(result);
    } catch (const Error& error) {
      fail("{}: {}", name_, error.what());
    }
    return result;
  }
  StepPace pace(const Json& from) const {
    StepPace result;
    result.steps_per_second = number(from, "speed", kSlowest, kFastest);
    result.repeat = choice<Repeat>(from, "repeat", kRepeats);
    result.is_backward = flag(from, "backward");
    return result;
  }
  DocumentState document(const Json& from) const {
    DocumentState result;
    for (const Json& each : list(from, "surfaces")) {
      const auto [r, g, b] = triple(each, "colour", 0, 1);
      result.surfaces.push_back({number(each, "isovalue", -1e300, 1e300),
                                 {r, g, b},
                                 number(each, "opacity", 0, 1),
                                 flag(each, "shown")});
    }
    for (const Json& each : list(from, "hidden"))
      result.hidden.insert(text(Json{{"hidden", each}}, "hidden"));
    result.field = text(from, "field");
    if (from.contains("range")) {
      const Json& range = list(from, "range");
      if (range.size() != 2) fail("{}: range: expected two numbers, found {}", name_, shown(range));
      const auto end = [&](std::size_t n) {
        return number(Json{{"range", range[n]}}, "range", -1e300, 1e300);
      };
      result.range = {end(0), end(1)};
    }
    if (from.contains("step"))
      result.step = static_cast<std::uint32_t>(number(from, "step", 0, kMostSteps - 1));
    return result;
  }

  const Json& at(const Json& from, const char* key) const {
    if (!from.is_object() || !from.contains(key)) fail("{}: expected '{}', found none", name_, key);
    return from.at(key);
  }

 private:
  const std::string& name_;
};

}  // namespace

std::string to_text(const ViewState& state) {
  Json result{{"viewpoint", json(state.viewpoint)},
              {"camera", kCameraModes[static_cast<std::size_t>(state.camera_mode)]},
              {"shading", kShadings[static_cast<std::size_t>(state.shading)]},
              {"colour_map", state.colour_map},
              {"edges", state.has_edges},
              {"axes", state.has_axes},
              {"colour_bar", state.has_colour_bar},
              {"box", state.has_box},
              {"time", state.has_time},
              {"pace", json(state.pace)},
              {"leaves_out_hidden", state.leaves_out_hidden},
              {"pixels", state.pixels},
              {"max_triangles", state.max_triangles},
              {"frame_milliseconds", state.frame_milliseconds},
              {"cut",
               {{"on", state.cut.is_on},
                {"origin", json(state.cut.plane.origin)},
                {"normal", json(state.cut.plane.normal)},
                {"cuts_away", state.cut.cuts_away},
                {"section", state.cut.shows_section}}},
              {"bookmarks", Json::array()},
              {"documents", Json::array()}};
  for (const Bookmark& each : state.bookmarks)
    result["bookmarks"].push_back({{"name", each.name}, {"viewpoint", json(each.viewpoint)}});
  for (const DocumentState& each : state.documents) result["documents"].push_back(json(each));
  // Names of files and materials need not be UTF-8.
  return result.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

ViewState view_state(std::string_view text, const std::string& name) {
  const Json from = parsed_states(text, name);
  if (!from.is_object()) fail("{}: expected a state of the viewer as JSON, found another text", name);
  const Reader read(name);
  ViewState result;
  result.viewpoint = read.viewpoint(read.at(from, "viewpoint"));
  result.camera_mode = read.choice<CameraMode>(from, "camera", kCameraModes);
  result.shading = read.choice<Shading>(from, "shading", kShadings);
  result.colour_map = read.text(from, "colour_map");
  static_cast<void>(ColourMap::by_name(result.colour_map));
  result.has_edges = read.flag(from, "edges");
  result.has_axes = read.flag(from, "axes");
  result.has_colour_bar = read.flag(from, "colour_bar");
  result.has_box = read.flag(from, "box");
  result.leaves_out_hidden = read.flag(from, "leaves_out_hidden");
  result.pixels = read.number(from, "pixels", 1e-3, 1e6);
  result.max_triangles = static_cast<std::uint64_t>(read.number(from, "max_triangles", 1, 1e12));
  // Older states have none of these three.
  if (from.contains("frame_milliseconds"))
    result.frame_milliseconds = read.number(from, "frame_milliseconds", 0, 1e6);
  if (from.contains("time")) result.has_time = read.flag(from, "time");
  if (from.contains("pace")) result.pace = read.pace(from.at("pace"));
  const Json& cut = read.at(from, "cut");
  result.cut = {read.flag(cut, "on"),
                {read.vector(cut, "origin"), read.vector(cut, "normal")},
                read.flag(cut, "cuts_away"),
                read.flag(cut, "section")};
  if (!(squared_norm(result.cut.plane.normal) > 0)) fail("{}: normal: expected a vector with a length", name);
  for (const Json& each : read.list(from, "bookmarks"))
    result.bookmarks.push_back({read.text(each, "name"), read.viewpoint(read.at(each, "viewpoint"))});
  for (const Json& each : read.list(from, "documents")) result.documents.push_back(read.document(each));
  return result;
}

}  // namespace adamas::viewer
