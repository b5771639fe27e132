#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/scene/actions.h"
#include "viewer/scene/document.h"
#include "viewer/scene/drawn_mesh.h"
#include "viewer/scene/view_state.h"

namespace adamas {

/// What a click has met.
struct Picked {
  std::string document;
  Vec3 place;
  Reading reading;
  std::size_t number = 0, surface = 0;  ///< of the document, and of its surfaces
};

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

  [[nodiscard]] ViewState& state() { return state_; }
  [[nodiscard]] const ViewState& state() const { return state_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Document>>& documents() const { return documents_; }
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
  void set_depths(std::shared_ptr<const DepthPyramid> depths);

  void act(Action action);
  /// What lies at a place of the picture, in pixels from the upper left corner.
  [[nodiscard]] std::optional<Picked> pick(double x, double y);
  /// Adds to what was picked what has come to be known of it by now.
  void complete(Picked& picked);
  /// Moves the camera on where it plays: by a turn, or along the recorded path.
  void advance(double seconds);

  /// Where the handle of the plane is: the place of it that is nearest to the middle of the data.
  [[nodiscard]] Vec3 cut_handle() const;
  /// Moves the plane along its normal, as the mouse moved its handle.
  void drag_cut(double right, double down);

  [[nodiscard]] bool is_playing() const { return is_playing_; }
  [[nodiscard]] bool is_recording() const { return is_recording_; }
  [[nodiscard]] const std::vector<Viewpoint>& path() const { return path_; }

  // What the window does when it is asked, and takes back.
  bool has_panels = true, has_help = false, wants_screenshot = false, wants_end = false;

 private:
  void drop_old_depths();
  void look(const Vec3& direction, const Vec3& up);
  void next_field();
  void next_bookmark();
  void toggle_cut();
  void add_box(std::vector<DrawnPart>& parts);
  void add_culled_view(std::vector<DrawnPart>& parts);

  ViewState state_;
  std::vector<std::unique_ptr<Document>> documents_;
  SharedMesh box_lines_, view_lines_;  ///< of drawn_box_, drawn_view_
  Box3 drawn_box_;
  std::optional<Viewpoint> drawn_view_;
  std::vector<DocumentState> depths_of_;  ///< what was shown when depths were set
  std::size_t bookmark_ = 0;
  bool is_playing_ = false, is_recording_ = false;
  std::vector<Viewpoint> path_;
  double played_ = 0;  ///< how far, in viewpoints
};

/// The path as a text that flight() reads.
std::string path_text(const std::vector<Viewpoint>& path);

}  // namespace adamas
