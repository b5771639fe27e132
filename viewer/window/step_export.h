#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/partial_names.h"
#include "viewer/session/flight_frames.h"
#include "viewer/session/view_session.h"
#include "viewer/window/frame_files.h"
#include "viewer/window/session_picture.h"
#include "viewer/window/work_thread.h"

namespace adamas::viewer {

/// The form of an export, the size of its pictures, and the scale of their texts as in PanelContext.
struct ExportRequest {
  ExportForm form = ExportForm::kFilm;
  int width = 0, height = 0;
  double scale = 1;
};

/// Writes all steps of a session's series as pictures or as a film, beside the file of the series. They are
/// shown as the session shows them when this is made, along its bookmarks if its camera follows these, each
/// completely refined. The files are opened again for that, so that the session can be used meanwhile. An
/// output gets its name when it is complete, and never replaces another file.
class StepExport {
 public:
  StepExport(const ViewSession& session, const ExportRequest& request);
  /// Removes an incomplete output.
  ~StepExport();
  StepExport(const StepExport&) = delete;
  StepExport& operator=(const StepExport&) = delete;

  /// Draws at most one picture, with the current OpenGL context, which must be the same each time, and never
  /// waits for anything else. Returns whether there is more to do.
  bool go_on();
  /// The number of steps that are done, and of all steps; 0 until it is known.
  [[nodiscard]] std::size_t done() const { return next_; }
  [[nodiscard]] std::size_t steps() const { return frames_.size(); }
  /// The message at the end: what was written, or what went wrong.
  [[nodiscard]] const std::string& outcome() const { return outcome_; }

 private:
  void open_files();
  void begin();
  /// Does the work of go_on(). Throws Error, which go_on() makes the outcome.
  bool next();
  /// Draws the next step if its parts are ready. Returns whether they were; a step that cannot be loaded is
  /// skipped.
  bool draw_step();
  void finish();
  void discard();
  [[nodiscard]] std::filesystem::path folder() const;
  [[nodiscard]] std::string ending() const { return makes_film_ ? ".mp4" : ""; }
  [[nodiscard]] std::string stem() const;

  struct OpenedFile {
    std::string path;
    DocumentOptions options;
  };
  std::vector<OpenedFile> files_;
  ViewState state_;
  std::vector<isosurface::Viewpoint> path_;  ///< the path of the camera
  ExportRequest request_;
  std::filesystem::path series_;  ///< the file with the most steps
  double frames_per_second_;
  bool makes_film_ = false, has_no_film_maker_ = false, is_finishing_ = false;

  std::unique_ptr<ViewSession> session_;  ///< the exported session; null before its files are open
  std::vector<FlightFrame> frames_;
  std::size_t next_ = 0;
  std::set<std::uint32_t> lost_;
  std::string problem_;  ///< the problem of the first lost step
  std::unique_ptr<SessionPictures> pictures_;
  std::shared_ptr<PartialNames> names_;
  std::filesystem::path written_;  ///< the temporary file or folder that is being written
  std::unique_ptr<FrameFiles> output_;
  std::string outcome_;
  /// It is made last and destroyed first, since its work uses the other members.
  std::optional<WorkThread> thread_;
};

}  // namespace adamas::viewer
