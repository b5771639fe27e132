#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"
#include "cli/usage_error.h"
#include "cli/volume_options.h"
#include "core/base/naming.h"
#include "isosurface/view/flight.h"
#include "timevarying/play_order.h"
#include "timevarying/series_frames.h"
#include "timevarying/surface_motion.h"

namespace adamas {

namespace {

struct Options {
  StoreInput input;
  std::string isovalue, error, pixels, max_triangles, steps, order = "forward", times = "1", seed = "0", path,
                                                             read_steps = "10", ahead = "2";
  bool motion = false;
};

constexpr std::int32_t kWidth = 1024, kHeight = 768;

/// The first and the last step of --steps.
std::array<std::uint32_t, 2> wanted_steps(const Options& options, const StoreFile& file) {
  if (options.steps.empty()) return {0, file.steps() - 1};
  const auto numbers = parse_numbers("--steps", options.steps, 2);
  const bool are_steps = std::ranges::all_of(
      numbers, [&](double n) { return n >= 0 && n < file.steps() && n == std::floor(n); });
  if (!are_steps || numbers[0] > numbers[1])
    wrong_usage("--steps: expected two of the {} steps of {}, A,B with A up to B, found '{}'", file.steps(),
                options.input.path, options.steps);
  return {static_cast<std::uint32_t>(numbers[0]), static_cast<std::uint32_t>(numbers[1])};
}

PlayOrder wanted_order(const std::string& text) {
  if (text == "backward") return PlayOrder::kBackward;
  if (text == "there-and-back") return PlayOrder::kThereAndBack;
  return text == "random" ? PlayOrder::kRandom : PlayOrder::kForward;
}

/// The frames that are asked for: where they are seen from, in turn, and how fine they are.
struct Frames {
  std::vector<Viewpoint> path;
  FrameRequest request;

  Frames(const Options& options, const VolumeGrid& grid) {
    request.isovalue = grid.sample(parse_numbers("--isovalue", options.isovalue, 1)[0]);
    if (!options.max_triangles.empty())
      request.max_triangles = parse_count("--max-triangles", options.max_triangles);
    if (options.path.empty()) {
      path = {from_everywhere(grid.frame_box(), kHeight, kHeight)};
      const double error = options.error.empty() ? 0 : parse_surface_error(options.error, grid);
      request.pixels = error / grid.greatest_stretch() * path[0].height_pixels / path[0].height;
    } else {
      path = flight(options.path, grid.frame_box(), kWidth, kHeight);
      request.pixels = options.pixels.empty() ? 1 : parse_positive("--pixels", options.pixels);
    }
  }
};

/// What playing has come to.
struct Played {
  Figures frames = Figures::array();
  std::vector<double> seconds;
  std::uint64_t triangles = 0, most_triangles = 0;
  std::optional<SurfaceCertificate> greatest_motion;

  void add(std::uint32_t step, const FrameFigures& figures, double frame_seconds, std::uint64_t reads,
           std::uint64_t bytes) {
    frames.push_back({{"step", step},
                      {"triangles", figures.triangles},
                      {"splits", figures.splits},
                      {"merges", figures.merges},
                      {"largest_error_pixels", figures.largest_error},
                      {"page_faults", reads},
                      {"bytes_read", bytes},
                      {"seconds", frame_seconds}});
    seconds.push_back(frame_seconds);
    triangles += figures.triangles;
    most_triangles = std::max(most_triangles, figures.triangles);
  }
};

/// Adds to each frame how far the surface of all samples has moved since the frame before.
void measure_motion(const Options& options, StoreFile& file, Played& played, Session& session) {
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, store_memory(options.input));
  const double isovalue = file.header().grid.sample(parse_numbers("--isovalue", options.isovalue, 1)[0]);
  std::map<std::array<std::uint32_t, 2>, SurfaceCertificate> known;
  SurfaceCertificate greatest;
  for (std::size_t n = 1; n < played.frames.size(); ++n) {
    session.console.step("measuring motion",
                         static_cast<double>(n) / static_cast<double>(played.frames.size()));
    const std::uint32_t before = played.frames[n - 1]["step"].get<std::uint32_t>(),
                        now = played.frames[n]["step"].get<std::uint32_t>();
    const auto [from, to] = std::minmax({before, now});
    const auto [found, is_new] = known.try_emplace({from, to});
    if (is_new) found->second = motion->between(from, to, isovalue);
    const SurfaceCertificate& moved = found->second;
    played.frames[n]["motion_certified"] = moved.certified;
    played.frames[n]["motion_found"] = moved.found;
    greatest = {std::max(greatest.certified, moved.certified), std::max(greatest.found, moved.found)};
  }
  session.console.clear();
  played.greatest_motion = greatest;
}

Played play(const Options& options, StoreFile& file, Session& session) {
  const auto [first, last] = wanted_steps(options, file);
  const std::vector<std::uint32_t> order =
      steps_in_order(wanted_order(options.order), first, last,
                     static_cast<std::uint32_t>(parse_count("--times", options.times)),
                     parse_count("--seed", options.seed, 0));
  const std::size_t ahead = parse_count("--ahead", options.ahead, 0);
  Frames wanted(options, file.header().grid);
  const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(file, store_memory(options.input));
  Played played;
  std::uint64_t reads = 0, bytes = 0;
  for (std::size_t n = 0; n < order.size(); ++n) {
    session.console.step("playing", static_cast<double>(n) / static_cast<double>(order.size()));
    wanted.request.viewpoint = wanted.path[n % wanted.path.size()];
    const auto before = std::chrono::steady_clock::now();
    const FrameFigures figures = frames->next(order[n], wanted.request);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - before;
    const std::size_t end = std::min(order.size(), n + 1 + ahead);
    frames->expect({order.begin() + static_cast<std::ptrdiff_t>(n) + 1,
                    order.begin() + static_cast<std::ptrdiff_t>(end)});
    const std::uint64_t all_reads = frames->page_reads(), all_bytes = frames->counts().bytes;
    played.add(order[n], figures, passed.count(), all_reads - reads, all_bytes - bytes);
    reads = all_reads;
    bytes = all_bytes;
  }
  session.console.clear();
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
  if (const auto& moved = played.greatest_motion)
    rows.push_back({"moved", fmt::format("{:.4g} at most, {:.4g} found, from a frame to the next",
                                         moved->certified, moved->found)});
  session.console.table(rows);
  const Figures all{{"frames", played.frames},
                    {"triangles_mean", static_cast<double>(played.triangles) / count},
                    {"frames_per_second", seconds > 0 ? count / seconds : 0},
                    {"page_faults", reads},
                    {"bytes_read", bytes},
                    {"bytes_file", file.size()},
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
  ahead.memory = store_memory(options.input) / 4;
  file->set_read_ahead(ahead);
  Played played = naming(options.input.path, [&] { return play(options, *file, session); });
  if (options.motion) naming(options.input.path, [&] { measure_motion(options, *file, played, session); });
  report(played, *file, session);
  session.outputs.commit();
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
  command.add_option("--order", options->order, "In which order steps are played")
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
                  "How many of the steps that follow a second thread decodes meanwhile; 0: none")
      .type_name("N")
      .show_default()
      .group("Paging");
}

}  // namespace adamas
