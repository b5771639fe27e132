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
    command.add_option("--picture", "FILE",
                       "A picture of " + subject + ": .png, .svg, .pdf, or .html, which turns in a browser",
                       options.file);
  const Command picture = command.in_group("Picture");
  picture.add_value("--direction", "x,y,z", "The way that the picture's camera looks; z is up",
                    drawing.direction, parse_vector, "-0.62,0.72,-0.42");
  picture.add_value("--focus", "x0,x1,y0,y1,z0,z1",
                    "What the picture shows as large as it can (default: all)", drawing.focus, parse_box);
  picture.add_choice<Projection>(
      "--projection", "How the picture shows depth", drawing.projection,
      {{"perspective", Projection::kPerspective}, {"orthographic", Projection::kOrthographic}},
      "perspective");
  if (!own_file) return;
  picture.add_converted("--size", "W,H", "Width and height of the picture in pixels (default 1600,1200)",
                        [&options](const std::string& option, const std::string& text) {
                          const auto [width, height] = parse_two_numbers(option, text);
                          options.drawing.width = width;
                          options.drawing.height = height;
                          options.has_size = true;
                        });
}

void add_surface_picture_options(const Command& command, PictureOptions& options, bool own_file) {
  add_picture_options(command, options, "the interfaces", own_file);
  command.in_group("Picture").add_values(
      "--show-interface", "A|B",
      "The picture shows the interface between two materials, or with A alone all of one material; "
      "repeatable (default: all)",
      options.drawing.shown, parse_interface);
}

}  // namespace adamas::cli
