#include "cli/picture_options.h"

#include "cli/option_values.h"
#include "cli/usage_error.h"

namespace adamas {

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
    command.add_option("--picture", options.file, "A picture of " + subject + ": .png, .svg or .pdf")
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

}  // namespace adamas
