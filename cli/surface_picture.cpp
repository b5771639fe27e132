#include "cli/surface_picture.h"

#include <algorithm>
#include <array>

#include "adamas/text.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "core/picture/interface_picture.h"
#include "core/picture/palette.h"

namespace adamas::cli {

using namespace picture;

namespace {

/// There is no legend for more materials than these.
constexpr std::size_t kMostNames = 24;

/// The materials that the text names: both sides of an interface, or one material and an empty name.
std::array<std::string, 2> chosen_names(const std::string& text) {
  const std::size_t bar = text.find('|');
  if (bar == std::string::npos) return {std::string(trimmed(text)), ""};
  const std::string_view view = text;
  return {std::string(trimmed(view.substr(0, bar))), std::string(trimmed(view.substr(bar + 1)))};
}

MaterialId find_material(const IdVector<MaterialId, std::string>& materials, const std::string& name,
                         const std::string& source) {
  const auto found = std::find(materials.begin(), materials.end(), name);
  if (found != materials.end()) return MaterialId(static_cast<std::size_t>(found - materials.begin()));
  std::string known;
  for (const std::string& each : materials) known += (known.empty() ? "'" : ", '") + each + "'";
  fail("{}: --show-interface: expected materials of {}, found '{}'", source, known, name);
}

/// The triangles that a picture shows.
class Choice {
 public:
  Choice(const std::vector<std::string>& texts, const IdVector<MaterialId, std::string>& materials,
         const std::string& source) {
    for (const std::string& text : texts) {
      const auto [a, b] = chosen_names(text);
      const MaterialId first = find_material(materials, a, source);
      pairs_.push_back({first, b.empty() ? MaterialId() : find_material(materials, b, source)});
    }
  }

  [[nodiscard]] bool shows(const InterfaceTriangle& t) const {
    const auto fits = [&t](const std::array<MaterialId, 2>& pair) {
      const auto& [a, b] = pair;
      if (!b.valid()) return t.front == a || t.back == a;
      return (t.front == a && t.back == b) || (t.front == b && t.back == a);
    };
    return pairs_.empty() || std::any_of(pairs_.begin(), pairs_.end(), fits);
  }

 private:
  std::vector<std::array<MaterialId, 2>> pairs_;
};

}  // namespace

void PictureOptions::aim(InterfacePicture& picture) const {
  picture.direction = parse_vector("--direction", direction);
  if (!(squared_norm(picture.direction) > 0))
    wrong_usage("--direction: expected a vector with a length, found 0");
  picture.projection = projection == "orthographic" ? Projection::kOrthographic : Projection::kPerspective;
  if (!focus.empty()) picture.focus = to_box(parse_bounds("--focus", focus));
}

InterfacePictureOptions PictureOptions::sizes() const {
  InterfacePictureOptions result;
  if (size.empty()) return result;
  const auto sides = parse_numbers("--size", size, 2);
  for (const double side : sides) {
    if (!(side >= 200 && side <= 8000))
      wrong_usage("--size: expected a width and a height from 200 to 8000, found '{}'", size);
  }
  result.width = sides[0];
  result.height = sides[1];
  return result;
}

void PictureOptions::check() const {
  const PictureOptions none;
  const char* given = direction != none.direction     ? "--direction"
                      : projection != none.projection ? "--projection"
                      : !focus.empty()                ? "--focus"
                      : !size.empty()                 ? "--size"
                                                      : nullptr;
  if (own_file && file.empty() && given != nullptr) wrong_usage("{}: expected --picture as well", given);
  InterfacePicture unused;
  aim(unused);
  static_cast<void>(sizes());
}

void add_picture_options(const Command& command, PictureOptions& options, const std::string& subject,
                         bool own_file) {
  options.own_file = own_file;
  if (own_file)
    command
        .add_option("--picture", options.file,
                    "A picture of " + subject + ": .png, .svg, .pdf, or .html, which turns in a browser")
        .type_name("FILE");
  command.add_option("--direction", options.direction, "The way that the picture's camera looks; z is up")
      .type_name("x,y,z")
      .group("Picture")
      .show_default();
  command.add_option("--focus", options.focus, "What the picture shows as large as it can (default: all)")
      .type_name("x0,x1,y0,y1,z0,z1")
      .group("Picture");
  command.add_option("--projection", options.projection, "How the picture shows depth")
      .one_of({"perspective", "orthographic"})
      .group("Picture")
      .show_default();
  if (!own_file) return;
  command.add_option("--size", options.size, "Width and height of the picture in pixels (default 1600,1200)")
      .type_name("W,H")
      .group("Picture");
}

void SurfacePictureOptions::check() const {
  camera.check();
  if (camera.own_file && camera.file.empty() && !shown.empty())
    wrong_usage("--show-interface: expected --picture as well");
  for (const std::string& text : shown) {
    const auto [a, b] = chosen_names(text);
    if (a.empty() || a == b || (b.empty() && text.find('|') != std::string::npos))
      wrong_usage("--show-interface: expected A or 'A|B' with two materials, found '{}'", text);
  }
}

void SurfacePictureOptions::check_materials(const IdVector<MaterialId, std::string>& materials,
                                            const std::string& source) const {
  static_cast<void>(Choice(shown, materials, source));
}

void add_surface_picture_options(const Command& command, SurfacePictureOptions& options, bool own_file) {
  add_picture_options(command, options.camera, "the interfaces", own_file);
  command
      .add_option(
          "--show-interface", options.shown,
          "The picture shows the interface between two materials, or with A alone all of one material; "
          "repeatable (default: all)")
      .type_name("A|B")
      .one_value_each()
      .group("Picture");
}

void write_surface_picture(const std::filesystem::path& path, const InterfaceMesh& mesh, const Box3& domain,
                           const SurfacePictureOptions& options, std::optional<PictureBlock> block) {
  const Choice choice(options.shown, mesh.materials, mesh.source);
  InterfacePicture picture;
  picture.domain = domain;
  options.camera.aim(picture);
  std::vector<char> shown(mesh.materials.size(), 0);
  for (const InterfaceTriangle& t : mesh.triangles) {
    if (!choice.shows(t)) continue;
    shown[t.front.value] = shown[t.back.value] = 1;
    picture.triangles.push_back(
        {{mesh.points[t.points[0]], mesh.points[t.points[1]], mesh.points[t.points[2]]},
         material_colour(t.back.value),
         material_colour(t.front.value)});
  }
  if (static_cast<std::size_t>(std::count(shown.begin(), shown.end(), 1)) <= kMostNames) {
    for (MaterialId m(0); m.value < mesh.materials.size(); ++m.value) {
      if (shown[m.value] != 0) picture.materials.push_back({mesh.materials[m], material_colour(m.value)});
    }
  }
  picture.block = std::move(block);
  InterfacePictureOptions drawn = options.camera.sizes();
  drawn.triangle_edges = options.triangle_edges;
  write_interfaces(picture, path, drawn);
}

}  // namespace adamas::cli
