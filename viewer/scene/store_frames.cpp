#include "viewer/scene/store_frames.h"

#include <chrono>
#include <utility>

#include "core/base/error.h"
#include "isosurface/view/paged_frames.h"
#include "isosurface/volume/samples.h"

namespace adamas {

namespace {

/// Seconds since it was made or last asked.
class Clock {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void append(const SurfaceChunk& chunk, TriangleSurface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.points.size());
  surface.points.insert(surface.points.end(), chunk.points.begin(), chunk.points.end());
  surface.normals.insert(surface.normals.end(), chunk.normals.begin(), chunk.normals.end());
  for (const auto& [a, b, c] : chunk.triangles)
    surface.triangles.push_back({first + a, first + b, first + c});
}

template <class Sample>
class StoreFramesOf final : public StoreFrames {
 public:
  StoreFramesOf(StoreFile& file, std::size_t memory) : pages_(file, 0, memory), frames_(pages_) {}

  Frame next(const FrameRequest& request) override {
    try {
      return found(request);
    } catch (const PageLost& lost) {
      fail("{}: {} is damaged", pages_.file().name(), page_name(lost.damaged));
    }
  }
  [[nodiscard]] PageCounts counts() const override { return pages_.counts(); }
  [[nodiscard]] Box3 data_box() const override { return frames_.diamonds().data_box(); }

 private:
  Frame found(const FrameRequest& request) {
    Frame frame;
    Clock clock;
    frame.figures = frames_.refine(request);
    frames_.for_each_chunk([&](const SurfaceChunk& chunk) { append(chunk, frame.surface); });
    frame.update_seconds = clock.lap();
    return frame;
  }

  StoredPages<OrderedWord<Sample>> pages_;
  PagedFrames<Sample> frames_;
};

}  // namespace

std::unique_ptr<StoreFrames> StoreFrames::open(StoreFile& file, std::size_t memory) {
  return with_sample_type(file.header().grid.type, [&](auto sample) -> std::unique_ptr<StoreFrames> {
    return std::make_unique<StoreFramesOf<decltype(sample)>>(file, memory);
  });
}

}  // namespace adamas
