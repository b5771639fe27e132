#include "core/picture/turning_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/picture/colour_map.h"
#include "core/picture/markup.h"

#ifdef ADAMAS_THREE_JS

// The scripts are embedded in the program unchanged: the assembler reads them.
#define ADAMAS_EMBED(NAME, PATH)                                                                           \
  __asm__(".pushsection .rodata\n.global adamas_" #NAME "_begin\nadamas_" #NAME "_begin:\n.incbin \"" PATH \
          "\"\n.global adamas_" #NAME "_end\nadamas_" #NAME "_end:\n.byte 0\n.popsection\n");              \
  extern "C" const char adamas_##NAME##_begin[], adamas_##NAME##_end[];

ADAMAS_EMBED(three, ADAMAS_THREE_JS)
ADAMAS_EMBED(controls, ADAMAS_ORBIT_CONTROLS_JS)
ADAMAS_EMBED(viewer, ADAMAS_TURNING_PICTURE_JS)

#endif

namespace adamas::picture {

namespace {

#ifdef ADAMAS_THREE_JS
std::string scripts() {
  const auto script = [](const char* begin, const char* end) {
    return "<script>" + std::string(begin, end) + "</script>\n";
  };
  return script(adamas_three_begin, adamas_three_end) + script(adamas_controls_begin, adamas_controls_end) +
         script(adamas_viewer_begin, adamas_viewer_end);
}
#else
std::string scripts() { fail("pictures that turn: expected three.js, which this program was built without"); }
#endif

constexpr std::string_view kStyle = R"(
html, body { margin: 0; height: 100%; font: 15px/1.4 system-ui, sans-serif; color: #222; background: #fff; }
body { display: flex; }
#view { flex: 1; min-width: 0; height: 100vh; overflow: hidden; position: relative; }
#view canvas { display: block; }
#panel { width: 15em; padding: 1em; border-left: 1px solid #ddd; overflow: auto; max-height: 100vh; box-sizing: border-box; }
#panel h1 { font-size: 1.1em; margin: 0 0 .8em; }
#panel h2 { font-size: .85em; margin: 1.2em 0 .4em; color: #666; }
#materials label { display: flex; align-items: center; gap: .5em; padding: .15em 0; overflow-wrap: anywhere; }
.swatch { width: 1em; height: 1em; border: 1px solid #0003; border-radius: 2px; flex: none; }
#clip-place { width: 100%; }
#cut-field { width: 100%; }
#cut-bar { display: flex; flex-wrap: wrap; justify-content: space-between; font-size: .85em; margin-top: .4em; }
#cut-bar[hidden] { display: none; }
#cut-bar canvas { width: 100%; height: 1em; }
.message { position: absolute; inset: 40% 1em auto; text-align: center; }
.hint { color: #666; font-size: .85em; margin-top: 1.5em; }
@media (max-width: 700px) { body { flex-direction: column; } #view { height: 60vh; flex: none; width: 100%; } #panel { width: 100%; border-left: 0; } }
)";

/// The text as a string of JSON that may stand within a script of HTML.
std::string json_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || c == '<' || c == '>' || c == '&') {
      result += fmt::format("\\u{:04x}", code);
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string json_vector(const Vec3& v) { return fmt::format("[{:.9g},{:.9g},{:.9g}]", v.x, v.y, v.z); }

std::string css_colour(const Colour& colour) {
  const auto [r, g, b] = to_bytes(colour);
  return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

template <class T>
std::string json_numbers(const std::vector<T>& numbers) {
  const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
  return '"' + base64(bytes) + '"';
}

/// The triangles with the same materials on their sides, with shared points.
struct Part {
  std::vector<float> points;
  std::vector<std::uint32_t> triangles;

  void add(const std::array<Vec3, 3>& corners, const Vec3& middle) {
    for (const Vec3& p : corners) {
      const Vec3 at = p - middle;
      const std::array<float, 3> place{static_cast<float>(at.x), static_cast<float>(at.y),
                                       static_cast<float>(at.z)};
      const auto [known, is_new] = numbers_.try_emplace(place, static_cast<std::uint32_t>(points.size() / 3));
      if (is_new) points.insert(points.end(), place.begin(), place.end());
      triangles.push_back(known->second);
    }
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<float, 3>& place) const {
      std::uint64_t hash = 0;
      for (const float x : place) {
        std::uint32_t bits;
        std::memcpy(&bits, &x, sizeof bits);
        hash = mix64(hash ^ bits);
      }
      return hash;
    }
  };
  std::unordered_map<std::array<float, 3>, std::uint32_t, Hash> numbers_;
};

class Page {
 public:
  explicit Page(const InterfacePicture& picture) : picture_(picture) {
    for (const PictureTriangle& t : picture.triangles) {
      for (const Vec3& p : t.points) {
        if (!std::isfinite(p.x + p.y + p.z))
          fail("picture that turns: expected finite points, found ({}, {}, {})", p.x, p.y, p.z);
        extent_.extend(p);
      }
    }
    has_domain_ = picture.domain.min.x <= picture.domain.max.x;
    if (has_domain_) extent_ = picture.domain;
    if (picture.triangles.empty() && !has_domain_) extent_ = {{0, 0, 0}, {1, 1, 1}};
    middle_ = 0.5 * (extent_.min + extent_.max);
  }

  [[nodiscard]] std::string html() {
    const std::string data = json();
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           escape_markup(picture_.title) + "</title>\n<style>" + std::string(kStyle) +
           "</style>\n</head>\n<body data-state=\"loading\">\n<div id=\"view\"></div>\n<div "
           "id=\"panel\">\n<h1>" +
           escape_markup(picture_.title) + "</h1>\n" +
           (picture_.message.empty() ? "" : "<p>" + escape_markup(picture_.message) + "</p>\n") +
           "<h2>Materials</h2>\n<div id=\"materials\"></div>\n<h2>Clipping plane</h2>\n"
           "<select id=\"clip-axis\"><option value=\"\">none</option><option>x</option><option>y</option>"
           "<option>z</option></select>\n"
           "<input id=\"clip-place\" type=\"range\" min=\"0\" max=\"1000\" value=\"500\" disabled>\n"
           "<div id=\"cut\" hidden><label>on the cut <select id=\"cut-field\"></select></label>\n"
           "<div id=\"cut-bar\" hidden><canvas width=\"256\" "
           "height=\"1\"></canvas><span></span><span></span></div></div>\n"
           "<p><button id=\"reset\">Reset the view</button></p>\n"
           "<p class=\"hint\">Left button: turn. Wheel: nearer and farther. Right button: move.</p>\n"
           "</div>\n<script type=\"application/json\" id=\"picture-data\">" +
           data + "</script>\n" + scripts() + "</body>\n</html>\n";
  }

 private:
  /// The legend's entry for a colour; if there is none, a new one with this name.
  std::size_t material_of(const Colour& colour, const std::string& name = {}) {
    const auto found = std::find_if(materials_.begin(), materials_.end(),
                                    [&](const LegendEntry& m) { return m.colour == colour; });
    if (found != materials_.end()) return static_cast<std::size_t>(found - materials_.begin());
    materials_.push_back({name, colour});
    return materials_.size() - 1;
  }

  /// The JSON of what the cutting plane shows: the block, and the colour map of its fields.
  std::string block_json(const PictureBlock& block) {
    std::string result = fmt::format(
        "{{\"counts\":[{},{},{}],\"box\":[{},{}],\"materials\":[", block.counts[0], block.counts[1],
        block.counts[2], json_vector(block.box.min - middle_), json_vector(block.box.max - middle_));
    for (std::size_t n = 0; n < block.materials.size(); ++n)
      result += fmt::format("{}{}", n > 0 ? "," : "",
                            material_of(block.materials[n].colour, block.materials[n].name));
    result += fmt::format("],\"numbers\":{},\"fields\":[", json_numbers(block.numbers));
    const char* separator = "";
    for (const PictureBlock::Field& field : block.fields) {
      result += fmt::format("{}{{\"name\":{},\"low\":{:.4g},\"high\":{:.4g},\"parts\":{}}}", separator,
                            json_text(field.name), field.low, field.high, json_numbers(field.parts));
      separator = ",";
    }
    const ColourMap map = ColourMap::sequential();
    std::vector<std::uint8_t> colours;
    for (int n = 0; n < 255; ++n) {
      const auto rgb = to_bytes(map.at(n / 254.0));
      colours.insert(colours.end(), rgb.begin(), rgb.end());
    }
    return result + fmt::format("],\"map\":{}}}", json_numbers(colours));
  }

  std::string json() {
    materials_ = picture_.materials;
    std::map<std::pair<std::size_t, std::size_t>, Part> parts;
    for (const PictureTriangle& t : picture_.triangles)
      parts[{material_of(t.colour), material_of(t.back.value_or(t.colour))}].add(t.points, middle_);
    const std::string block = picture_.block ? block_json(*picture_.block) : "null";
    std::string result = "{\"materials\":[";
    for (std::size_t n = 0; n < materials_.size(); ++n)
      result += fmt::format("{}{{\"name\":{},\"colour\":\"{}\"}}", n > 0 ? "," : "",
                            json_text(materials_[n].name), css_colour(materials_[n].colour));
    result += "],\"parts\":[";
    const char* separator = "";
    for (const auto& [sides, part] : parts) {
      result +=
          fmt::format("{}{{\"front\":{},\"back\":{},\"points\":{},\"triangles\":{}}}", separator, sides.first,
                      sides.second, json_numbers(part.points), json_numbers(part.triangles));
      separator = ",";
    }
    const std::string extent =
        fmt::format("[{},{}]", json_vector(extent_.min - middle_), json_vector(extent_.max - middle_));
    return result + fmt::format("],\"extent\":{},\"box\":{},\"size\":{:.9g},\"direction\":{},\"block\":{}}}",
                                extent, has_domain_ ? extent : "null", std::max(extent_.diagonal(), 1e-30),
                                json_vector(picture_.direction), block);
  }

  const InterfacePicture& picture_;
  std::vector<LegendEntry> materials_;
  Box3 extent_;
  Vec3 middle_;
  bool has_domain_ = false;
};

}  // namespace

std::string turning_page(const InterfacePicture& picture) { return Page(picture).html(); }

}  // namespace adamas::picture
