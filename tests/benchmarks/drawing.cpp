// Measures drawing the surface of a store from chunks in mapped buffers, by one command for each block of
// them, beside one indexed draw of the same triangles from one buffer that never changes, with the same
// shaders. There is no window; meshes are found and copied before. Prints a line of JSON: medians of the
// processor seconds of all threads for a picture until it is complete, and of elapsed seconds.

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/benchmarks/support/measurement.h"
#include "viewer/gl/offscreen_context.h"
#include "viewer/gl/picture_target.h"
#include "viewer/gl/renderer.h"
#include "viewer/session/view_session.h"

namespace adamas::bench {

using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

constexpr int kWidth = 1024, kHeight = 768;

/// Draws all triangles of parts with the same style from one static buffer each for vertices and indices.
class PlainDraw {
 public:
  PlainDraw(const std::vector<DrawnPart>& parts, const Vec3& target) {
    std::vector<DrawnMesh::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    for (const DrawnPart& part : parts) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      const std::array<float, 3> offset = in_single(part.mesh->origin - target);
      for (DrawnMesh::Vertex vertex : part.mesh->vertices) {
        for (std::size_t n = 0; n < 3; ++n) vertex.place[n] += offset[n];
        vertices.push_back(vertex);
      }
      for (const std::uint32_t index : part.mesh->indices) indices.push_back(first + index);
    }
    count_ = static_cast<GLsizei>(indices.size());
    const GLuint vertex_buffer = filled(vertices);
    glCreateVertexArrays(1, &array_);
    constexpr std::array<std::array<std::size_t, 2>, 3> kAttributes{
        {{3, offsetof(DrawnMesh::Vertex, place)},
         {3, offsetof(DrawnMesh::Vertex, normal)},
         {2, offsetof(DrawnMesh::Vertex, front_value)}}};
    for (GLuint n = 0; n < kAttributes.size(); ++n) {
      glEnableVertexArrayAttrib(array_, n);
      glVertexArrayAttribFormat(array_, n, static_cast<GLint>(kAttributes[n][0]), GL_FLOAT, GL_FALSE,
                                static_cast<GLuint>(kAttributes[n][1]));
      glVertexArrayAttribBinding(array_, n, 0);
    }
    glVertexArrayVertexBuffer(array_, 0, vertex_buffer, 0, sizeof(DrawnMesh::Vertex));
    glVertexArrayElementBuffer(array_, filled(indices));
    // This is the layout of the shaders: an origin and the numbers of a style; two colours, a range and
    // flags.
    const PartStyle& style = parts.front().style;
    const auto colour = [](const Colour& c) {
      return std::array{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), 1.0F};
    };
    draws_ = filled(std::vector<float>(8, 0));
    std::vector<float> numbers(16, 0);
    std::ranges::copy(colour(style.front), numbers.begin());
    std::ranges::copy(colour(style.back), numbers.begin() + 4);
    styles_ = filled(numbers);
  }

  /// Draws into the framebuffer with the program, and its parameters, that the last picture has set.
  void draw(std::uint32_t framebuffer) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kWidth, kHeight);
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, draws_);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, styles_);
    glBindVertexArray(array_);
    glVertexAttribI1ui(3, 0);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
    glDisable(GL_POLYGON_OFFSET_FILL);
  }

 private:
  template <class T>
  static GLuint filled(const std::vector<T>& values) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), 0);
    return name;
  }

  GLuint array_ = 0, draws_ = 0, styles_ = 0;
  GLsizei count_ = 0;
};

/// Processor seconds of all threads of this program, and elapsed seconds.
struct Seconds {
  std::vector<double> processor, elapsed;

  template <class Work>
  void add(Work&& work) {
    const auto now = [] {
      timespec time{};
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
      return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const auto begin = std::chrono::steady_clock::now();
    const double before = now();
    work();
    glFinish();
    processor.push_back(now() - before);
    elapsed.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
};

/// Returns the share of pixels that differ.
double difference(const Raster& a, const Raster& b) {
  std::size_t differing = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Raster::Pixel &p = a.at(x, y), &q = b.at(x, y);
      const int most = std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
      differing += most > 8 ? 1 : 0;
    }
  }
  return static_cast<double>(differing) / (kWidth * kHeight);
}

void compare(const char* store, double isovalue, std::uint64_t triangles, int repeats) {
  ViewSession session(kWidth, kHeight);
  session.open(store, {}, SilentProgress::instance());
  ViewState& state = session.state();
  state.documents[0].surfaces[0].isovalue = isovalue;
  state.pixels = 0.25;
  state.max_triangles = triangles;
  state.has_box = false;
  session.finish();
  if (const std::string problem = session.report().problem; !problem.empty())
    throw std::runtime_error(problem);
  const OffscreenContext context;
  PictureContents contents;
  contents.parts = session.parts();
  contents.viewpoint = state.viewpoint;
  const PictureTarget target(kWidth, kHeight);
  Renderer renderer;
  DrawFigures figures = renderer.draw(contents, target.framebuffer(), kWidth, kHeight);
  const Raster ours = target.read();
  const PlainDraw plain(contents.parts, contents.viewpoint.target);
  plain.draw(target.framebuffer());
  const double differing = difference(ours, target.read());
  if (differing > 1e-3) throw std::runtime_error("the two pictures are not the same");
  Seconds of_renderer, of_plain;
  for (int n = 0; n < repeats; ++n) {
    of_renderer.add([&] { figures = renderer.draw(contents, target.framebuffer(), kWidth, kHeight); });
    of_plain.add([&] { plain.draw(target.framebuffer()); });
  }
  std::printf(
      "{\"row\": \"drawing\", \"triangles\": %llu, \"chunks\": %zu, \"draw_calls\": %llu, "
      "\"differing_pixels\": %.6f, \"adamas\": %.5f, \"plain\": %.5f, \"adamas_elapsed\": %.5f, "
      "\"plain_elapsed\": %.5f, \"drawn_by\": \"%s\"}\n",
      static_cast<unsigned long long>(figures.triangles), contents.parts.size(),
      static_cast<unsigned long long>(figures.draw_calls), differing, quantile(of_renderer.processor, 0.5),
      quantile(of_plain.processor, 0.5), quantile(of_renderer.elapsed, 0.5), quantile(of_plain.elapsed, 0.5),
      context.name().c_str());
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_drawing STORE ISOVALUE [TRIANGLES [REPEATS]].
int main(int argc, char** argv) {
  if (argc < 3) return 2;
  try {
    adamas::bench::compare(argv[1], std::atof(argv[2]), argc > 3 ? std::stoull(argv[3]) : 500'000,
                           argc > 4 ? std::atoi(argv[4]) : 15);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_drawing: %s\n", error.what());
    return 1;
  }
}
