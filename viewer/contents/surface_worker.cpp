#include "viewer/contents/surface_worker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/data/volume_placement.h"
#include "viewer/contents/mesh_maker.h"

namespace adamas::viewer {

using namespace isosurface;
using namespace timevarying;

namespace {

std::vector<std::uint32_t> indices_of(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * triangles.size());
  for (const auto& t : triangles) indices.insert(indices.end(), t.begin(), t.end());
  return indices;
}

}  // namespace

SurfaceWorker::SurfaceWorker(OpenStore& store, OpenStore* colours, const DocumentOptions& options)
    : store_(store),
      colours_(colours),
      waits_for_pages_(options.waits_for_pages),
      step_of_colours_(options.step),
      form_(options.interpolates_in_shader && colours == nullptr && store.grid().is_straight()
                ? SurfaceForm::kEdgeEnds
                : SurfaceForm::kPoints) {
  store_.pages().set_arrived([this] {
    const std::lock_guard lock(mutex_);
    has_arrived_ = true;
    changed_.notify_all();
  });
  thread_ = std::thread([this] { run(); });
}

SurfaceWorker::~SurfaceWorker() {
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
  // Their threads call back until then.
  surfaces_.clear();
}

void SurfaceWorker::want(const WantedSurfaces& wanted) {
  const std::lock_guard lock(mutex_);
  if (wanted_ == wanted) return;
  wanted_ = wanted;
  changed_.notify_all();
}

void SurfaceWorker::expect(const std::vector<std::uint32_t>& steps) {
  const std::lock_guard lock(mutex_);
  if (expected_ == steps) return;
  expected_ = steps;
  changed_.notify_all();
}

StepsAhead SurfaceWorker::steps_ahead() const {
  const std::lock_guard lock(mutex_);
  return ahead_;
}

std::shared_ptr<const FoundSurfaces> SurfaceWorker::found() const {
  const std::lock_guard lock(mutex_);
  return found_;
}

bool SurfaceWorker::is_current() const {
  const std::lock_guard lock(mutex_);
  return found_ && found_->report.is_current && found_->wanted == wanted_;
}

void SurfaceWorker::wait_for(const WantedSurfaces& wanted) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    const bool is_here = found_ && found_->wanted == wanted && found_->roughness == 1;
    return is_here && (found_->report.is_current || !waits_for_pages_);
  });
}

bool SurfaceWorker::wait_for_work(const std::optional<WantedSurfaces>& done) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return is_ended_ || asked_ || (wanted_ && (wanted_ != done || has_arrived_ || expected_ != expecting_));
  });
  // A question about a place is answered first; pages have still arrived then.
  if (!asked_) has_arrived_ = false;
  return !is_ended_;
}

Reading SurfaceWorker::reading_at(const SurfacePlace& place) {
  const std::lock_guard lock(mutex_);
  if (answered_ && answered_->first == place) return answered_->second;
  asked_ = place;
  changed_.notify_all();
  Reading pending;
  pending.is_pending = true;
  return pending;
}

void SurfaceWorker::answer(const SurfacePlace& place) {
  const VolumeGrid& grid = store_.grid();
  Reading reading;
  try {
    const double value = store_.values(place.step).at(place.place);
    if (!std::isnan(value)) reading.value = value;
  } catch (const Error&) {
    // A step that cannot be loaded has no value.
    reading.value.reset();
  }
  if (place.surface < surfaces_.size())
    reading.error = surfaces_[place.surface].frames->error_at(grid.in_frame(place.place));
  // This factor bounds lengths in space by those in the frame of an oblique grid.
  if (reading.error) *reading.error *= grid.greatest_stretch();
  const std::lock_guard lock(mutex_);
  answered_ = {place, reading};
  if (asked_ == place) asked_.reset();
}

void SurfaceWorker::run() {
  // What was wanted last and found, possibly with missing pages; empty if that was given up.
  std::optional<WantedSurfaces> done, last;
  while (wait_for_work(done)) {
    WantedSurfaces wanted;
    std::optional<SurfacePlace> asked;
    {
      const std::lock_guard lock(mutex_);
      asked = asked_;
      if (!asked) wanted = *wanted_;
      expecting_ = expected_;
    }
    if (asked) {
      answer(*asked);
      continue;
    }
    if (done == wanted && is_current()) {
      StepsAhead ahead = look_ahead();
      const std::lock_guard lock(mutex_);
      ahead_ = std::move(ahead);
      continue;
    }
    // A rough surface comes first if another one was shown.
    const bool is_other = !last || wanted.isovalues != last->isovalues;
    budget_.begin(wanted.seconds, wanted.max_triangles, last == wanted);
    done.reset();
    if (is_other && !update(wanted, kRough)) continue;
    last = wanted;
    if (update(wanted, 1) && (budget_.is_whole() || is_current())) done = std::move(wanted);
  }
}

StepsAhead SurfaceWorker::look_ahead() {
  try {
    return looked_ahead();
  } catch (const Error&) {
    // Steps that cannot be loaded are reported when they are wanted.
    for (const Surface& surface : surfaces_) surface.frames->expect({});
    return {};
  }
}

StepsAhead SurfaceWorker::looked_ahead() {
  for (const Surface& surface : surfaces_) surface.frames->expect(expecting_);
  StepsAhead ahead;
  if (store_.file().steps() == 1 || surfaces_.empty()) return ahead;
  // The steps are requested in reverse, so that the next step stays in memory longest.
  for (auto next = expecting_.rbegin(); next != expecting_.rend(); ++next) {
    for (const Surface& surface : surfaces_) static_cast<void>(surface.frames->is_ready(*next));
  }
  std::map<std::uint32_t, std::uint64_t> pages;
  std::uint64_t needed = 0;
  for (const Surface& surface : surfaces_) {
    const std::vector<LoadedStep> loaded = surface.frames->loaded_steps();
    if (!loaded.empty()) needed += loaded.front().needed;
    for (const LoadedStep& one : loaded) pages[one.step] += one.pages;
  }
  for (const auto& [step, count] : pages) {
    if (count > 0) ahead.loaded.push_back({step, static_cast<double>(count) / static_cast<double>(needed)});
  }
  ahead.is_reading =
      std::ranges::any_of(surfaces_, [](const Surface& s) { return s.frames->is_reading_ahead(); });
  return ahead;
}

void SurfaceWorker::set_step_of_colours(std::uint32_t step) {
  if (colours_ == nullptr || colours_->file().steps() == 1 || step == step_of_colours_) return;
  for (Surface& surface : surfaces_) surface.drawn.clear();
  step_of_colours_ = step;
}

bool SurfaceWorker::is_paging() const {
  return std::ranges::any_of(surfaces_, [](const Surface& surface) { return surface.frames->is_paging(); });
}

std::string SurfaceWorker::paging_problem() const {
  for (const Surface& surface : surfaces_) {
    if (std::string problem = surface.frames->paging_problem(); !problem.empty()) return problem;
  }
  return {};
}

bool SurfaceWorker::is_overtaken(const WantedSurfaces& wanted) const {
  const std::lock_guard lock(mutex_);
  return is_ended_ || wanted_->isovalues != wanted.isovalues;
}

bool SurfaceWorker::update(const WantedSurfaces& wanted, std::uint64_t roughness) {
  auto found = std::make_shared<FoundSurfaces>();
  found->wanted = wanted;
  found->isovalues = wanted.isovalues;
  found->roughness = roughness;
  found->step = wanted.step;
  using Clock = std::chrono::steady_clock;
  const auto before = Clock::now();
  const auto passed = [&] { return std::chrono::duration<double>(Clock::now() - before).count(); };
  const std::chrono::duration<double> allowed(roughness == 1 ? budget_.seconds() : 0);
  frame_end_ = allowed.count() > 0 ? before + std::chrono::duration_cast<Clock::duration>(allowed)
                                   : Clock::time_point::max();
  bool is_stopped = false, has_failed = false;
  try {
    set_step_of_colours(wanted.step);
    if (surfaces_.size() > wanted.isovalues.size()) surfaces_.resize(wanted.isovalues.size());
    for (std::size_t n = 0; n < wanted.isovalues.size() && !is_stopped; ++n)
      is_stopped = !add_surface(*found, n, roughness);
    if (!is_stopped && wanted.cells_in && !wanted.isovalues.empty())
      found->cell_edges = cell_edges({(*wanted.cells_in)[0], (*wanted.cells_in)[1]});
    // Problems with pages that are read ahead in a series concern other steps.
    if (store_.file().steps() == 1 || found->report.pages_lost > 0) found->report.problem = paging_problem();
  } catch (const std::exception& error) {
    // The surfaces found so far stay visible.
    has_failed = true;
    found->report.problem = error.what();
    if (store_.file().steps() > 1) found->report.problem += fmt::format(" (step {})", wanted.step);
    if (const auto last = this->found()) {
      found->surfaces = last->surfaces;
      found->isovalues = last->isovalues;
      found->step = last->step;
    }
  }
  {
    const SharedPages::Lock lock = store_.pages().lock();
    found->counts = store_.pages().counts();
  }
  found->report.step = found->step;
  found->report.seconds = passed();
  if (roughness == 1) budget_.note(found->report.seconds, is_stopped);
  if (is_stopped) return false;
  // After a problem the same surfaces are not computed again.
  const bool is_done = has_failed || (budget_.is_whole() && !is_paging());
  found->report.is_current = roughness == 1 && is_done;
  StepsAhead ahead = look_ahead();
  const std::lock_guard lock(mutex_);
  found_ = std::move(found);
  ahead_ = std::move(ahead);
  changed_.notify_all();
  return true;
}

bool SurfaceWorker::add_surface(FoundSurfaces& found, std::size_t n, std::uint64_t roughness) {
  while (surfaces_.size() <= n) surfaces_.push_back({SeriesFrames::open(store_.pages(), form_), {}});
  const WantedSurfaces& wanted = found.wanted;
  FrameRequest request;
  request.viewpoint = wanted.viewpoint;
  request.depths = wanted.depths;
  request.isovalue = wanted.isovalues[n];
  request.pixels = wanted.pixels * static_cast<double>(roughness);
  request.max_triangles =
      std::max<std::uint64_t>(1, budget_.triangles() / wanted.isovalues.size() / roughness);
  request.resident_only = !waits_for_pages_;
  request.stop = [&] { return is_overtaken(wanted) || std::chrono::steady_clock::now() > frame_end_; };
  const FrameFigures figures = surfaces_[n].frames->next(wanted.step, request);
  if (figures.stopped) return false;
  found.surfaces.push_back(drawn_chunks(surfaces_[n]));
  UpdateReport& report = found.report;
  report.triangles += figures.triangles;
  report.splits += figures.splits;
  report.merges += figures.merges;
  report.depth_tests += figures.depth_tests;
  report.hidden += figures.hidden;
  report.pages_missing += figures.pages_missing;
  report.pages_lost += figures.pages_lost;
  report.largest_error_pixels = std::max(report.largest_error_pixels, figures.largest_error);
  return true;
}

std::vector<SharedMesh> SurfaceWorker::drawn_chunks(Surface& surface) {
  std::unordered_map<std::uint64_t, Surface::Drawn> now;
  std::vector<const Surface::Drawn*> in_order;
  std::vector<std::pair<const SurfaceChunk*, Surface::Drawn*>> changed;
  surface.frames->for_each_chunk([&](const SurfaceChunk& chunk) {
    if (chunk.triangles.empty()) return;
    Surface::Drawn& drawn = now[chunk.id];
    if (const auto before = surface.drawn.find(chunk.id); before != surface.drawn.end())
      drawn = before->second;
    if (!drawn.mesh || drawn.revision != chunk.revision) changed.emplace_back(&chunk, &drawn);
    in_order.push_back(&drawn);
  });
  // Values of a volume that colours surfaces come from one cache of pages.
  const std::size_t grain = colours_ != nullptr ? changed.size() : 4;
  parallel_for(changed.size(), grain, [&](std::size_t n) {
    const auto& [chunk, drawn] = changed[n];
    *drawn = {chunk->revision, drawn_chunk(*chunk)};
  });
  std::vector<SharedMesh> meshes;
  for (const Surface::Drawn* const drawn : in_order) meshes.push_back(drawn->mesh);
  surface.drawn = std::move(now);
  return meshes;
}

SharedMesh SurfaceWorker::cell_edges(const Plane& plane) {
  const VolumeGrid& grid = store_.grid();
  MeshMaker maker(plane.origin, MeshMaker::Kind::kLines);
  for (const std::vector<Vec3>& polygon : surfaces_[0].frames->cells_in(plane_in_frame(grid, plane))) {
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      for (const Vec3& end : {polygon[n], polygon[(n + 1) % polygon.size()]})
        maker.add_index(maker.add_vertex(grid.in_space(end), plane.normal, {}));
    }
  }
  return maker.finish();
}

SharedMesh SurfaceWorker::drawn_chunk(const SurfaceChunk& chunk) const {
  if (!chunk.ends.empty()) return drawn_ends(chunk);
  TriangleSurface surface;
  surface.points = chunk.points;
  surface.normals = chunk.normals;
  surface.triangles = chunk.triangles;
  place_in_space(store_.grid(), surface);
  if (colours_ != nullptr) {
    const OpenStore::Values values = colours_->values(step_of_colours_);
    for (const Vec3& p : surface.points) surface.values.push_back(static_cast<float>(values.at(p)));
  }
  return drawn_mesh(surface);
}

SharedMesh drawn_ends(const SurfaceChunk& chunk) {
  auto mesh = std::make_shared<DrawnMesh>();
  mesh->origin = chunk.corner;
  mesh->step = chunk.step;
  mesh->least_parameter = chunk.least_parameter;
  mesh->ends = chunk.ends;
  mesh->indices = indices_of(chunk.triangles);
  Box3 steps;
  for (const EdgeEnds& edge : chunk.ends) {
    for (const LatticePoint& p : edge.places()) steps.extend({double(p.i), double(p.j), double(p.k)});
  }
  for (const Vec3& corner : {steps.min, steps.max})
    mesh->box.extend(chunk.corner +
                     Vec3{chunk.step.x * corner.x, chunk.step.y * corner.y, chunk.step.z * corner.z});
  return mesh;
}

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
  mesh->indices = indices_of(surface.triangles);
  return mesh;
}

}  // namespace adamas::viewer
