#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/opened_store.h"
#include "cli/option_values.h"
#include "cli/usage.h"
#include "cli/volume_options.h"
#include "core/base/naming.h"
#include "isosurface/view/flight.h"
#include "timevarying/play_order.h"
#include "timevarying/read_ahead.h"
#include "timevarying/series_frames.h"
#include "timevarying/surface_motion.h"

namespace adamas::cli {

using namespace isosurface;
using namespace timevarying;

namespace {

struct Options {
  StoreInput input;
  std::string isovalue, error, pixels, max_triangles, steps, order = "forward", times = "1", seed = "0", path,
                                                             read_steps = "10", ahead = "2";
  bool motion = false;
};

constexpr std::int32_t kWidth = 1024, kHeight = 768;

PlayOrder wanted_order(const std::string& text) {
  if (text == "backward") return PlayOrder::kBackward;
  if (text == "there-and-back") return PlayOrder::kThereAndBack;
  return text == "random" ? PlayOrder::kRandom : PlayOrder::kForward;
}

/// The frames that are asked for: where they are seen from, in turn, and how fine they are.
struct Frames {
  std::vector<Viewpoint> path;
  FrameRequest request;
  /// How frames tell the greatest error, which is in pixels: with a camera so, without one in units of
  /// length.
  const char* error_key = "largest_error_pixels";
  double error_unit = 1;

  Frames(const Options& options, const VolumeGrid& grid) {
    request.isovalue = grid.sample(parse_numbers("--isovalue", options.isovalue, 1)[0]);
    if (!options.max_triangles.empty())
      request.max_triangles = parse_count("--max-triangles", options.max_triangles);
    if (options.path.empty()) {
      path = {from_everywhere(grid.frame_box(), kHeight, kHeight)};
      const double error = options.error.empty() ? 0 : parse_surface_error(options.error, grid);
      error_key = "largest_error";
      error_unit = grid.greatest_stretch() * path[0].height / path[0].height_pixels;
      request.pixels = error / error_unit;
    } else {
      path = flight(options.path, grid.frame_box(), kWidth, kHeight);
      request.pixels = options.pixels.empty() ? 1 : parse_positive("--pixels", options.pixels);
    }
  }
};

/// How far surfaces have moved.
struct Moved {
  SurfaceCertificate greatest;
  std::size_t transitions = 0;
  /// One of the two has a surface, the other has none.
  std::size_t begins_or_ends = 0;
  std::size_t damaged = 0;  ///< that could not be measured
};

/// What playing has come to.
struct Played {
  Figures frames = Figures::array();
  std::vector<double> seconds;
  std::uint64_t triangles = 0, most_triangles = 0;
  std::optional<Moved> moved;
  std::set<std::uint32_t> damaged_steps;
  std::string damage;  ///< what is wrong with the first one

  void add(std::uint32_t step, const FrameFigures& figures, const Frames& wanted, double frame_seconds,
           std::uint64_t reads, std::uint64_t bytes) {
    frames.push_back({{"step", step},
                      {"triangles", figures.triangles},
                      {"splits", figures.splits},
                      {"merges", figures.merges},
                      {wanted.error_key, figures.largest_error * wanted.error_unit},
                      {"page_faults", reads},
                      {"bytes_read", bytes},
                      {"seconds", frame_seconds}});
    seconds.push_back(frame_seconds);
    triangles += figures.triangles;
    most_triangles = std::max(most_triangles, figures.triangles);
  }
  void add_damaged(std::uint32_t step, const std::string& what) {
    if (damaged_steps.empty()) damage = what;
    damaged_steps.insert(step);
  }
  [[nodiscard]] std::vector<std::uint32_t> damaged() const {
    return {damaged_steps.begin(), damaged_steps.end()};
  }
};

/// Calls `work`; returns what is damaged where it cannot be done since something is, and nothing where it is
/// done.
template <class Fn>
std::optional<std::string> found_damaged(Fn&& work) {
  try {
    work();
    return {};
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::kCancelled || e.kind() == ErrorKind::kUsage) throw;
    return e.what();
  }
}

/// Adds to each frame how far the surface of all samples has moved since the frame before.
void measure_motion(const Options& options, StoreFile& file, Played& played, Session& session) {
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, options.input.open.memory);
  const double isovalue = file.header().grid.sample(parse_numbers("--isovalue", options.isovalue, 1)[0]);
  std::map<std::array<std::uint32_t, 2>, std::optional<SurfaceCertificate>> known;
  Moved& all = played.moved.emplace();
  std::string damage;
  for (std::size_t n = 1; n < played.frames.size(); ++n) {
    session.console.step("measuring motion",
                         static_cast<double>(n) / static_cast<double>(played.frames.size()));
    const std::uint32_t before = played.frames[n - 1]["step"].get<std::uint32_t>(),
                        now = played.frames[n]["step"].get<std::uint32_t>();
    const auto [from, to] = std::minmax({before, now});
    const auto [found, is_new] = known.try_emplace({from, to});
    std::optional<SurfaceCertificate>& moved = found->second;
    const std::array<std::uint32_t, 2> steps{from, to};
    if (is_new) {
      const auto lost = found_damaged([&] { moved = motion->between(steps[0], steps[1], isovalue); });
      if (lost) damage = *lost;
    }
    ++all.transitions;
    if (!moved) {
      ++all.damaged;
      continue;
    }
    played.frames[n]["motion_certified"] = moved->certified;
    played.frames[n]["motion_found"] = moved->found;
    if (std::isfinite(moved->certified)) {
      all.greatest = {std::max(all.greatest.certified, moved->certified),
                      std::max(all.greatest.found, moved->found)};
    } else {
      ++all.begins_or_ends;
    }
  }
  session.console.clear();
  if (all.damaged > 0)
    session.console.note_incomplete("{}: how far the surface moves is not known from {} to the next", damage,
                                    counted(all.damaged, "frame"));
}

std::vector<std::vector<std::string>> motion_rows(const Moved& moved, bool have_surface) {
  const std::size_t measured = moved.transitions - moved.begins_or_ends - moved.damaged;
  if (!have_surface && moved.begins_or_ends == 0) return {{"moved", "-, no frame has a surface"}};
  std::vector<std::vector<std::string>> rows{{"moved", "-"}};
  if (measured > 0)
    rows[0][1] = fmt::format("{:.4g} at most, {:.4g} found, from a frame to the next",
                             moved.greatest.certified, moved.greatest.found);
  if (moved.begins_or_ends > 0)
    rows.push_back(
        {"not measured", fmt::format("{} of {} {} without a surface", moved.begins_or_ends,
                                     counted(moved.transitions, "transition"),
                                     moved.begins_or_ends == 1 ? "begins or ends" : "begin or end")});
  return rows;
}

Played play(const Options& options, StoreFile& file, Session& session) {
  const auto [first, last] = wanted_steps(options.steps, options.input, file.steps());
  const std::vector<std::uint32_t> order =
      steps_in_order(wanted_order(options.order), first, last,
                     static_cast<std::uint32_t>(parse_count("--times", options.times)),
                     parse_count("--seed", options.seed, 0));
  const std::size_t ahead = parse_count("--ahead", options.ahead, 0);
  Frames wanted(options, file.header().grid);
  const std::unique_ptr<SharedPages> pages = SharedPages::open(file, options.input.open.memory);
  const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*pages);
  Played played;
  std::uint64_t reads = 0, bytes = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    session.console.step("playing", static_cast<double>(n) / static_cast<double>(order.size()));
    wanted.request.viewpoint = wanted.path[n % wanted.path.size()];
    const auto before = std::chrono::steady_clock::now();
    FrameFigures figures;
    const auto damage = found_damaged([&] { figures = frames->next(order[n], wanted.request); });
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - before;
    const std::size_t end = std::min(order.size(), n + 1 + ahead);
    frames->expect({order.begin() + static_cast<std::ptrdiff_t>(n) + 1,
                    order.begin() + static_cast<std::ptrdiff_t>(end)});
    if (damage) {
      played.add_damaged(order[n], *damage);
      continue;
    }
    const std::uint64_t all_reads = pages->page_reads(), all_bytes = pages->counts().bytes;
    played.add(order[n], figures, wanted, passed.count(), all_reads - reads, all_bytes - bytes);
    reads = all_reads;
    bytes = all_bytes;
  }
  session.console.clear();
  if (played.frames.empty()) fail("{}: {} cannot be played", played.damage, steps_text(played.damaged()));
  return played;
}

void report(const Played& played, const StoreFile& file, Session& session) {
  std::uint64_t bytes = 0, reads = 0;
  for (const auto& frame : played.frames) {
    bytes += frame["bytes_read"].get<std::uint64_t>();
    reads += frame["page_faults"].get<std::uint64_t>();
  }
  std::vector<double> sorted = played.seconds;
  std::ranges::sort(sorted);
  double seconds = 0;
  for (const double of_frame : sorted) seconds += of_frame;
  const auto count = static_cast<double>(sorted.size());
  const double part = static_cast<double>(bytes) / static_cast<double>(file.size());
  std::vector<std::vector<std::string>> rows{
      {"frames", std::to_string(sorted.size())},
      {"triangles", fmt::format("{:.0f}, at most {}", static_cast<double>(played.triangles) / count,
                                played.most_triangles)},
      {"seconds a frame", fmt::format("{:.4f}, median {:.4f}, at most {:.4f}", seconds / count,
                                      sorted[sorted.size() / 2], sorted.back())},
      {"page faults", std::to_string(reads)},
      {"read", fmt::format("{}, {:.0f}% of the file", bytes_text(static_cast<double>(bytes)), 100 * part)}};
  if (played.moved) {
    for (const auto& row : motion_rows(*played.moved, played.most_triangles > 0)) rows.push_back(row);
  }
  session.console.table(rows);
  const Figures all{{"frames", played.frames},
                    {"triangles_mean", static_cast<double>(played.triangles) / count},
                    {"frames_per_second", seconds > 0 ? count / seconds : 0},
                    {"page_faults", reads},
                    {"bytes_read", bytes},
                    {"bytes_file", file.size()},
                    {"damaged_steps", played.damaged()},
                    {"part_read", part},
                    {"seconds", session.console.seconds()},
                    {"peak_memory_bytes", peak_memory_bytes()}};
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, all); });
}

void run(const Options& options, Session& session) {
  parse_numbers("--isovalue", options.isovalue, 1);
  if (!options.error.empty() && !options.path.empty())
    wrong_usage(
        "--error: expected no --camera-path beside it, found one; --pixels is the error in a picture");
  if (!options.pixels.empty() && options.path.empty())
    wrong_usage("--pixels: expected a --camera-path, found none; --error is the error in space");
  const std::unique_ptr<StoreFile> file = open_store(options.input, session);
  const VolumeGrid& grid = file->header().grid;
  const std::size_t step_bytes =
      PageGrid::kPoints * (sample_bytes(grid.type) + (file->header().gradients ? 2 : 0));
  ReadAhead ahead;
  ahead.bytes = parse_count("--read-steps", options.read_steps) * step_bytes;
  ahead.is_backward = options.order == "backward";
  ahead.memory = options.input.open.memory / 4;
  set_read_ahead(*file, ahead);
  Played played = naming(options.input.path, [&] { return play(options, *file, session); });
  if (options.motion) naming(options.input.path, [&] { measure_motion(options, *file, played, session); });
  report(played, *file, session);
  session.commit();
  if (!played.damaged_steps.empty())
    session.console.note_incomplete("{}: {} left out", played.damage, steps_text(played.damaged()));
}

}  // namespace

void add_play(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "play", "Plays a series without a window, and measures",
                  "adamas play mixing.adm --isovalue 2.5 --error 0.7voxels --json play.json",
                  [options, &session] { run(*options, session); });
  add_store_input(command, options->input);
  command.add_option("--isovalue", options->isovalue, "The value").required().type_name("V");
  command
      .add_option(
          "--error", options->error,
          "The greatest isosurface error everywhere, an estimate of the distance to the surface of all "
          "samples: in units of length, of voxels (the least spacing) or of the data's diagonal; "
          "default 0")
      .type_name("E|Evoxels|E%");
  command
      .add_option(
          "--camera-path", options->path,
          "Move the camera: once round in N frames, again and again, or from viewpoint to viewpoint of "
          "a text file, with --pixels for the error")
      .type_name("orbit:N|FILE");
  command.add_option("--pixels", options->pixels, "The greatest error in a picture (default 1)")
      .type_name("E");
  command.add_option("--max-triangles", options->max_triangles, "Never more triangles, whatever the error")
      .type_name("N");
  command.add_option("--steps", options->steps, "From step A to step B (default: all)").type_name("A,B");
  command
      .add_option("--order", options->order,
                  "In which order steps are played; random: as many jumps as there are steps, "
                  "some of which may come again while others do not come")
      .one_of({"forward", "backward", "there-and-back", "random"})
      .show_default();
  command.add_option("--times", options->times, "How often they are played").type_name("N").show_default();
  command.add_option("--seed", options->seed, "Which jumps, of --order random").type_name("N").show_default();
  command.add_flag(
      "--motion", options->motion,
      "Measure how far the surface of all samples moves from each frame to the next, between two bounds");
  command
      .add_option("--read-steps", options->read_steps,
                  "How much is read at a time: as many bytes as N steps of a page are before they are "
                  "compressed, a quarter more or less")
      .type_name("N")
      .show_default()
      .group("Paging");
  command
      .add_option("--ahead", options->ahead,
                  "How many of the steps that follow are decoded meanwhile by other threads: one for every "
                  "four of --threads, at least one and at most four; 0: none")
      .type_name("N")
      .show_default()
      .group("Paging");
}

}  // namespace adamas::cli
