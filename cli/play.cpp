#include "adamas/play.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "adamas/series.h"
#include "adamas/text.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/option_values.h"
#include "cli/store_options.h"

namespace adamas::cli {

namespace {

struct Options {
  StoreInput input;
  std::string steps;        ///< A,B of --steps; empty for all
  std::string camera_path;  ///< empty for none
  PlayOptions play;
};

PlayOrder to_order(const std::string& word) {
  if (word == "backward") return PlayOrder::kBackward;
  if (word == "there-and-back") return PlayOrder::kThereAndBack;
  return word == "random" ? PlayOrder::kRandom : PlayOrder::kForward;
}

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
  const Figures all{{"frames", frame_figures(played, in_pixels)},
                    {"triangles_mean", static_cast<double>(triangles) / count},
                    {"frames_per_second", seconds > 0 ? count / seconds : 0},
                    {"page_faults", reads},
                    {"bytes_read", bytes},
                    {"bytes_file", played.file_bytes},
                    {"damaged_steps", played.damaged_steps},
                    {"part_read", part},
                    {"seconds", session.console.seconds()},
                    {"peak_memory_bytes", peak_memory_bytes()}};
  session.outputs.write(session.json, [&](const auto& path) { write_figures(path, all); });
}

void run(Options& options, Session& session) {
  const std::string& path = options.input.path;
  PlayOptions& wanted = options.play;
  wanted.store = options.input.open;
  session.outputs.protect(path);
  if (!options.camera_path.empty()) wanted.camera_path = parse_camera_path(options.camera_path);
  if (!options.steps.empty())
    wanted.steps = parse_step_range(
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
  command
      .add_converted("--isovalue", "The value",
                     [&play](const std::string& option, const std::string& text) {
                       play.isovalue = parse_numbers(option, text, 1)[0];
                     })
      .required()
      .type_name("V");
  command
      .add_converted(
          "--error",
          "The greatest isosurface error everywhere, an estimate of the distance to the surface of all "
          "samples: in units of length, of voxels (the least spacing) or of the data's diagonal; "
          "default 0",
          [&play](const std::string& option, const std::string& text) {
            play.error = parse_surface_error(option, text);
          })
      .type_name("E|Evoxels|E%");
  command
      .add_option(
          "--camera-path", options.camera_path,
          "Move the camera: once round in N frames, again and again, or from viewpoint to viewpoint of "
          "a text file, with --pixels for the error")
      .type_name("orbit:N|FILE");
  command
      .add_converted("--pixels", "The greatest error in a picture (default 1)",
                     [&play](const std::string& option, const std::string& text) {
                       play.pixels = parse_positive(option, text);
                     })
      .type_name("E");
  command
      .add_converted("--max-triangles", "Never more triangles, whatever the error",
                     [&play](const std::string& option, const std::string& text) {
                       play.max_triangles = parse_count(option, text);
                     })
      .type_name("N");
}

/// Adds the options that say in which order steps are played.
void add_order_options(const Command& command, Options& options) {
  PlayOptions& play = options.play;
  command.add_option("--steps", options.steps, "From step A to step B (default: all)").type_name("A,B");
  command
      .add_converted(
          "--order",
          "In which order steps are played; random: as many jumps as there are steps, "
          "some of which may come again while others do not come",
          [&play](const std::string&, const std::string& text) { play.order = to_order(text); }, "forward")
      .one_of({"forward", "backward", "there-and-back", "random"})
      .show_default();
  command
      .add_converted(
          "--times", "How often they are played",
          [&play](const std::string& option, const std::string& text) {
            play.times = static_cast<std::uint32_t>(parse_count(option, text));
          },
          "1")
      .type_name("N")
      .show_default();
  command
      .add_converted(
          "--seed", "Which jumps, of --order random",
          [&play](const std::string& option, const std::string& text) {
            play.seed = parse_count(option, text, 0);
          },
          "0")
      .type_name("N")
      .show_default();
  command.add_flag(
      "--motion", play.motion,
      "Measure how far the surface of all samples moves from each frame to the next, between two bounds");
}

void add_reading_options(const Command& command, PlayOptions& play) {
  command
      .add_converted(
          "--read-steps",
          "How much is read at a time: as many bytes as N steps of a page are before they are "
          "compressed, a quarter more or less",
          [&play](const std::string& option, const std::string& text) {
            play.read_steps = parse_count(option, text);
          },
          "10")
      .type_name("N")
      .show_default()
      .group("Paging");
  command
      .add_converted(
          "--ahead",
          "How many of the steps that follow are decoded meanwhile by other threads: one for every "
          "four of --threads, at least one and at most four; 0: none",
          [&play](const std::string& option, const std::string& text) {
            play.ahead = parse_count(option, text, 0);
          },
          "2")
      .type_name("N")
      .show_default()
      .group("Paging");
}

}  // namespace

void add_play(const Command& app, Session& session) {
  const auto options = std::make_shared<Options>();
  const Command command =
      add_command(app, session, "play", "Plays a series without a window, and measures",
                  "adamas play mixing.adm --isovalue 2.5 --error 0.7voxels --json play.json",
                  [options, &session] { run(*options, session); });
  add_store_input(command, options->input);
  add_surface_options(command, *options);
  add_order_options(command, *options);
  add_reading_options(command, options->play);
}

}  // namespace adamas::cli
