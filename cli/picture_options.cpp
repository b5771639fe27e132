#include "cli/picture_options.h"

#include "adamas/text.h"
#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

/// Parses "A|B", both sides of an interface, or "A", one material.
ShownInterface parse_interface(const std::string& option, const std::string& text) {
  const std::size_t bar = text.find('|');
  if (bar == std::string::npos) return {std::string(trimmed(text))};
  ShownInterface shown{std::string(trimmed(text.substr(0, bar))), std::string(trimmed(text.substr(bar + 1)))};
  if (shown.other.empty())
    wrong_usage("{}: expected A or 'A|B' with two materials, found '{}'", option, text);
  return shown;
}

}  // namespace

void PictureOptions::check() const {
  const DrawingOptions none;
  const char* given = drawing.direction != none.direction     ? "--direction"
                      : drawing.projection != none.projection ? "--projection"
                      : drawing.focus                         ? "--focus"
                      : has_size                              ? "--size"
                      : !drawing.shown.empty()                ? "--show-interface"
                                                              : nullptr;
  if (own_file && file.empty() && given != nullptr) wrong_usage("{}: expected --picture as well", given);
  check_surface_drawing(drawing);
}

void add_picture_options(const Command& command, PictureOptions& options, const std::string& subject,
                         bool own_file) {
  options.own_file = own_file;
  DrawingOptions& drawing = options.drawing;
  if (own_file)
    command
        .add_option("--picture", options.file,
                    "A picture of " + subject + ": .png, .svg, .pdf, or .html, which turns in a browser")
        .type_name("FILE");
  command
      .add_converted(
          "--direction", "The way that the picture's camera looks; z is up",
          [&drawing](const std::string& option, const std::string& text) {
            drawing.direction = parse_vector(option, text);
          },
          "-0.62,0.72,-0.42")
      .type_name("x,y,z")
      .group("Picture")
      .show_default();
  command
      .add_converted("--focus", "What the picture shows as large as it can (default: all)",
                     [&drawing](const std::string& option, const std::string& text) {
                       drawing.focus = to_box(parse_bounds(option, text));
                     })
      .type_name("x0,x1,y0,y1,z0,z1")
      .group("Picture");
  command
      .add_converted(
          "--projection", "How the picture shows depth",
          [&drawing](const std::string&, const std::string& text) {
            drawing.projection =
                text == "orthographic" ? Projection::kOrthographic : Projection::kPerspective;
          },
          "perspective")
      .one_of({"perspective", "orthographic"})
      .group("Picture")
      .show_default();
  if (!own_file) return;
  command
      .add_converted("--size", "Width and height of the picture in pixels (default 1600,1200)",
                     [&options](const std::string& option, const std::string& text) {
                       const auto sides = parse_numbers(option, text, 2);
                       options.drawing.width = sides[0];
                       options.drawing.height = sides[1];
                       options.has_size = true;
                     })
      .type_name("W,H")
      .group("Picture");
}

void add_surface_picture_options(const Command& command, PictureOptions& options, bool own_file) {
  add_picture_options(command, options, "the interfaces", own_file);
  command
      .add_converted_each(
          "--show-interface",
          "The picture shows the interface between two materials, or with A alone all of one material; "
          "repeatable (default: all)",
          [&options](const std::string& option, const std::string& text) {
            options.drawing.shown.push_back(parse_interface(option, text));
          })
      .type_name("A|B")
      .group("Picture");
}

}  // namespace adamas::cli
