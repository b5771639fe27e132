#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/progress.h"
#include "core/geometry/vec3.h"
#include "isosurface/storage/stored_pages.h"
#include "viewer/document/drawn_mesh.h"
#include "viewer/document/view_state.h"

namespace adamas::viewer {

/// What a file has to be looked at.
struct DocumentFacts {
  std::string name;                    ///< of the file
  std::string summary;                 ///< its size in its own terms
  Box3 box;                            ///< in space
  std::vector<std::string> materials;  ///< of interfaces; none of a store
  std::vector<picture::Colour> material_colours;
  std::vector<std::string> fields;       ///< that colours may show
  bool has_isovalues = false;            ///< a store, whose surfaces are chosen
  std::array<double, 2> value_range{};   ///< of a store's samples, in all steps
  std::vector<std::uint64_t> histogram;  ///< of some of the step that was opened, in equal parts of the range
  std::vector<double> times;             ///< of a store's steps, one or several; none of other files
};

/// What the last update of a document came to.
struct UpdateReport {
  std::uint64_t triangles = 0, splits = 0, merges = 0;
  std::uint64_t depth_tests = 0, hidden = 0;  ///< as FrameFigures has them
  double largest_error_pixels = 0;            ///< an estimate
  /// Pages that the surface does without for now, so that it is coarser there; and those that it wants and
  /// that cannot be had.
  std::uint64_t pages_missing = 0, pages_lost = 0;
  double seconds = 0;  ///< to work it out
  /// Of a series: whose surfaces are shown, an earlier one until another is there; none before the first.
  std::optional<std::uint32_t> step;
  bool is_current = true;  ///< it is what the state asks for
  std::string problem;     ///< why it could not be had; empty: nothing
};

/// What is known of a place.
struct Reading {
  std::string material;         ///< empty: none
  std::optional<double> value;  ///< of the chosen field, or of the samples
  std::optional<double> error;  ///< of the interface or the isosurface there, an estimate, in units of length
  bool is_pending = false;      ///< more of it is being worked out: it may be asked for again
};

/// How much of what a view needs is in memory of a step of a series.
struct LoadedPart {
  std::uint32_t step = 0;
  double part = 0;  ///< of the pages that the last surfaces are made of; 1: all

  bool operator==(const LoadedPart&) const = default;
};

/// Steps of a series besides the one that was found last.
struct StepsAhead {
  std::vector<LoadedPart> loaded;  ///< those of all steps of which there is anything, in ascending order
  bool is_reading = false;         ///< more is on its way of those that are expected

  [[nodiscard]] bool has_all_of(std::uint32_t step) const {
    return std::ranges::find(loaded, LoadedPart{step, 1}) != loaded.end();
  }
};

/// An open file, as parts of pictures. What takes long goes on in a thread of its own: parts() never waits.
class Document {
 public:
  virtual ~Document() = default;

  [[nodiscard]] virtual const DocumentFacts& facts() const = 0;
  /// What there is to be drawn, and asks for what the state wants where that is something else.
  virtual std::vector<DrawnPart> parts(const ViewState& view, const DocumentState& state) = 0;
  /// Whether what parts() gives by now is of the surfaces that the state asks for, from wherever they are
  /// seen.
  [[nodiscard]] virtual bool shows_surfaces_of(const DocumentState& state) const = 0;
  /// Waits until parts() gives what the state asks for, or there is a problem.
  virtual void finish(const ViewState& view, const DocumentState& state) = 0;
  /// Which steps are expected to be wanted next, the next one first: their pages are read meanwhile.
  virtual void expect(const std::vector<std::uint32_t>&) {}
  [[nodiscard]] virtual StepsAhead steps_ahead() const { return {}; }
  [[nodiscard]] virtual UpdateReport report() const = 0;
  /// What reading a store has met with until the last update.
  [[nodiscard]] virtual isosurface::PageCounts page_counts() const { return {}; }
  /// The values at the ends of the colour map, where a field is chosen, or a section shows a store's samples.
  [[nodiscard]] virtual std::optional<std::array<double, 2>> colour_range(
      const ViewState& view, const DocumentState& state) const = 0;
  /// `surface`: which of a store's surfaces the place is on, as DrawnPart has it.
  [[nodiscard]] virtual Reading at(const Vec3& place, const DocumentState& state, std::size_t surface) = 0;
  /// What is shown of it at first.
  [[nodiscard]] virtual DocumentState first_state() const = 0;
};

struct DocumentOptions {
  std::size_t memory = std::size_t{256} << 20;  ///< bytes that the decoded pages of a store may take
  std::string colour_by;                        ///< another store, whose values colour surfaces; empty: none
  /// Of a stored series: which step is seen first, from 0 on. A store of one step has that alone.
  std::uint32_t step = 0;
  /// Whether surfaces wait for the pages that they need. Otherwise they are coarser at first, and sharpen as
  /// pages come.
  bool waits_for_pages = true;
  /// Whether points and normals of a store's surfaces are interpolated by the vertex shader. Otherwise, where
  /// grids are oblique and where another store colours surfaces, the processor does it.
  bool interpolates_in_shader = false;
};

/// Opens a store, a resampled mesh, a saved hierarchy or interfaces. Throws Error for another file.
std::unique_ptr<Document> open_document(const std::string& path, const DocumentOptions& options,
                                        Progress& progress);

}  // namespace adamas::viewer
