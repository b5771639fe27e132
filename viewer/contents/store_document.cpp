#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/data/volume_placement.h"
#include "viewer/contents/document.h"
#include "viewer/contents/open_store.h"
#include "viewer/contents/store_section.h"
#include "viewer/contents/surface_worker.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

constexpr std::size_t kHistogramParts = 256;
constexpr std::size_t kNoSurface = std::numeric_limits<std::size_t>::max();
/// The colour of a section where it has no value.
constexpr Colour kNoValue{0.75, 0.75, 0.75};
constexpr Colour kCellEdges{0.25, 0.25, 0.28};

Viewpoint in_frame(const VolumeGrid& grid, const Viewpoint& viewpoint) {
  if (grid.is_straight()) return viewpoint;
  Viewpoint result = viewpoint;
  result.eye = grid.in_frame(viewpoint.eye);
  result.target = grid.in_frame(viewpoint.target);
  result.up = grid.in_frame(viewpoint.eye + viewpoint.up) - result.eye;
  return result;
}

/// The range of the values of all steps, so that colours have one meaning. `some`: values of one step.
std::array<double, 2> range_of(const std::vector<double>& some, const OpenStore& store) {
  const auto [least, greatest] = std::ranges::minmax(some);
  return store.extended_by_steps({least, greatest});
}

class StoreDocument final : public Document {
 public:
  StoreDocument(const std::string& path, const DocumentOptions& options)
      : store_(OpenStore::open(path, options.memory, options.step)),
        colours_(options.colour_by.empty()
                     ? nullptr
                     : OpenStore::open(options.colour_by, options.memory, options.step)),
        worker_(*store_, colours_.get(), options),
        section_(*store_, colours_.get()) {
    const VolumeGrid& grid = store_->grid();
    check_two_samples(path, grid);
    facts_.times = store_->file().times();
    if (facts_.times.size() > 1) first_step_ = options.step;
    facts_.name = path;
    facts_.summary = fmt::format("{} x {} x {} {}", grid.dimensions[0], grid.dimensions[1],
                                 grid.dimensions[2], sample_name(grid.type));
    facts_.box = grid.box();
    facts_.has_isovalues = true;
    fill_histogram(options.step);
    if (!colours_) return;
    const std::uint32_t steps = colours_->file().steps();
    if (steps != 1 && steps != facts_.times.size())
      fail("{}: expected one step or the {} of {}, found {}", options.colour_by, facts_.times.size(), path,
           steps);
    facts_.fields = {std::filesystem::path(options.colour_by).filename().string()};
    const std::vector<double> some = colours_->some_values(options.step);
    if (some.empty()) fail("{}: expected finite samples to colour by, found none", options.colour_by);
    colour_range_ = range_of(some, *colours_);
  }

  [[nodiscard]] const DocumentFacts& facts() const override { return facts_; }

  std::vector<DrawnPart> parts(const ViewState& view, const DocumentState& state) override {
    // If it is not known yet what a view hides, a mesh for it is not worth computing, except for the first
    // one.
    const bool waits =
        view.leaves_out_hidden && !view.depths && !view.culled_from && shows_surfaces_of(state);
    if (!waits) worker_.want(wanted(view, state));
    const std::shared_ptr<const FoundSurfaces> found = worker_.found();
    std::vector<DrawnPart> result;
    if (view.cut.has_section()) add_section(view, state, result);
    if (!found) return result;
    if (view.has_edges && view.cut.has_section() && found->cell_edges) {
      PartStyle style;
      style.front = style.back = kCellEdges;
      style.is_flat = true;
      result.push_back({found->cell_edges, style, kNoSurface});
    }
    const std::vector<const SurfaceState*> shown = shown_surfaces(state);
    // If the number of wanted surfaces has changed, the first ones are shown until the new ones are ready.
    for (std::size_t n = 0; n < std::min(shown.size(), found->surfaces.size()); ++n) {
      PartStyle style;
      style.front = shown[n]->colour;
      style.back = mix(shown[n]->colour, {0.45, 0.25, 0.22}, 0.6);
      style.opacity = shown[n]->opacity;
      style.is_coloured_by_value = !state.field.empty();
      if (const auto range = colour_range(view, state))
        std::tie(style.low, style.high) = std::pair((*range)[0], (*range)[1]);
      style.is_clipped = true;
      style.has_edges = view.has_edges;
      for (const SharedMesh& chunk : found->surfaces[n])
        result.push_back({chunk, style, n, found->isovalues[n]});
    }
    return result;
  }

  [[nodiscard]] bool shows_surfaces_of(const DocumentState& state) const override {
    const std::shared_ptr<const FoundSurfaces> found = worker_.found();
    return found && found->step == state.step && found->wanted.isovalues == isovalues_of(state);
  }

  void finish(const ViewState& view, const DocumentState& state) override {
    // They wait one after the other, so that the order of reads is always the same.
    const WantedSurfaces all = wanted(view, state);
    if (view.cut.has_section()) {
      section_.want(wanted_section(view, state));
      section_.wait_for(wanted_section(view, state));
    }
    worker_.want(all);
    worker_.wait_for(all);
  }

  void expect(const std::vector<std::uint32_t>& steps) override {
    std::vector<std::uint32_t> known = steps;
    std::erase_if(known, [&](std::uint32_t step) { return step >= facts_.times.size(); });
    if (facts_.times.size() > 1) worker_.expect(known);
  }
  [[nodiscard]] StepsAhead steps_ahead() const override { return worker_.steps_ahead(); }

  [[nodiscard]] UpdateReport report() const override {
    const std::shared_ptr<const FoundSurfaces> found = worker_.found();
    UpdateReport report = found ? found->report : UpdateReport{};
    report.is_current = worker_.is_current() && section_.is_current();
    if (const auto section = section_.found(); section && report.problem.empty())
      report.problem = section->problem;
    return report;
  }

  [[nodiscard]] PageReads page_counts() const override {
    const std::shared_ptr<const FoundSurfaces> found = worker_.found();
    return found ? found->counts : PageReads{};
  }

  [[nodiscard]] std::optional<std::array<double, 2>> colour_range(const ViewState& view,
                                                                  const DocumentState& state) const override {
    const bool has_field = !state.field.empty() && !facts_.fields.empty();
    if (!has_field && !view.cut.has_section()) return std::nullopt;
    if (state.range) return state.range;
    return has_field ? colour_range_ : facts_.value_range;
  }

  [[nodiscard]] Reading at(const Vec3& place, const DocumentState& state, std::size_t surface) override {
    const std::shared_ptr<const FoundSurfaces> found = worker_.found();
    return worker_.reading_at({surface, place, found ? found->step : state.step});
  }

  [[nodiscard]] DocumentState first_state() const override {
    DocumentState state;
    SurfaceState surface;
    surface.isovalue = first_isovalue();
    state.surfaces.push_back(surface);
    state.step = first_step_;
    if (!facts_.fields.empty()) state.field = facts_.fields[0];
    return state;
  }

 private:
  [[nodiscard]] StoreSection::Wanted wanted_section(const ViewState& view, const DocumentState& state) const {
    return section_.wanted(view.cut.plane, view.viewpoint, !state.field.empty(), state.step);
  }
  /// Requests the section, and adds the one that is ready.
  void add_section(const ViewState& view, const DocumentState& state, std::vector<DrawnPart>& parts) {
    section_.want(wanted_section(view, state));
    const auto found = section_.found();
    if (!found || !found->mesh) return;
    PartStyle style;
    style.front = style.back = kNoValue;
    style.is_flat = true;
    style.is_coloured_by_value = true;
    if (const auto range = colour_range(view, state))
      std::tie(style.low, style.high) = std::pair((*range)[0], (*range)[1]);
    parts.push_back({found->mesh, style, kNoSurface});
  }

  void fill_histogram(std::uint32_t step) {
    const std::vector<double> some = store_->some_values(step);
    facts_.histogram.assign(kHistogramParts, 0);
    if (some.empty()) return;
    facts_.value_range = range_of(some, *store_);
    const auto [least, greatest] = facts_.value_range;
    const double width = greatest > least ? greatest - least : 1;
    for (const double value : some) {
      const auto part = static_cast<std::size_t>((value - least) / width * kHistogramParts);
      ++facts_.histogram[std::min(part, kHistogramParts - 1)];
    }
  }

  /// The threshold by Otsu 1979: the values on both sides of it differ most from each other.
  [[nodiscard]] double first_isovalue() const {
    double all = 0, sum = 0;
    for (std::size_t n = 0; n < kHistogramParts; ++n) {
      all += static_cast<double>(facts_.histogram[n]);
      sum += static_cast<double>(n) * static_cast<double>(facts_.histogram[n]);
    }
    double below = 0, sum_below = 0, best = -1;
    std::size_t threshold = kHistogramParts / 2;
    for (std::size_t n = 0; n + 1 < kHistogramParts; ++n) {
      below += static_cast<double>(facts_.histogram[n]);
      sum_below += static_cast<double>(n) * static_cast<double>(facts_.histogram[n]);
      if (below == 0 || below == all) continue;
      const double apart = sum_below / below - (sum - sum_below) / (all - below);
      const double between = below * (all - below) * apart * apart;
      if (between > best) {
        best = between;
        threshold = n + 1;
      }
    }
    const auto [least, greatest] = facts_.value_range;
    return least + (greatest - least) * static_cast<double>(threshold) / kHistogramParts;
  }

  static std::vector<const SurfaceState*> shown_surfaces(const DocumentState& state) {
    std::vector<const SurfaceState*> shown;
    for (const SurfaceState& surface : state.surfaces) {
      if (surface.is_shown && surface.opacity > 0) shown.push_back(&surface);
    }
    return shown;
  }

  [[nodiscard]] WantedSurfaces wanted(const ViewState& view, const DocumentState& state) const {
    const VolumeGrid& grid = store_->grid();
    WantedSurfaces result;
    result.viewpoint = in_frame(grid, view.culled_from ? *view.culled_from : view.viewpoint);
    result.pixels = view.pixels;
    result.max_triangles = view.max_triangles;
    result.seconds = 1e-3 * view.frame_milliseconds;
    // Boxes of diamonds are in the frame, which is space if axes are straight.
    if (view.leaves_out_hidden && grid.is_straight() && view.depths &&
        view.depths->viewpoint() == result.viewpoint)
      result.depths = view.depths;
    result.isovalues = isovalues_of(state);
    result.step = state.step;
    if (view.has_edges && view.cut.has_section())
      result.cells_in = {view.cut.plane.origin, view.cut.plane.normal};
    return result;
  }

  /// The isovalues of all shown surfaces, in units of samples.
  [[nodiscard]] std::vector<double> isovalues_of(const DocumentState& state) const {
    std::vector<double> isovalues;
    for (const SurfaceState* surface : shown_surfaces(state))
      isovalues.push_back(store_->grid().sample(surface->isovalue));
    return isovalues;
  }

  DocumentFacts facts_;
  std::unique_ptr<OpenStore> store_, colours_;  ///< colours_: null if surfaces are not coloured
  std::array<double, 2> colour_range_{};
  std::uint32_t first_step_ = 0;
  SurfaceWorker worker_;
  StoreSection section_;
};

}  // namespace

std::unique_ptr<Document> open_store_document(const std::string& path, const DocumentOptions& options) {
  return std::make_unique<StoreDocument>(path, options);
}

}  // namespace adamas::viewer
