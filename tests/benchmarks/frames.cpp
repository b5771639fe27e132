// Measures frames of a flight once round the middle of a store and into it, without drawing: processor
// seconds for each, with normals, on one thread. Then two isovalues are shown in turn from where the flight
// ends, beside Flying Edges on all samples where these are given raw. Prints a line of JSON for each row.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/view/paged_frames.h"
#include "tests/benchmarks/peers/flying_edges.h"
#include "tests/benchmarks/support/measurement.h"
#include "timevarying/page_loader.h"

namespace adamas::bench {

using namespace isosurface;
using namespace timevarying;

namespace {

struct Flight {
  double isovalue = 0;
  int frames = 600;
  std::uint64_t max_triangles = 500'000;
};

FrameRequest frame(const Box3& box, const Flight& flight, int n) {
  constexpr double kPi = std::numbers::pi;
  const double part = n / std::max(1.0, flight.frames - 1.0);
  const Vec3 sides = box.size();
  const double size = std::max({sides.x, sides.y, sides.z}), away = size * (1.4 - part);
  FrameRequest request;
  request.isovalue = flight.isovalue;
  request.max_triangles = flight.max_triangles;
  request.viewpoint.target = box.center();
  request.viewpoint.eye =
      box.center() + Vec3{away * std::cos(2 * kPi * part), away * std::sin(2 * kPi * part),
                          0.25 * size * std::sin(4 * kPi * part)};
  request.viewpoint.up = {0, 0, 1};
  return request;
}

template <class Sample>
void fly(StoreFile& file, const Flight& flight) {
  StoredPages<OrderedWord<Sample>> pages(file, 0, std::size_t{1} << 30);
  PagedFrames<Sample> frames(pages);
  const Box3 box = frames.diamonds().data_box();
  std::vector<double> seconds, changed;
  std::uint64_t triangles = 0;
  double largest_error = 0;
  for (int n = 0; n < flight.frames; ++n) {
    const double before = thread_seconds();
    const FrameFigures figures = frames.refine(frame(box, flight, n));
    seconds.push_back(thread_seconds() - before);
    const ChunkChanges& changes = frames.changes();
    changed.push_back(static_cast<double>(changes.added.size() + changes.changed.size()));
    triangles = std::max(triangles, figures.triangles);
    largest_error = std::max(largest_error, figures.largest_error);
  }
  const double first = seconds.front();
  seconds.erase(seconds.begin());
  std::printf(
      "{\"row\": \"frames\", \"frames\": %d, \"triangles\": %llu, \"largest_error_pixels\": %.3f, "
      "\"first\": %.5f, \"median\": %.5f, \"percentile_99\": %.5f, \"greatest\": %.5f, "
      "\"changed_chunks\": %.0f}\n",
      flight.frames, static_cast<unsigned long long>(triangles), largest_error, first, quantile(seconds, 0.5),
      quantile(seconds, 0.99), quantile(seconds, 1), quantile(changed, 0.5));
}

/// Measures the same flight where no page is in memory at first and there is room for some only. Frames
/// either wait for pages, or do without those that a thread loads meanwhile; then the number of frames until
/// nothing is missing in the first view, and the pages missing on the way, are printed too.
template <class Sample>
void fly_cold(StoreFile& file, const Flight& flight, std::size_t memory, bool is_async) {
  using Word = OrderedWord<Sample>;
  StoredPages<Word> pages(file, 0, is_async ? memory - memory / 4 : memory);
  PagedFrames<Sample> frames(pages);
  std::unique_ptr<PageLoader<Word>> loader;
  if (is_async) loader = std::make_unique<PageLoader<Word>>(pages, memory / 4);
  const Box3 box = frames.diamonds().data_box();
  std::vector<double> seconds, missing;
  const auto next = [&](int n) {
    FrameRequest request = frame(box, flight, n);
    request.resident_only = is_async;
    const double before = thread_seconds();
    bool is_full = false;
    if (loader) is_full = !loader->take(pages, frames.gradients()).without_room.empty();
    const FrameFigures figures = frames.refine(request);
    if (loader) loader->want(frames.missing_pages());
    seconds.push_back(thread_seconds() - before);
    missing.push_back(static_cast<double>(figures.pages_missing));
    return figures.pages_missing == 0 || is_full;
  };
  int until_whole = 1;
  for (; !next(0); ++until_whole) loader->wait();
  for (int n = 1; n < flight.frames; ++n) next(n);
  std::printf(
      "{\"row\": \"cold\", \"async\": %s, \"memory\": %zu, \"first\": %.5f, \"median\": %.5f, "
      "\"percentile_99\": %.5f, \"greatest\": %.5f, \"frames_until_whole\": %d, \"missing_median\": %.0f, "
      "\"missing_greatest\": %.0f}\n",
      is_async ? "true" : "false", memory, seconds.front(), quantile(seconds, 0.5), quantile(seconds, 0.99),
      quantile(seconds, 1), until_whole, quantile(missing, 0.5), quantile(missing, 1));
}

/// Measures the change from one isovalue to another in the same view, a few times there and back.
template <class Sample>
void change_isovalue(StoreFile& file, const Flight& flight, const FlyingEdges& peer) {
  StoredPages<OrderedWord<Sample>> pages(file, 0, std::size_t{1} << 30);
  PagedFrames<Sample> frames(pages);
  const Box3 box = frames.diamonds().data_box();
  FrameRequest request = frame(box, flight, flight.frames / 2);
  std::vector<double> ours, theirs;
  std::uint64_t triangles = 0;
  for (int run = 0; run < 6; ++run) {
    request.isovalue = flight.isovalue * (run % 2 == 0 ? 1 : 0.95);
    const double before = thread_seconds();
    triangles = std::max(triangles, frames.refine(request).triangles);
    if (run > 1) ours.push_back(thread_seconds() - before);
  }
  if (!peer.raw.empty()) {
    for (int run = 0; run < 3; ++run)
      theirs.push_back(measure_in_child([&] { return Outcome{peer.count(), 0}; }).processor_seconds);
  }
  std::printf("{\"row\": \"isovalue\", \"triangles\": %llu, \"adamas\": %.4f, \"peer\": %.4f}\n",
              static_cast<unsigned long long>(triangles), quantile(ours, 0.5), quantile(theirs, 0.5));
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_frames STORE ISOVALUE [FRAMES [TRIANGLES [RAW]]], or bench_frames STORE ISOVALUE FRAMES
/// TRIANGLES cold MEMORY for the rows of flights with MEMORY bytes of pages.
int main(int argc, char** argv) {
  if (argc < 3) return 2;
  adamas::set_thread_limit(1);
  adamas::bench::Flight flight;
  flight.isovalue = std::atof(argv[2]);
  if (argc > 3) flight.frames = std::atoi(argv[3]);
  if (argc > 4) flight.max_triangles = std::stoull(argv[4]);
  adamas::isosurface::StoreFile file(argv[1]);
  const adamas::VolumeGrid grid = file.header().grid;
  adamas::bench::FlyingEdges peer;
  if (argc > 5) peer.raw = argv[5];
  peer.dimensions = grid.dimensions;
  peer.type = grid.type;
  peer.isovalue = flight.isovalue;
  peer.normals = true;
  const bool is_cold = argc > 6 && std::string(argv[5]) == "cold";
  adamas::isosurface::with_sample_type(grid.type, [&](auto sample) {
    for (const bool is_async : {false, true}) {
      if (is_cold) adamas::bench::fly_cold<decltype(sample)>(file, flight, std::stoull(argv[6]), is_async);
    }
    if (is_cold) return;
    adamas::bench::fly<decltype(sample)>(file, flight);
    adamas::bench::change_isovalue<decltype(sample)>(file, flight, peer);
  });
}
