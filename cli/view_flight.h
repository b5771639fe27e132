#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "cli/output_folder.h"
#include "cli/view_options.h"
#include "core/picture/film.h"

namespace adamas {

/// A picture of a flight without a window.
struct FlightFrame {
  Viewpoint viewpoint;
  std::optional<std::uint32_t> step;  ///< none: that of the state
};

/// The pictures that are asked for: from each viewpoint of the path one; with --steps one of each step, for
/// which the camera goes along the path meanwhile. Throws UsageError where the session has no such steps.
std::vector<FlightFrame> flight_frames(const ViewOptions& options, const PictureSize& size,
                                       const ViewSession& view);

/// Where pictures go: a folder, a film, both or nowhere.
class FlightOutput {
 public:
  /// Throws Error where neither can be written, before long work.
  FlightOutput(const ViewOptions& options, const PictureSize& size, OutputSet& outputs);

  void add(const Raster& picture);
  /// To be called before the session's outputs get their names.
  void finish();
  void commit();

 private:
  std::optional<OutputFolder> folder_;
  std::unique_ptr<Film> film_;
  std::string film_name_;
  PictureSize size_;
  double rate_;
  OutputSet& outputs_;
  std::size_t frames_ = 0;
};

}  // namespace adamas
