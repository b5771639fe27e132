#include "viewer/scene/store_frames.h"

#include "core/base/error.h"
#include "isosurface/view/paged_frames.h"
#include "isosurface/volume/samples.h"

namespace adamas {

namespace {

template <class Sample>
class StoreFramesOf final : public StoreFrames {
 public:
  StoreFramesOf(StoreFile& file, std::size_t memory) : pages_(file, 0, memory), frames_(pages_) {}

  FrameFigures next(const FrameRequest& request) override {
    try {
      return frames_.refine(request);
    } catch (const PageLost& lost) {
      fail("{}: {} is damaged", pages_.file().name(), page_name(lost.damaged));
    }
  }
  void for_each_chunk(const std::function<void(const SurfaceChunk&)>& visit) const override {
    frames_.for_each_chunk(visit);
  }
  std::optional<double> error_at(const Vec3& place) override { return frames_.error_at(place); }
  std::vector<std::vector<Vec3>> cells_in(const Plane& plane) override { return frames_.cells_in(plane); }
  [[nodiscard]] PageCounts counts() const override { return pages_.counts(); }
  [[nodiscard]] Box3 data_box() const override { return frames_.diamonds().data_box(); }

 private:
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
