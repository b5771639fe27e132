// Measures the surfaces of a stored series, step after step, with points and normals interpolated by the
// processor and by the vertex shader (D 5.6, table 5.2): seconds until a step's surface is found, until it is
// drawn, and for a picture of the present surface; then how many steps and pictures a second are shown as a
// window plays them. There is no window. Prints a line of JSON for each.

#include <epoxy/gl.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/view/flight.h"
#include "tests/benchmarks/support/measurement.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/session/view_session.h"

namespace adamas::bench {

using namespace isosurface;
using namespace timevarying;
using namespace viewer;

namespace {

constexpr int kWidth = 1024, kHeight = 768;

struct Series {
  std::string store;
  double isovalue = 0, voxels = 0.7;
  std::uint32_t first = 0, last = 0;
};

/// Shows all data from one side, by a parallel projection, in which a pixel has the same size everywhere.
void look_from_everywhere(ViewSession& session, double voxels, double voxel) {
  ViewState& state = session.state();
  state.viewpoint = from_everywhere(session.box(), kWidth, kHeight);
  state.pixels = voxels * voxel * kHeight / state.viewpoint.height;
  state.max_triangles = 100'000'000;
  state.has_box = state.has_axes = false;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A session that shows one step of a series.
struct Shown {
  ViewSession session{kWidth, kHeight};
  PictureTarget target{kWidth, kHeight};
  Renderer renderer;
  PictureContents contents;

  Shown(const Series& series, bool in_shader, bool waits_for_pages) {
    DocumentOptions options;
    options.memory = std::size_t{2} << 30;
    options.interpolates_in_shader = in_shader;
    options.waits_for_pages = waits_for_pages;
    session.open(series.store, options, SilentProgress::instance());
    const Vec3 spacing = StoreFile(series.store).header().grid.spacing;
    look_from_everywhere(session, series.voxels, std::min({spacing.x, spacing.y, spacing.z}));
    session.state().documents[0].surfaces[0].isovalue = series.isovalue;
    session.set_step(series.first);
    contents.viewpoint = session.state().viewpoint;
  }
  void draw() {
    renderer.draw(contents, target.framebuffer(), kWidth, kHeight);
    glFinish();
  }
  void draw_now() {
    contents.parts = session.parts();
    draw();
  }
  void finish() {
    session.finish();
    if (const std::string problem = session.report().problem; !problem.empty())
      throw std::runtime_error(problem);
  }
};

/// Measures each step by itself.
void step_by_step(const Series& series, bool in_shader, const std::string& drawn_by) {
  Shown shown(series, in_shader, true);
  std::vector<double> worked_out, until_drawn, pictures, triangles;
  for (std::uint32_t step = series.first; step <= series.last; ++step) {
    shown.session.set_step(step);
    const double seconds = seconds_of([&] {
      shown.finish();
      shown.draw_now();
    });
    // The first step also reads what all steps have in common.
    if (step == series.first) continue;
    until_drawn.push_back(seconds);
    worked_out.push_back(shown.session.report().seconds);
    triangles.push_back(static_cast<double>(shown.session.report().triangles));
    pictures.push_back(seconds_of([&] { shown.draw(); }));
  }
  std::printf(
      "{\"row\": \"interpolation\", \"by\": \"%s\", \"voxels\": %g, \"threads\": %u, \"triangles\": %.0f, "
      "\"worked_out\": %.5f, \"until_drawn\": %.5f, \"picture\": %.5f, \"drawn_by\": \"%s\"}\n",
      in_shader ? "shader" : "processor", series.voxels, thread_limit(), quantile(triangles, 0.5),
      quantile(worked_out, 0.5), quantile(until_drawn, 0.5), quantile(pictures, 0.5), drawn_by.c_str());
  std::fflush(stdout);
}

/// Plays as a window does: pages are read ahead, and a picture is drawn while the next surface is found.
void play(const Series& series, bool in_shader, const std::string& drawn_by) {
  Shown shown(series, in_shader, false);
  shown.finish();
  shown.draw_now();
  StepClock& clock = shown.session.clock();
  clock.pace().steps_per_second = 1000;
  clock.pace().repeat = Repeat::kOnce;
  shown.session.play_steps();
  std::uint32_t steps = 0;
  std::vector<double> between, of_pictures, triangles;
  double last_frame = 0, since = 0;
  const double seconds = seconds_of([&] {
    while (shown.session.step() < series.last) {
      const std::uint32_t before = shown.session.step();
      shown.session.advance(last_frame);
      last_frame = seconds_of([&] { shown.draw_now(); });
      since += last_frame;
      of_pictures.push_back(last_frame);
      if (shown.session.step() == before) continue;
      ++steps;
      between.push_back(since);
      triangles.push_back(static_cast<double>(shown.session.report().triangles));
      since = 0;
    }
  });
  std::printf(
      "{\"row\": \"played\", \"by\": \"%s\", \"voxels\": %g, \"threads\": %u, \"triangles\": %.0f, "
      "\"steps_per_second\": %.2f, \"longest_step\": %.5f, \"pictures_per_second\": %.1f, "
      "\"longest_picture\": %.5f, \"drawn_by\": \"%s\"}\n",
      in_shader ? "shader" : "processor", series.voxels, thread_limit(), quantile(triangles, 0.5),
      steps / seconds, quantile(between, 1), static_cast<double>(of_pictures.size()) / seconds,
      quantile(of_pictures, 1), drawn_by.c_str());
  std::fflush(stdout);
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_interpolation STORE ISOVALUE FIRST LAST THREADS VOXELS...
int main(int argc, char** argv) {
  using namespace adamas::bench;
  if (argc < 7) return 2;
  try {
    adamas::set_thread_limit(static_cast<unsigned>(std::atoi(argv[5])));
    const adamas::viewer::OffscreenContext context;
    for (int n = 6; n < argc; ++n) {
      const Series series{argv[1], std::atof(argv[2]), std::atof(argv[n]),
                          static_cast<std::uint32_t>(std::atoi(argv[3])),
                          static_cast<std::uint32_t>(std::atoi(argv[4]))};
      for (const bool in_shader : {false, true}) {
        step_by_step(series, in_shader, context.name());
        play(series, in_shader, context.name());
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_interpolation: %s\n", error.what());
    return 1;
  }
}
