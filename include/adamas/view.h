#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/camera_path.h"
#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/steps.h"
#include "adamas/volume_store.h"

namespace adamas ADAMAS_API {

/// The way in which surfaces are shaded.
enum class Shading {
  kLit,     ///< a light beside the eye
  kSphere,  ///< after D: the colour depends on the direction of the normal in the view, silhouettes are dark
};

/// Options of `adamas view`: what is shown, and how. An option that is not given keeps the value of the
/// state, or the viewer's default.
struct ViewOptions {
  /// Stores (.adm), resampled meshes (.vtu), saved hierarchies (.h5) and interfaces (.vtp, .ply, .arec,
  /// .txt).
  std::vector<std::filesystem::path> files;
  std::size_t memory = kDefaultPageMemory;  ///< bytes that the decoded pages of a store may take
  /// Whether surfaces wait for the pages of stores that they need. Otherwise they are coarser at first, and
  /// sharpen as pages come. None: they wait off-screen, and not in a window.
  std::optional<bool> waits_for_pages{};
  /// Whether the vertex shader interpolates points and normals of a store's surfaces, not the processor.
  bool interpolates_in_shader = false;
  std::filesystem::path colour_by{};         ///< another store, whose values colour surfaces; empty for none
  std::filesystem::path state{};             ///< a state that the window remembered (JSON); empty for none
  bool fresh = false;                        ///< whether a window ignores how these files were viewed last
  std::optional<std::array<int, 2>> size{};  ///< width and height in pixels, 16 to 8192

  /// Isovalues of a store's surfaces; empty: the one that separates the samples best.
  std::vector<double> isovalues{};
  /// Opacities of the first of these surfaces, above 0 to 1; the others have 1.
  std::vector<double> opacities{};
  std::string field{};  ///< the field that colours show, NAME or NAME:x of a vector
  /// The values at the ends of the colour map, of the field or of a store's section.
  std::optional<std::array<double, 2>> range{};
  std::string colour_map{};                  ///< one of colour_map_names()
  std::vector<std::string> hidden{};         ///< materials that are not shown
  std::optional<Plane> plane{};              ///< a plane that cuts; its normal points to what is cut away
  bool cuts_away = true;                     ///< whether the plane cuts anything away
  bool shows_section = true;                 ///< whether the plane shows its section
  std::optional<CameraPlace> culled_from{};  ///< the camera for which meshes are refined and culled
  std::optional<Shading> shading{};
  bool edges = false;      ///< show edges of triangles and of cells
  bool plain = false;      ///< omit axes, box, colour bar and time
  bool show_time = false;  ///< write the time and the number of a series' step on pictures even with `plain`

  /// The greatest visible isosurface error, an estimate of the distance to the surface of all samples, in
  /// pixels.
  std::optional<double> pixels{};
  std::optional<std::uint64_t> max_triangles{};  ///< limit of the triangles of a store's surfaces in a frame
  /// Time for the mesh of a frame while the view moves, up to 1e6.
  std::optional<double> frame_milliseconds{};
  bool occlusion = false;               ///< surfaces of stores stay coarse where the picture hides them
  std::optional<std::uint64_t> step{};  ///< the step of stored series that is shown
};

/// Options of pictures without a window.
struct FlightOptions {
  /// The path of the camera. None: the view of the state; without a state an orbit of 36 frames, or with
  /// steps its first viewpoint.
  std::optional<CameraPath> camera_path{};
  bool along_bookmarks = false;  ///< the camera goes along the bookmarks of the state instead
  /// The first and the last step of a stored series: a frame of each, while the camera goes along its path.
  std::optional<StepRange> steps{};
  std::filesystem::path frames{};      ///< a new folder for frame0001.png and so on; empty for none
  bool overwrite = false;              ///< replace such a folder that is there
  std::filesystem::path film{};        ///< .mp4, .webm or .gif, by the program ffmpeg; empty for none
  std::optional<double> frame_rate{};  ///< frames of the film per second; none: 10
};

/// Figures of a frame.
struct ViewedFrame {
  std::string problem{};                ///< the reason why it could not be drawn; empty where it was
  std::optional<std::uint32_t> step{};  ///< for a series: the step, and its time
  double time = 0;
  std::uint64_t triangles = 0;           ///< triangles of surfaces of stores
  std::uint64_t splits = 0, merges = 0;  ///< changes of the mesh since the frame before
  /// The number of diamonds of meshes that the picture hides, and of those that were looked up.
  std::uint64_t occluded_diamonds = 0, occlusion_queries = 0;
  double largest_error_pixels = 0;  ///< an estimate
  std::uint64_t pages_missing = 0, pages_lost = 0;
  std::uint64_t rendered_triangles = 0, draw_calls = 0, copied_bytes = 0;
  double update_seconds = 0, draw_seconds = 0;
};

/// The result of OffscreenFlight::draw().
struct FlightReport {
  std::string drawn_by;  ///< the provider of the OpenGL context, and the device
  std::vector<ViewedFrame> frames;
  /// Reads of the stores: pages, pages that others are predicted from, their bytes, and pages that were taken
  /// from second copies or are damaged.
  std::uint64_t pages = 0, predictor_pages = 0, bytes = 0, copied_pages = 0, damaged_pages = 0;
};

/// Pictures of files without a window, drawn by a graphics device or the processor.
class OffscreenFlight {
 public:
  /// Opens the files. `outputs` takes the film and gives it its name; the files are inputs that no output may
  /// overwrite. The progress gets a note where the first of several steps is shown. Throws Error for values
  /// out of range and options that contradict each other, a file that cannot be opened, a field or a material
  /// that no file has, and where pictures cannot be written.
  OffscreenFlight(const ViewOptions& view, const FlightOptions& flight, OutputSet& outputs,
                  Progress& progress = SilentProgress::instance());
  OffscreenFlight(OffscreenFlight&&) noexcept;
  OffscreenFlight& operator=(OffscreenFlight&&) noexcept;
  ~OffscreenFlight();

  /// Draws all frames. Frames of damaged steps are left out, of which the progress gets notes. Throws Error
  /// where no frame can be drawn, and Cancelled where the progress says so.
  FlightReport draw(Progress& progress = SilentProgress::instance());
  /// Completes the pictures and the film. Throws Error where they cannot be written.
  void finish();
  /// Gives the folder of the pictures its name; the outputs do so with the film.
  void commit();

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

/// Files in a window.
class ViewWindow {
 public:
  /// Opens the files, as they were viewed last unless the options say otherwise. Throws Error as
  /// OffscreenFlight does.
  explicit ViewWindow(const ViewOptions& view, Progress& progress = SilentProgress::instance());
  ViewWindow(ViewWindow&&) noexcept;
  ViewWindow& operator=(ViewWindow&&) noexcept;
  ~ViewWindow();

  /// Shows the window until the user closes it, or the progress is cancelled, and remembers how the files
  /// were viewed. Throws Error where there is no display or no OpenGL 4.5, and Cancelled.
  void show(Progress& progress = SilentProgress::instance());

 private:
  struct Contents;
  std::unique_ptr<Contents> contents_;
};

}  // namespace adamas
