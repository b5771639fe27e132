#include "adamas/play.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "adamas/steps.h"
#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/naming.h"
#include "isosurface/view/flight.h"
#include "timevarying/api/open_store.h"
#include "timevarying/api/surface_options.h"
#include "timevarying/play_order.h"
#include "timevarying/read_ahead.h"
#include "timevarying/series_frames.h"
#include "timevarying/surface_motion.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

constexpr std::int32_t kWidth = 1024, kHeight = 768;

void check(const PlayOptions& options) {
  check_isovalue(options.isovalue);
  if (options.error && options.camera_path)
    wrong_usage(
        "--error: expected no --camera-path beside it, found one; --pixels is the error in a picture");
  if (options.pixels && !options.camera_path)
    wrong_usage("--pixels: expected a --camera-path, found none; --error is the error in space");
  if (options.pixels && !(*options.pixels > 0))
    wrong_usage("--pixels: expected a positive number, found '{}'", *options.pixels);
  if (options.error) check_surface_error(*options.error);
  if (options.times < 1) wrong_usage("--times: expected a whole number of at least 1, found '0'");
}

/// The frames to play: their viewpoints, in turn, and their errors.
struct WantedFrames {
  std::vector<Viewpoint> path;
  FrameRequest request;
  /// The unit of the reported errors in pixels: a pixel with a camera, a length without one.
  double error_unit = 1;

  WantedFrames(const PlayOptions& options, const VolumeGrid& grid) {
    request.isovalue = grid.sample(options.isovalue);
    request.max_triangles = options.max_triangles;
    if (options.camera_path) {
      path = flight(*options.camera_path, grid.frame_box(), kWidth, kHeight);
      request.pixels = options.pixels.value_or(1);
    } else {
      path = {from_everywhere(grid.frame_box(), kHeight, kHeight)};
      error_unit = grid.greatest_stretch() * path[0].height / path[0].height_pixels;
      request.pixels = surface_error(options.error.value_or(0), grid) / error_unit;
    }
  }
};

/// Calls `work`. Returns the damage that prevents it, and nothing where it succeeds.
template <class Work>
std::optional<std::string> found_damaged(Work&& work) {
  try {
    work();
    return {};
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::kCancelled || e.kind() == ErrorKind::kUsage) throw;
    return e.what();
  }
}

/// Plays the steps, and reports the cost of each frame.
PlayReport play_frames(StoreFile& file, const PlayOptions& options, Progress& progress) {
  const StepRange steps = options.steps.value_or(StepRange{0, file.steps() - 1});
  check_steps(steps, file.steps(), file.name());
  const std::vector<std::uint32_t> order =
      steps_in_order(options.order, steps.first, steps.last, options.times, options.seed);
  WantedFrames wanted(options, file.header().grid);
  const std::unique_ptr<SharedPages> pages = SharedPages::open(file, options.store.memory);
  const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*pages);
  PlayReport report;
  report.file_bytes = file.size();
  std::set<std::uint32_t> damaged;
  std::uint64_t reads = 0, bytes = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    progress.step("playing", static_cast<double>(n) / static_cast<double>(order.size()));
    wanted.request.viewpoint = wanted.path[n % wanted.path.size()];
    const auto before = std::chrono::steady_clock::now();
    FrameFigures figures;
    const auto damage = found_damaged([&] { figures = frames->next(order[n], wanted.request); });
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - before;
    const std::size_t end = std::min(order.size(), n + 1 + std::min(options.ahead, order.size()));
    frames->expect({order.begin() + static_cast<std::ptrdiff_t>(n) + 1,
                    order.begin() + static_cast<std::ptrdiff_t>(end)});
    if (damage) {
      if (damaged.empty()) report.damage = *damage;
      damaged.insert(order[n]);
      continue;
    }
    const std::uint64_t all_reads = pages->page_reads(), all_bytes = pages->counts().bytes;
    report.frames.push_back({order[n], figures.triangles, figures.splits, figures.merges,
                             figures.largest_error * wanted.error_unit, all_reads - reads, all_bytes - bytes,
                             passed.count()});
    reads = all_reads;
    bytes = all_bytes;
  }
  report.damaged_steps.assign(damaged.begin(), damaged.end());
  if (report.frames.empty()) fail("{}: {} cannot be played", report.damage, steps_text(report.damaged_steps));
  return report;
}

/// Adds to each frame the distance that the surface of all samples has moved since the frame before.
void measure_motion(StoreFile& file, const PlayOptions& options, PlayReport& report, Progress& progress) {
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, options.store.memory);
  const double isovalue = file.header().grid.sample(options.isovalue);
  std::map<std::array<std::uint32_t, 2>, std::optional<SurfaceCertificate>> known;
  PlayedMotion& all = report.motion.emplace();
  std::string damage;
  for (std::size_t n = 1; n < report.frames.size(); ++n) {
    progress.step("measuring motion", static_cast<double>(n) / static_cast<double>(report.frames.size()));
    const auto [from, to] = std::minmax({report.frames[n - 1].step, report.frames[n].step});
    const std::array<std::uint32_t, 2> steps{from, to};
    const auto [found, is_new] = known.try_emplace(steps);
    std::optional<SurfaceCertificate>& moved = found->second;
    if (is_new) {
      const auto lost = found_damaged([&] { moved = motion->between(steps[0], steps[1], isovalue); });
      if (lost) damage = *lost;
    }
    ++all.transitions;
    if (!moved) {
      ++all.damaged;
      continue;
    }
    report.frames[n].motion = {moved->certified, moved->found};
    if (std::isfinite(moved->certified)) {
      all.greatest = {std::max(all.greatest.certified, moved->certified),
                      std::max(all.greatest.found, moved->found)};
    } else {
      ++all.begins_or_ends;
    }
  }
  if (all.damaged > 0)
    progress.note(NoteKind::kIncomplete,
                  fmt::format("{}: how far the surface moves is not known from {} to the next", damage,
                              counted(all.damaged, "frame")));
}

}  // namespace

PlayReport play(const std::filesystem::path& store, const PlayOptions& options, Progress& progress) {
  check(options);
  const std::unique_ptr<StoreFile> file = open_store_file(store, options.store);
  const StoreHeader& header = file->header();
  const std::size_t step_bytes =
      PageGrid::kPoints * (sample_bytes(header.grid.type) + (header.gradients ? 2 : 0));
  ReadAhead ahead;
  ahead.bytes = options.read_steps * step_bytes;
  ahead.is_backward = options.order == PlayOrder::kBackward;
  ahead.memory = options.store.memory / 4;
  set_read_ahead(*file, ahead);
  const std::string name = store.string();
  PlayReport report = naming(name, [&] { return play_frames(*file, options, progress); });
  if (options.motion) naming(name, [&] { measure_motion(*file, options, report, progress); });
  return report;
}

std::uint32_t stored_steps(const std::filesystem::path& store) { return open_store_file(store, {})->steps(); }

}  // namespace adamas
