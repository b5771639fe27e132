#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adamas/output_folder.h"
#include "cli/view_options.h"
#include "viewer/session/flight_frames.h"
#include "viewer/window/frame_files.h"

namespace adamas::cli {

/// The pictures that are asked for: from each viewpoint of the path one; with --steps one of each step, for
/// which the camera goes along the path meanwhile. Throws Error (kUsage) where the session has no such steps.
std::vector<viewer::FlightFrame> flight_frames(const ViewOptions& options, const PictureSize& size,
                                               const viewer::ViewSession& view);

/// Where pictures go: a folder, a film, both or nowhere.
class FlightOutput {
 public:
  /// Throws Error where neither can be written, before long work.
  FlightOutput(const ViewOptions& options, OutputSet& outputs);

  void add(const picture::Raster& picture);
  /// Instead of a picture that cannot be had.
  void leave_out() { files_->leave_out(); }
  /// To be called before the session's outputs get their names.
  void finish();
  void commit();

 private:
  /// Does what may throw Errors, which name outputs as they will be called.
  void naming_outputs(const std::function<void()>& work);

  std::optional<OutputFolder> folder_;
  std::string film_name_;
  OutputSet& outputs_;
  std::optional<viewer::FrameFiles> files_;
};

}  // namespace adamas::cli
