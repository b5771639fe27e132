#include "viewer/scene/store_document.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <limits>
#include <mutex>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "core/base/error.h"
#include "core/data/volume_placement.h"
#include "viewer/scene/store_frames.h"
#include "viewer/scene/volume_values.h"

namespace adamas {

namespace {

constexpr std::size_t kHistogramParts = 256;

std::array<float, 3> in_single(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// What the surfaces of a store depend on.
struct Wanted {
  Viewpoint viewpoint;            ///< in the frame of the grid
  std::vector<double> isovalues;  ///< of samples
  double pixels = 1;
  std::uint64_t max_triangles = 0;
  std::shared_ptr<const DepthPyramid> depths;

  bool operator==(const Wanted&) const = default;
};

/// What was found for that.
struct Found {
  Wanted wanted;
  std::vector<std::vector<SharedMesh>> surfaces;  ///< of each isovalue: the chunks
  UpdateReport report;
  PageCounts counts;
};

void add(const PageCounts& some, PageCounts& all) {
  all.pages += some.pages;
  all.predictors += some.predictors;
  all.bytes += some.bytes;
  all.copies += some.copies;
  all.damaged += some.damaged;
}

Viewpoint in_frame(const VolumeGrid& grid, const Viewpoint& viewpoint) {
  if (grid.is_straight()) return viewpoint;
  Viewpoint result = viewpoint;
  result.eye = grid.in_frame(viewpoint.eye);
  result.target = grid.in_frame(viewpoint.target);
  result.up = grid.in_frame(viewpoint.eye + viewpoint.up) - result.eye;
  return result;
}

/// Works out surfaces in a thread of its own, those of the newest wish.
class SurfaceWorker {
 public:
  SurfaceWorker(const std::string& path, const DocumentOptions& options)
      : file_(path),
        memory_(options.memory),
        colours_(options.colour_by.empty() ? nullptr : VolumeValues::open(options.colour_by, options.memory)),
        thread_([this] { run(); }) {}
  SurfaceWorker(const SurfaceWorker&) = delete;
  SurfaceWorker& operator=(const SurfaceWorker&) = delete;
  ~SurfaceWorker() {
    {
      const std::lock_guard lock(mutex_);
      is_ended_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  [[nodiscard]] const StoreFile& file() const { return file_; }

  void want(const Wanted& wanted) {
    {
      const std::lock_guard lock(mutex_);
      if (wanted_ == wanted) return;
      wanted_ = wanted;
    }
    changed_.notify_all();
  }

  /// What was found last, for whatever was wanted then.
  [[nodiscard]] std::shared_ptr<const Found> found() const {
    const std::lock_guard lock(mutex_);
    return found_;
  }

  void wait_for(const Wanted& wanted) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return found_ && found_->report.is_current && found_->wanted == wanted; });
  }

 private:
  void run() {
    Wanted done;
    while (true) {
      Wanted wanted;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return is_ended_ || (wanted_ && *wanted_ != done); });
        if (is_ended_) return;
        wanted = *wanted_;
      }
      // A rough surface comes at once where there was another one.
      if (wanted.isovalues != done.isovalues) update(wanted, kRough);
      if (is_overtaken(wanted)) continue;
      update(wanted, 1);
      done = std::move(wanted);
    }
  }

  /// Whether the surfaces that are worked out are not those that are wanted by now.
  [[nodiscard]] bool is_overtaken(const Wanted& wanted) const {
    const std::lock_guard lock(mutex_);
    return is_ended_ || wanted_->isovalues != wanted.isovalues;
  }

  void update(const Wanted& wanted, std::uint64_t roughness) {
    auto found = std::make_shared<Found>();
    found->wanted = wanted;
    const auto before = std::chrono::steady_clock::now();
    try {
      for (std::size_t n = 0; n < wanted.isovalues.size(); ++n) {
        if (!add_surface(*found, n, roughness)) return;
      }
    } catch (const std::exception& error) {
      // What there is stays to be seen.
      found->report.problem = error.what();
      if (const auto last = this->found()) found->surfaces = last->surfaces;
    }
    found->report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    found->report.is_current = roughness == 1;
    {
      const std::lock_guard lock(mutex_);
      found_ = std::move(found);
    }
    changed_.notify_all();
  }

  /// The frames of an isovalue, and what is drawn of them: by the ids of chunks, as of a revision.
  struct Surface {
    struct Drawn {
      std::uint64_t revision = 0;
      SharedMesh mesh;
    };
    std::unique_ptr<StoreFrames> frames;
    std::unordered_map<std::uint64_t, Drawn> drawn;
  };

  /// Returns false where something else is wanted by now.
  bool add_surface(Found& found, std::size_t n, std::uint64_t roughness) {
    while (surfaces_.size() <= n) surfaces_.push_back({StoreFrames::open(file_, memory_), {}});
    const Wanted& wanted = found.wanted;
    FrameRequest request;
    request.viewpoint = wanted.viewpoint;
    request.depths = wanted.depths;
    request.isovalue = wanted.isovalues[n];
    request.pixels = wanted.pixels * static_cast<double>(roughness);
    request.max_triangles =
        std::max<std::uint64_t>(1, wanted.max_triangles / wanted.isovalues.size() / roughness);
    request.stop = [&] { return is_overtaken(wanted); };
    const FrameFigures figures = surfaces_[n].frames->next(request);
    if (figures.stopped) return false;
    found.surfaces.push_back(drawn_chunks(surfaces_[n]));
    add(surfaces_[n].frames->counts(), found.counts);
    UpdateReport& report = found.report;
    report.triangles += figures.triangles;
    report.splits += figures.splits;
    report.merges += figures.merges;
    report.depth_tests += figures.depth_tests;
    report.hidden += figures.hidden;
    report.largest_error_pixels = std::max(report.largest_error_pixels, figures.largest_error);
    return true;
  }

  /// Only chunks that are not as they were are made anew.
  std::vector<SharedMesh> drawn_chunks(Surface& surface) {
    std::vector<SharedMesh> meshes;
    std::unordered_map<std::uint64_t, Surface::Drawn> now;
    surface.frames->for_each_chunk([&](const SurfaceChunk& chunk) {
      if (chunk.triangles.empty()) return;
      Surface::Drawn& drawn = now[chunk.id];
      if (const auto before = surface.drawn.find(chunk.id); before != surface.drawn.end())
        drawn = before->second;
      if (!drawn.mesh || drawn.revision != chunk.revision) drawn = {chunk.revision, drawn_chunk(chunk)};
      meshes.push_back(drawn.mesh);
    });
    surface.drawn = std::move(now);
    return meshes;
  }

  [[nodiscard]] SharedMesh drawn_chunk(const SurfaceChunk& chunk) {
    TriangleSurface surface;
    surface.points = chunk.points;
    surface.normals = chunk.normals;
    surface.triangles = chunk.triangles;
    place_in_space(file_.header().grid, surface);
    if (colours_) {
      for (const Vec3& p : surface.points) surface.values.push_back(static_cast<float>(colours_->at(p)));
    }
    return drawn_mesh(surface);
  }

  static constexpr std::uint64_t kRough = 8;

  StoreFile file_;
  std::size_t memory_;
  std::vector<Surface> surfaces_;  ///< of the thread, like colours_
  std::unique_ptr<VolumeValues> colours_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ended_ = false;
  std::optional<Wanted> wanted_;
  std::shared_ptr<const Found> found_;
  std::thread thread_;
};

class StoreDocument final : public Document {
 public:
  StoreDocument(const std::string& path, const DocumentOptions& options)
      : values_(VolumeValues::open(path, options.memory)), worker_(path, options) {
    const VolumeGrid& grid = worker_.file().header().grid;
    check_two_samples(path, grid);
    facts_.name = path;
    facts_.summary = fmt::format("{} x {} x {} {}", grid.dimensions[0], grid.dimensions[1],
                                 grid.dimensions[2], sample_name(grid.type));
    facts_.box = grid.box();
    facts_.has_isovalues = true;
    fill_histogram();
    if (options.colour_by.empty()) return;
    const std::unique_ptr<VolumeValues> colours = VolumeValues::open(options.colour_by, options.memory);
    facts_.fields = {std::filesystem::path(options.colour_by).filename().string()};
    const std::vector<double> some = colours->some();
    if (some.empty()) fail("{}: expected finite samples to colour by, found none", options.colour_by);
    const auto [least, greatest] = std::ranges::minmax(some);
    colour_range_ = {least, greatest};
  }

  [[nodiscard]] const DocumentFacts& facts() const override { return facts_; }

  std::vector<DrawnPart> parts(const ViewState& view, const DocumentState& state) override {
    // A view of which it is not known yet what it hides is not worth a mesh of its own, but for the first
    // one.
    const bool waits =
        view.leaves_out_hidden && !view.depths && !view.culled_from && shows_surfaces_of(state);
    if (!waits) worker_.want(wanted(view, state));
    const std::shared_ptr<const Found> found = worker_.found();
    std::vector<DrawnPart> result;
    if (!found) return result;
    const std::vector<const SurfaceState*> shown = shown_surfaces(state);
    // Where fewer or more surfaces are wanted by now, the first ones stand for what comes.
    for (std::size_t n = 0; n < std::min(shown.size(), found->surfaces.size()); ++n) {
      PartStyle style;
      style.front = shown[n]->colour;
      style.back = mix(shown[n]->colour, {0.45, 0.25, 0.22}, 0.6);
      style.opacity = shown[n]->opacity;
      style.is_coloured_by_value = !state.field.empty();
      if (const auto range = colour_range(state))
        std::tie(style.low, style.high) = std::pair((*range)[0], (*range)[1]);
      style.is_clipped = true;
      style.has_edges = view.has_edges;
      for (const SharedMesh& chunk : found->surfaces[n]) result.push_back({chunk, style});
    }
    return result;
  }

  [[nodiscard]] bool shows_surfaces_of(const DocumentState& state) const override {
    const std::shared_ptr<const Found> found = worker_.found();
    return found && found->wanted.isovalues == isovalues_of(state);
  }

  void finish(const ViewState& view, const DocumentState& state) override {
    const Wanted all = wanted(view, state);
    worker_.want(all);
    worker_.wait_for(all);
  }

  [[nodiscard]] UpdateReport report() const override {
    const std::shared_ptr<const Found> found = worker_.found();
    if (found) return found->report;
    UpdateReport none;
    none.is_current = false;
    return none;
  }

  [[nodiscard]] PageCounts page_counts() const override {
    const std::shared_ptr<const Found> found = worker_.found();
    return found ? found->counts : PageCounts{};
  }

  [[nodiscard]] std::optional<std::array<double, 2>> colour_range(const DocumentState& state) const override {
    if (state.field.empty() || facts_.fields.empty()) return std::nullopt;
    return state.range ? *state.range : colour_range_;
  }

  [[nodiscard]] Reading at(const Vec3& place, const DocumentState&) override {
    Reading reading;
    const double value = values_->at(place);
    if (!std::isnan(value)) reading.value = value;
    return reading;
  }

  [[nodiscard]] DocumentState first_state() const override {
    DocumentState state;
    SurfaceState surface;
    surface.isovalue = first_isovalue();
    state.surfaces.push_back(surface);
    if (!facts_.fields.empty()) state.field = facts_.fields[0];
    return state;
  }

 private:
  void fill_histogram() {
    const std::vector<double> some = values_->some();
    facts_.histogram.assign(kHistogramParts, 0);
    if (some.empty()) return;
    const auto [least, greatest] = std::ranges::minmax(some);
    facts_.value_range = {least, greatest};
    const double width = greatest > least ? greatest - least : 1;
    for (const double value : some) {
      const auto part = static_cast<std::size_t>((value - least) / width * kHistogramParts);
      ++facts_.histogram[std::min(part, kHistogramParts - 1)];
    }
  }

  /// Between what there is most of and the rest, in the manner of Otsu 1979: where the values on both sides
  /// differ most from each other.
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

  [[nodiscard]] Wanted wanted(const ViewState& view, const DocumentState& state) const {
    const VolumeGrid& grid = worker_.file().header().grid;
    Wanted result;
    result.viewpoint = in_frame(grid, view.culled_from ? *view.culled_from : view.viewpoint);
    result.pixels = view.pixels;
    result.max_triangles = view.max_triangles;
    // Boxes of diamonds are in the frame, which is space where axes are straight.
    if (view.leaves_out_hidden && grid.is_straight() && view.depths &&
        view.depths->viewpoint() == result.viewpoint)
      result.depths = view.depths;
    result.isovalues = isovalues_of(state);
    return result;
  }

  /// Of samples.
  [[nodiscard]] std::vector<double> isovalues_of(const DocumentState& state) const {
    std::vector<double> isovalues;
    for (const SurfaceState* surface : shown_surfaces(state))
      isovalues.push_back(worker_.file().header().grid.sample(surface->isovalue));
    return isovalues;
  }

  DocumentFacts facts_;
  std::unique_ptr<VolumeValues> values_;
  std::array<double, 2> colour_range_{};
  SurfaceWorker worker_;
};

}  // namespace

SharedMesh drawn_mesh(const TriangleSurface& surface) {
  auto mesh = std::make_shared<DrawnMesh>();
  for (const Vec3& p : surface.points) mesh->box.extend(p);
  if (!surface.points.empty()) mesh->origin = mesh->box.center();
  mesh->vertices.resize(surface.points.size());
  for (std::size_t n = 0; n < surface.points.size(); ++n) {
    DrawnMesh::Vertex& vertex = mesh->vertices[n];
    vertex.place = in_single(surface.points[n] - mesh->origin);
    vertex.normal = in_single(surface.normals.empty() ? Vec3{} : surface.normals[n]);
    if (!surface.values.empty()) vertex.front_value = vertex.back_value = surface.values[n];
  }
  mesh->indices.reserve(3 * surface.triangles.size());
  for (const auto& t : surface.triangles) mesh->indices.insert(mesh->indices.end(), t.begin(), t.end());
  return mesh;
}

std::unique_ptr<Document> open_store_document(const std::string& path, const DocumentOptions& options) {
  return std::make_unique<StoreDocument>(path, options);
}

}  // namespace adamas
