#pragma once

#include <functional>
#include <optional>
#include <string>

#include "adamas/output_folder.h"
#include "adamas/output_set.h"
#include "adamas/view.h"
#include "viewer/window/frame_files.h"

namespace adamas::viewer {

/// The pictures of a flight as a folder, a film, both or neither.
class FlightOutput {
 public:
  /// Throws Error, before long work, if the folder or the film cannot be written.
  FlightOutput(const FlightOptions& options, OutputSet& outputs);

  void add(const picture::Raster& picture);
  /// Skips a picture that cannot be drawn.
  void leave_out() { files_->leave_out(); }
  /// Completes the film; it is called before the outputs get their names.
  void finish();
  void commit();

 private:
  /// Calls `work`; its Errors then name outputs by their final names.
  void naming_outputs(const std::function<void()>& work);

  std::optional<OutputFolder> folder_;
  std::string film_name_;
  OutputSet& outputs_;
  std::optional<FrameFiles> files_;
};

}  // namespace adamas::viewer
