#include "adamas/play.h"

#include <algorithm>
#include <vector>

#include "adamas/steps.h"
#include "adamas/text.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"

namespace adamas::cli {

namespace {

struct Options {
  StoreInput input;
  std::string steps;  ///< the text of --steps, whose check needs the store; empty for all
  PlayOptions play;
};

std::vector<std::vector<std::string>> motion_rows(const PlayedMotion& moved, bool have_surface) {
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

Figures frame_figures(const PlayReport& played, bool in_pixels) {
  Figures frames = Figures::array();
  for (const PlayedFrame& frame : played.frames) {
    frames.push_back({{"step", frame.step},
                      {"triangles", frame.triangles},
                      {"splits", frame.splits},
                      {"merges", frame.merges},
                      {in_pixels ? "largest_error_pixels" : "largest_error", frame.largest_error},
                      {"page_faults", frame.page_faults},
                      {"bytes_read", frame.bytes_read},
                      {"seconds", frame.seconds}});
    if (!frame.motion) continue;
    frames.back()["motion_certified"] = frame.motion->certified;
    frames.back()["motion_found"] = frame.motion->found;
  }
  return frames;
}

void report(const PlayReport& played, bool in_pixels, Session& session) {
  std::uint64_t bytes = 0, reads = 0, triangles = 0, most_triangles = 0;
  std::vector<double> sorted;
  for (const PlayedFrame& frame : played.frames) {
    bytes += frame.bytes_read;
    reads += frame.page_faults;
    triangles += frame.triangles;
    most_triangles = std::max(most_triangles, frame.triangles);
    sorted.push_back(frame.seconds);
  }
  std::ranges::sort(sorted);
  double seconds = 0;
  for (const double each : sorted) seconds += each;
  const auto count = static_cast<double>(sorted.size());
  const double part = static_cast<double>(bytes) / static_cast<double>(played.file_bytes);
  std::vector<std::vector<std::string>> rows{
      {"frames", std::to_string(sorted.size())},
      {"triangles",
       fmt::format("{:.0f}, at most {}", static_cast<double>(triangles) / count, most_triangles)},
      {"seconds a frame", fmt::format("{:.4f}, median {:.4f}, at most {:.4f}", seconds / count,
                                      sorted[sorted.size() / 2], sorted.back())},
      {"page faults", std::to_string(reads)},
      {"read", fmt::format("{}, {:.0f}% of the file", bytes_text(static_cast<double>(bytes)), 100 * part)}};
  if (played.motion) {
    for (const auto& row : motion_rows(*played.motion, most_triangles > 0)) rows.push_back(row);
  }
  session.console.table(rows);
  Figures all{{"frames", frame_figures(played, in_pixels)},
              {"triangles_mean", static_cast<double>(triangles) / count},
              {"frames_per_second", seconds > 0 ? count / seconds : 0},
              {"page_faults", reads},
              {"bytes_read", bytes},
              {"bytes_file", played.file_bytes},
              {"damaged_steps", played.damaged_steps},
              {"part_read", part}};
  add_costs(all, session.console);
  write_figures(all, session);
}

void run(Options& options, Session& session) {
  const std::string& path = options.input.path;
  PlayOptions& wanted = options.play;
  wanted.store = options.input.open;
  session.outputs.protect(path);
  if (!options.steps.empty())
    wanted.steps = parse_steps(
        options.steps, [&path] { return stored_steps(path); }, path);
  const PlayReport played = play(path, wanted, session.console);
  report(played, wanted.camera_path.has_value(), session);
  session.commit();
  if (!played.damaged_steps.empty())
    session.console.note_incomplete("{}: {} left out", played.damage, steps_text(played.damaged_steps));
}

/// Adds the options that say which surfaces are played.
void add_surface_options(const Command& command, Options& options) {
  PlayOptions& play = options.play;
  command.add_value("--isovalue", "V", "The value", play.isovalue, parse_number).required();
  command.add_value(
      "--error", "E|Evoxels|E%",
      "The greatest isosurface error everywhere, an estimate of the distance to the surface of all samples: "
      "in units of length, of voxels (the least spacing) or of the data's diagonal; default 0",
      play.error, parse_surface_error);
  command.add_value("--camera-path", "orbit:N|FILE",
                    "Move the camera: once round in N frames, again and again, or from viewpoint to "
                    "viewpoint of a text file, with --pixels for the error",
                    play.camera_path,
                    [](const std::string&, const std::string& text) { return parse_camera_path(text); });
  command.add_value("--pixels", "E", "The greatest error in a picture (default 1)", play.pixels,
                    parse_number);
  command.add_value("--max-triangles", "N", "Never more triangles, whatever the error", play.max_triangles,
                    parse_count);
}

/// Adds the options that say in which order steps are played.
void add_order_options(const Command& command, Options& options) {
  PlayOptions& play = options.play;
  command.add_option("--steps", "A,B", "From step A to step B (default: all)", options.steps);
  command.add_choice<PlayOrder>(
      "--order",
      "In which order steps are played; random: as many jumps as there are steps, some of which may come "
      "again while others do not come",
      play.order,
      {{"forward", PlayOrder::kForward},
       {"backward", PlayOrder::kBackward},
       {"there-and-back", PlayOrder::kThereAndBack},
       {"random", PlayOrder::kRandom}},
      "forward");
  command.add_value(
      "--times", "N", "How often they are played", play.times,
      [](const std::string& option, const std::string& text) {
        return static_cast<std::uint32_t>(parse_count(option, text));
      },
      "1");
  command.add_value("--seed", "N", "Which jumps, of --order random", play.seed, parse_count_from_0, "0");
  command.add_flag(
      "--motion",
      "Measure how far the surface of all samples moves from each frame to the next, between two bounds",
      play.motion);
}

void add_reading_options(const Command& command, PlayOptions& play) {
  const Command paging = command.in_group("Paging");
  paging.add_value("--read-steps", "N",
                   "How much is read at a time: as many bytes as N steps of a page are before they are "
                   "compressed, a quarter more or less",
                   play.read_steps, parse_count, "10");
  paging.add_value("--ahead", "N",
                   "How many of the steps that follow are decoded meanwhile by other threads: one for every "
                   "four of --threads, at least one and at most four; 0: none",
                   play.ahead, parse_count_from_0, "2");
}

}  // namespace

void add_play(const Command& app, Session& session) {
  const auto [command, options] =
      add_command(app, session, "play", "Plays a series without a window, and measures",
                  "adamas play mixing.adm --isovalue 2.5 --error 0.7voxels --json play.json", run);
  add_store_input(command, options.input);
  add_surface_options(command, options);
  add_order_options(command, options);
  add_reading_options(command, options.play);
}

}  // namespace adamas::cli
