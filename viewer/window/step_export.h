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

/// What an export is to be: its form, the size of its pictures, and how large their texts are, as
/// PanelContext has it.
struct ExportRequest {
  ExportForm form = ExportForm::kFilm;
  int width = 0, height = 0;
  double scale = 1;
};

/// Writes all steps of a session's series as pictures or as a film, beside the file of the series: as the
/// session shows them when this is made, along its bookmarks where its camera goes along these, each wholly
/// refined. The files are opened once more for that, so the session goes its own way meanwhile. What is
/// written has no name before it is whole, and takes that of nothing else.
class StepExport {
 public:
  StepExport(const ViewSession& session, const ExportRequest& request);
  /// Leaves nothing where it is not done.
  ~StepExport();
  StepExport(const StepExport&) = delete;
  StepExport& operator=(const StepExport&) = delete;

  /// Goes on: draws a picture at most, by the OpenGL context that is current, which has to be the same each
  /// time, and never waits for anything else. Returns whether there is more to do.
  bool go_on();
  /// How many steps are done, and of how many; 0 before that is known.
  [[nodiscard]] std::size_t done() const { return next_; }
  [[nodiscard]] std::size_t steps() const { return frames_.size(); }
  /// At the end: what was written, or what went wrong.
  [[nodiscard]] const std::string& outcome() const { return outcome_; }

 private:
  void open_files();
  void begin();
  /// The same as go_on(), which tells of Errors.
  bool next();
  /// Returns whether the step is there; where it cannot be had it is left out.
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
  std::vector<isosurface::Viewpoint> path_;  ///< along which the camera goes
  ExportRequest request_;
  std::filesystem::path series_;  ///< the file of most steps
  double frames_per_second_;
  bool makes_film_ = false, has_no_film_maker_ = false, is_finishing_ = false;

  std::unique_ptr<ViewSession> session_;  ///< of its own; null before it is open
  std::vector<FlightFrame> frames_;
  std::size_t next_ = 0;
  std::set<std::uint32_t> lost_;
  std::string problem_;  ///< of the first of these
  std::unique_ptr<SessionPictures> pictures_;
  std::shared_ptr<PartialNames> names_;
  std::filesystem::path written_;  ///< a file or a folder
  std::unique_ptr<FrameFiles> output_;
  std::string outcome_;
  std::optional<WorkThread> thread_;  ///< the last that comes and the first that goes
};

}  // namespace adamas::viewer
