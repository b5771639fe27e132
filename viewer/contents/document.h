#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "isosurface/storage/stored_pages.h"
#include "viewer/contents/drawn_mesh.h"
#include "viewer/contents/view_state.h"

namespace adamas::viewer {

/// The contents of an open file that can be shown.
struct DocumentFacts {
  std::string name;                    ///< the path of the file
  std::string summary;                 ///< the size of the contents, as "64 x 64 x 64 uint8"
  Box3 box;                            ///< the box of the data in space
  std::vector<std::string> materials;  ///< the names of materials; empty for a store
  std::vector<picture::Colour> material_colours;
  std::vector<std::string> fields;      ///< the fields by which surfaces can be coloured
  bool has_isovalues = false;           ///< whether this is a store, whose surfaces are chosen by isovalue
  std::array<double, 2> value_range{};  ///< the range of a store's values in all steps
  /// A histogram of some values of the step that was opened, in equal parts of the range.
  std::vector<std::uint64_t> histogram;
  std::vector<double> times;  ///< the time of each step of a store; empty for other files
};

/// The figures of a document's last update.
struct UpdateReport {
  std::uint64_t triangles = 0, splits = 0, merges = 0;
  std::uint64_t depth_tests = 0, hidden = 0;  ///< see FrameFigures
  double largest_error_pixels = 0;            ///< an estimate
  /// The numbers of pages that are not in memory yet, so that the surface is coarser there, and of pages that
  /// cannot be read.
  std::uint64_t pages_missing = 0, pages_lost = 0;
  double seconds = 0;  ///< the time that the update took
  /// The step of a series whose surfaces are shown, which is an earlier one until those of the wanted step
  /// are ready; empty before the first update.
  std::optional<std::uint32_t> step;
  bool is_current = true;  ///< whether the surfaces are those that the state asks for
  std::string problem;     ///< why something could not be shown; empty if nothing is wrong
};

/// The known values at a place.
struct Reading {
  std::string material;         ///< the name of the material there; empty where there is none
  std::optional<double> value;  ///< the value of the chosen field, or of the samples
  /// The estimated error of the interface or the isosurface there, in units of length.
  std::optional<double> error;
  bool is_pending = false;  ///< whether more of it is being computed, so that it can be requested again
};

/// The part of the pages for a view that is in memory for one step.
struct LoadedPart {
  std::uint32_t step = 0;
  double part = 0;  ///< fraction, 0 to 1, of the pages that the last surfaces are made of

  bool operator==(const LoadedPart&) const = default;
};

/// The pages in memory of all steps of a series.
struct StepsAhead {
  std::vector<LoadedPart> loaded;  ///< all steps with pages in memory, in ascending order
  bool is_reading = false;         ///< whether pages of expected steps are being read

  [[nodiscard]] bool has_all_of(std::uint32_t step) const {
    return std::ranges::find(loaded, LoadedPart{step, 1}) != loaded.end();
  }
};

/// An open file as parts of pictures. Long work is done in threads of the document, so that parts() never
/// waits.
class Document {
 public:
  virtual ~Document() = default;

  [[nodiscard]] virtual const DocumentFacts& facts() const = 0;
  /// Returns the parts that can be drawn now, and requests those that the state wants if these differ.
  virtual std::vector<DrawnPart> parts(const ViewState& view, const DocumentState& state) = 0;
  /// Whether parts() now returns the surfaces that the state asks for, possibly refined for another
  /// viewpoint.
  [[nodiscard]] virtual bool shows_surfaces_of(const DocumentState& state) const = 0;
  /// Waits until parts() returns what the state asks for, or until there is a problem.
  virtual void finish(const ViewState& view, const DocumentState& state) = 0;
  /// Sets which steps are likely to be shown next, the next one first, so that their pages are read in
  /// advance.
  virtual void expect(const std::vector<std::uint32_t>&) {}
  [[nodiscard]] virtual StepsAhead steps_ahead() const { return {}; }
  [[nodiscard]] virtual UpdateReport report() const = 0;
  /// The counts of pages and bytes of a store that were read until the last update.
  [[nodiscard]] virtual PageReads page_counts() const { return {}; }
  /// The values at the ends of the colour map, if a field is chosen or a section shows a store's samples.
  [[nodiscard]] virtual std::optional<std::array<double, 2>> colour_range(
      const ViewState& view, const DocumentState& state) const = 0;
  /// The known values at a place in space. `surface`: the number of the store's surface on which the place
  /// is, as in DrawnPart.
  [[nodiscard]] virtual Reading at(const Vec3& place, const DocumentState& state, std::size_t surface) = 0;
  /// The state in which a newly opened document is shown.
  [[nodiscard]] virtual DocumentState first_state() const = 0;
};

struct DocumentOptions {
  std::size_t memory = std::size_t{256} << 20;  ///< bytes for the decoded pages of a store
  std::string colour_by;  ///< the path of a store whose values colour surfaces; empty for none
  /// The step of a stored series that is shown first, from 0. A store of one step ignores it.
  std::uint32_t step = 0;
  /// Whether surfaces wait for the pages that they need. Otherwise they are coarser at first and are refined
  /// as pages arrive.
  bool waits_for_pages = true;
  /// Whether the vertex shader interpolates points and normals of a store's surfaces. Otherwise, and on
  /// oblique grids, and if another store colours surfaces, the processor does it.
  bool interpolates_in_shader = false;
};

/// Opens a store, a resampled mesh, a saved hierarchy or interfaces. Throws Error for another file.
std::unique_ptr<Document> open_document(const std::string& path, const DocumentOptions& options,
                                        Progress& progress);

/// Opens a resampled mesh, a saved hierarchy or interfaces. The document shows materials, their fields, and a
/// plane's cross section, which a thread computes. Throws Error for another file.
std::unique_ptr<Document> open_material_document(const std::string& path, Progress& progress);

/// Opens a store. The document shows the surfaces of its isovalues, which a thread refines for the viewpoint.
/// Throws Error if the file is no store, or if its tables are damaged.
std::unique_ptr<Document> open_store_document(const std::string& path, const DocumentOptions& options);

}  // namespace adamas::viewer
