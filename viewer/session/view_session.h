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
#include "viewer/document/document.h"
#include "viewer/document/drawn_mesh.h"
#include "viewer/document/view_state.h"
#include "viewer/session/actions.h"

namespace adamas::viewer {

/// What a click has met.
struct Picked {
  std::string document;
  Vec3 place;
  Reading reading;
  std::size_t number = 0, surface = 0;  ///< of the document, and of its surfaces
};

/// What the steps of a series are written as: one film, or a picture of each.
enum class ExportForm : std::uint8_t { kFilm, kFrames };

/// Files that are looked at together, and how: all of a viewer that needs neither a window nor OpenGL. What
/// the panels change is state() itself.
class ViewSession {
 public:
  /// For pictures of this size.
  ViewSession(int width, int height);

  /// Opens a file beside those that are open; the first one is shown as large as the picture allows. Throws
  /// Error, and leaves all as it was, where it cannot be opened.
  void open(const std::string& path, const DocumentOptions& options, Progress& progress);
  /// Takes a state over, for the files that are open; materials and fields that they have not are left out.
  void restore(const ViewState& state);

  /// What is to be remembered of how the files are looked at.
  [[nodiscard]] ViewState remembered() const;

  [[nodiscard]] ViewState& state() { return state_; }
  [[nodiscard]] const ViewState& state() const { return state_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Document>>& documents() const { return documents_; }
  /// How they were opened.
  [[nodiscard]] const std::vector<DocumentOptions>& opened_with() const { return opened_with_; }
  /// Of all files, in space.
  [[nodiscard]] Box3 box() const;
  /// Ignores sizes below one pixel, as windows have when they are folded away.
  void set_size(int width, int height);

  /// What is to be drawn by now.
  std::vector<DrawnPart> parts();
  /// Waits until that is what the state asks for.
  void finish();
  /// What cuts parts away.
  [[nodiscard]] std::optional<Plane> clip() const;
  /// Of all documents together; the first problem.
  [[nodiscard]] UpdateReport report() const;
  /// The field that colours show, "value" where it is a store's samples, with the values at the ends of the
  /// colour map; none where nothing is coloured by values.
  struct ShownField {
    std::string name;
    std::array<double, 2> range;
  };
  [[nodiscard]] std::optional<ShownField> shown_field() const;

  /// Whether a picture of now is to tell what it hides, by set_depths(): once for each view.
  [[nodiscard]] bool wants_depths() const;
  void set_depths(std::shared_ptr<const isosurface::DepthPyramid> depths);

  void act(Action action);
  /// What lies at a place of the picture, in pixels from the upper left corner.
  [[nodiscard]] std::optional<Picked> pick(double x, double y);
  /// Adds to what was picked what has come to be known of it by now.
  void complete(Picked& picked);
  /// Moves on what plays: the steps of series; the camera, by a turn or along the recorded path.
  void advance(double seconds);

  /// The times of the steps of the file that has most of them; one or none where there is no series.
  [[nodiscard]] const std::vector<double>& times() const;
  /// Which of these is seen.
  [[nodiscard]] std::uint32_t step() const;
  /// Which of them the surfaces are of that are drawn by now: an earlier one until those of that are there.
  [[nodiscard]] std::uint32_t drawn_step() const;
  /// Those that could not be shown when they were wanted.
  [[nodiscard]] const std::set<std::uint32_t>& lost_steps() const { return lost_steps_; }
  /// Shows a step of all series; of shorter ones the last step.
  void set_step(std::uint32_t step);
  /// How much of what is drawn is in memory of each step of which there is anything, in ascending order.
  [[nodiscard]] std::vector<LoadedPart> loaded_steps() const;
  /// Plays the steps, or pauses.
  void play_steps();
  [[nodiscard]] timevarying::StepClock& clock() { return clock_; }
  [[nodiscard]] const timevarying::StepClock& clock() const { return clock_; }

  /// The viewpoints of the bookmarks, for pictures of the present size.
  [[nodiscard]] std::vector<isosurface::Viewpoint> bookmarked() const;
  /// Whether the camera goes along these, from the first in the first step to the last in the last one, while
  /// steps are played.
  bool has_keyed_camera = false;

  /// Where the handle of the plane is: the place of it that is nearest to the middle of the data.
  [[nodiscard]] Vec3 cut_handle() const;
  /// Moves the plane along its normal, as the mouse moved its handle.
  void drag_cut(double right, double down);

  /// Whether the camera moves by itself.
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  [[nodiscard]] bool is_recording() const { return is_recording_; }
  [[nodiscard]] const std::vector<isosurface::Viewpoint>& path() const { return path_; }

  // What the window does when it is asked, and takes back.
  bool has_panels = true, has_help = false, wants_screenshot = false, wants_end = false;
  std::optional<ExportForm> wants_export;
  bool is_exporting = false, wants_export_end = false;

 private:
  void drop_old_depths();
  /// The number of the file that has most steps.
  [[nodiscard]] std::size_t longest_series() const;
  /// Whether what there is to be drawn is whole, and that of another step would be.
  [[nodiscard]] bool is_ready(std::uint32_t step) const;
  void advance_steps(double seconds);
  /// Once what the state asks for is there, or cannot be had.
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
  std::optional<std::uint32_t> asked_step_;  ///< what the documents were asked for last
  SharedMesh box_lines_, view_lines_;        ///< of drawn_box_, drawn_view_
  Box3 drawn_box_;
  std::optional<isosurface::Viewpoint> drawn_view_;
  std::vector<DocumentState> depths_of_;  ///< what was shown when depths were set
  timevarying::StepClock clock_;
  std::size_t bookmark_ = 0;
  bool is_playing_ = false, is_recording_ = false;
  std::vector<isosurface::Viewpoint> path_;
  double played_ = 0;  ///< how far, in viewpoints
};

/// "step 3", or "steps 3, 4 and 5"; of many some are named alone, and how many more there are.
std::string named_steps(const std::set<std::uint32_t>& steps);

/// The path as a text that flight() reads.
std::string path_text(const std::vector<isosurface::Viewpoint>& path);

}  // namespace adamas::viewer
