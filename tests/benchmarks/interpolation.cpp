// The surfaces of a stored series, step after step, with points and normals interpolated by the processor and
// by the vertex shader (D 5.6, table 5.2): seconds until a step's surface is worked out, until it is drawn,
// and for a picture of what is there already. Without a window. Prints a line of JSON for each.

#include <epoxy/gl.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "tests/benchmarks/support/measurement.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/scene/view_session.h"

namespace adamas::bench {
namespace {

constexpr int kWidth = 1024, kHeight = 768;

struct Series {
  std::string store;
  double isovalue = 0, voxels = 0.7;
  std::uint32_t first = 0, last = 0;
};

/// All data from one side, by a parallel projection, in which a pixel is one length everywhere.
void look_from_everywhere(ViewSession& session, double voxels, double voxel) {
  ViewState& state = session.state();
  const Box3 box = session.box();
  const double size = box.diagonal();
  state.viewpoint.target = box.center();
  state.viewpoint.eye = box.center() + size * Vec3{0.6, -0.64, 0.48};
  state.viewpoint.up = {0, 0, 1};
  state.viewpoint.near = 1e-3 * size;
  state.viewpoint.height = 1.1 * size;
  state.pixels = voxels * voxel * kHeight / state.viewpoint.height;
  state.max_triangles = 100'000'000;
  state.has_box = state.has_axes = false;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void play(const Series& series, bool in_shader, const OffscreenContext& context) {
  ViewSession session(kWidth, kHeight);
  DocumentOptions options;
  options.memory = std::size_t{2} << 30;
  options.interpolates_in_shader = in_shader;
  session.open(series.store, options, SilentProgress::instance());
  const Vec3 spacing = StoreFile(series.store).header().grid.spacing;
  look_from_everywhere(session, series.voxels, std::min({spacing.x, spacing.y, spacing.z}));
  DocumentState& state = session.state().documents[0];
  state.surfaces[0].isovalue = series.isovalue;
  const PictureTarget target(kWidth, kHeight);
  Renderer renderer;
  PictureContents contents;
  contents.viewpoint = session.state().viewpoint;
  std::vector<double> worked_out, shown, pictures, triangles;
  const auto draw = [&] {
    renderer.draw(contents, target.framebuffer(), kWidth, kHeight);
    glFinish();
  };
  for (std::uint32_t step = series.first; step <= series.last; ++step) {
    state.step = step;
    const double until_drawn = seconds_of([&] {
      session.finish();
      contents.parts = session.parts();
      draw();
    });
    if (const std::string problem = session.report().problem; !problem.empty())
      throw std::runtime_error(problem);
    // The first step reads what is the same of all.
    if (step == series.first) continue;
    shown.push_back(until_drawn);
    worked_out.push_back(session.report().seconds);
    triangles.push_back(static_cast<double>(session.report().triangles));
    pictures.push_back(seconds_of(draw));
  }
  std::printf(
      "{\"row\": \"interpolation\", \"by\": \"%s\", \"voxels\": %g, \"threads\": %u, \"triangles\": %.0f, "
      "\"worked_out\": %.5f, \"shown\": %.5f, \"slowest\": %.5f, \"picture\": %.5f, \"drawn_by\": \"%s\"}\n",
      in_shader ? "shader" : "processor", series.voxels, thread_limit(), quantile(triangles, 0.5),
      quantile(worked_out, 0.5), quantile(shown, 0.5), quantile(shown, 1), quantile(pictures, 0.5),
      context.name().c_str());
  std::fflush(stdout);
}

}  // namespace
}  // namespace adamas::bench

/// STORE ISOVALUE FIRST LAST THREADS VOXELS...
int main(int argc, char** argv) {
  using namespace adamas::bench;
  if (argc < 7) return 2;
  try {
    adamas::set_thread_limit(static_cast<unsigned>(std::atoi(argv[5])));
    const adamas::OffscreenContext context;
    for (int n = 6; n < argc; ++n) {
      const Series series{argv[1], std::atof(argv[2]), std::atof(argv[n]),
                          static_cast<std::uint32_t>(std::atoi(argv[3])),
                          static_cast<std::uint32_t>(std::atoi(argv[4]))};
      for (const bool in_shader : {false, true}) play(series, in_shader, context);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_interpolation: %s\n", error.what());
    return 1;
  }
}
