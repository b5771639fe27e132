#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "timevarying/step_clock.h"
#include "viewer/contents/document.h"
#include "viewer/contents/drawn_mesh.h"
#include "viewer/contents/view_state.h"
#include "viewer/session/actions.h"

namespace adamas::viewer {

/// What was found at the place of a click.
struct Picked {
  std::string document;
  Vec3 place;
  Reading reading;
  std::size_t number = 0, surface = 0;  ///< the numbers of the document and of its surface
};

/// The form in which the steps of a series are written: one film, or one picture per step.
enum class ExportForm : std::uint8_t { kFilm, kFrames };

/// Files that are shown together, and their state: everything of a viewer that needs neither a window nor
/// OpenGL. The panels change state() directly.
class ViewSession {
 public:
  /// Makes a session without files, for pictures of this size.
  ViewSession(int width, int height);

  /// Opens a file in addition to the open ones; the first one is shown as large as the picture allows. Throws
  /// Error, and changes nothing, if it cannot be opened.
  void open(const std::string& path, const DocumentOptions& options, Progress& progress);
  /// Restores a state for the files that are open. Materials and fields that they do not have are left out.
  void restore(const ViewState& state);

  /// The state to be saved for these files.
  [[nodiscard]] ViewState remembered() const;

  [[nodiscard]] ViewState& state() { return state_; }
  [[nodiscard]] const ViewState& state() const { return state_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Document>>& documents() const { return documents_; }
  /// The options with which each file was opened.
  [[nodiscard]] const std::vector<DocumentOptions>& opened_with() const { return opened_with_; }
  /// The box of all files in space.
  [[nodiscard]] Box3 box() const;
  /// Sets the size of pictures. Ignores sizes below one pixel, which minimised windows have.
  void set_size(int width, int height);

  /// The parts that can be drawn now.
  std::vector<DrawnPart> parts();
  /// Waits until these are the parts that the state asks for.
  void finish();
  /// The plane that cuts parts away, if there is one.
  [[nodiscard]] std::optional<Plane> clip() const;
  /// The sums over all documents, and the first problem.
  [[nodiscard]] UpdateReport report() const;
  /// The field that colours show, "value" for a store's samples, and the values at the ends of the colour
  /// map.
  struct ShownField {
    std::string name;
    std::array<double, 2> range;
  };
  /// The shown field; empty if no part is coloured by values.
  [[nodiscard]] std::optional<ShownField> shown_field() const;

  /// Whether the depths of a picture of the present view are wanted, to be passed to set_depths() once per
  /// view.
  [[nodiscard]] bool wants_depths() const;
  void set_depths(std::shared_ptr<const isosurface::DepthPyramid> depths);

  /// Does an action.
  void act(Action action);
  /// What is visible at a place of the picture, in pixels from the upper left corner; empty for the
  /// background.
  [[nodiscard]] std::optional<Picked> pick(double x, double y);
  /// Completes a pending reading with values that are known now.
  void complete(Picked& picked);
  /// Advances everything that plays by some seconds: the steps of series, and the camera, by a turn or along
  /// the recorded path.
  void advance(double seconds);

  /// The times of the steps of the longest series; at most one if there is no series.
  [[nodiscard]] const std::vector<double>& times() const;
  /// The step of that series that is shown.
  [[nodiscard]] std::uint32_t step() const;
  /// The step of the surfaces that are drawn now, which is an earlier one until those of step() are ready.
  [[nodiscard]] std::uint32_t drawn_step() const;
  /// The steps that could not be shown when they were wanted.
  [[nodiscard]] const std::set<std::uint32_t>& lost_steps() const { return lost_steps_; }
  /// Shows a step of all series. A shorter series shows its last step.
  void set_step(std::uint32_t step);
  /// The part of the pages of the present view that is in memory for each step, in ascending order.
  [[nodiscard]] std::vector<LoadedPart> loaded_steps() const;
  /// Starts to play the steps, or pauses.
  void play_steps();
  [[nodiscard]] timevarying::StepClock& clock() { return clock_; }
  [[nodiscard]] const timevarying::StepClock& clock() const { return clock_; }

  /// The viewpoints of the bookmarks, for pictures of the present size.
  [[nodiscard]] std::vector<isosurface::Viewpoint> bookmarked() const;
  /// Whether the camera moves along the bookmarks while steps are played, from the first bookmark in the
  /// first step to the last bookmark in the last step.
  bool has_keyed_camera = false;

  /// The place of the plane's handle: the point of the plane that is nearest to the middle of the data.
  [[nodiscard]] Vec3 cut_handle() const;
  /// Moves the plane along its normal as the mouse drags its handle, by pixels to the right and downwards.
  void drag_cut(double right, double down);

  /// Whether the camera moves by itself.
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  [[nodiscard]] bool is_recording() const { return is_recording_; }
  [[nodiscard]] const std::vector<isosurface::Viewpoint>& path() const { return path_; }

  // These are requests to the window, which resets them when they are done.
  bool has_panels = true, has_help = false, wants_screenshot = false, wants_end = false;
  std::optional<ExportForm> wants_export;
  bool is_exporting = false, wants_export_end = false;

 private:
  void drop_old_depths();
  /// The number of the document that has most steps.
  [[nodiscard]] std::size_t longest_series() const;
  /// Whether the present parts are complete, and the pages of another step are in memory.
  [[nodiscard]] bool is_ready(std::uint32_t step) const;
  void advance_steps(double seconds);
  /// Notes whether the step is lost, once the state's parts are ready or cannot be loaded.
  void note_lost_step();
  void act_on_steps(Action action);
  void look(const Vec3& direction, const Vec3& up);
  void next_field();
  void next_bookmark();
  void toggle_cut();
  void add_box(std::vector<DrawnPart>& parts);
  void add_culled_view(std::vector<DrawnPart>& parts);

  ViewState state_;
  std::vector<std::unique_ptr<Document>> documents_;
  std::vector<DocumentOptions> opened_with_;
  std::set<std::uint32_t> lost_steps_;
  std::optional<std::uint32_t> asked_step_;  ///< the step that the documents were last asked for
  SharedMesh box_lines_, view_lines_;        ///< the lines of drawn_box_ and drawn_view_
  Box3 drawn_box_;
  std::optional<isosurface::Viewpoint> drawn_view_;
  std::vector<DocumentState> depths_of_;  ///< the documents' states when depths were set
  timevarying::StepClock clock_;
  std::size_t bookmark_ = 0;
  bool is_playing_ = false, is_recording_ = false;
  std::vector<isosurface::Viewpoint> path_;
  double played_ = 0;  ///< position of the camera along path_, in viewpoints
};

/// The steps as a text, "step 3" or "steps 3, 4 and 5"; if there are many, only the first ones and the number
/// of the others.
std::string named_steps(const std::set<std::uint32_t>& steps);

/// Writes a camera path as a text that flight() reads.
std::string path_text(const std::vector<isosurface::Viewpoint>& path);

}  // namespace adamas::viewer
