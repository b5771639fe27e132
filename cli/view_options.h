#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "viewer/session/view_session.h"

namespace adamas::cli {

/// The options of `adamas view` as they were given; empty where they were not.
struct ViewOptions {
  std::vector<std::string> paths, isovalues, opacities, hidden;
  std::string memory = "256M", step, steps, colour_by, pixels, max_triangles, frame_time, paging,
              interpolation, path, frames, size, shading, field, range, colour_map, plane, origin, normal,
              state, culled_from, film, frame_rate;
  bool offscreen = false, overwrite = false, edges = false, plain = false, show_time = false, no_cut = false,
       no_section = false, occlusion = false, fresh = false;
};

struct PictureSize {
  int width, height;
};

void add_view_options(const Command& command, ViewOptions& options);

/// The size that was asked for, or another one. Throws Error (kUsage), as the other functions do.
PictureSize picture_size(const ViewOptions& options, const PictureSize& otherwise);
/// Looks at all that can be wrong with options, before long work.
void check_view_options(const ViewOptions& options, const Session& session);
/// Frames of a film in a second.
double film_rate(const ViewOptions& options);
/// Whether surfaces wait for the pages that they need.
bool waits_for_pages(const ViewOptions& options);
/// Brings what the options say into the state. Throws Error too where no file has such a field or material.
void apply_view_options(const ViewOptions& options, viewer::ViewSession& view);

}  // namespace adamas::cli
