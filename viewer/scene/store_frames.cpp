#include "viewer/scene/store_frames.h"

#include <set>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "isosurface/storage/page_loader.h"
#include "isosurface/view/paged_frames.h"
#include "isosurface/volume/samples.h"

namespace adamas {

namespace {

template <class Sample>
class StoreFramesOf final : public StoreFrames {
 public:
  StoreFramesOf(StoreFile& file, std::uint32_t step, std::size_t memory, std::function<void()> arrived)
      : memory_(memory), pages_(file, step, memory), frames_(pages_), arrived_(std::move(arrived)) {}

  FrameFigures next(const FrameRequest& request) override {
    try {
      if (!request.resident_only) return frames_.refine(request);
      take_pages(request);
      const FrameFigures figures = frames_.refine(request);
      if (!figures.stopped) want_pages();
      return figures;
    } catch (const PageLost& lost) {
      fail("{}: {} is damaged", pages_.file().name(), page_name(lost.damaged));
    }
  }
  [[nodiscard]] bool is_paging() const override { return is_paging_; }
  [[nodiscard]] std::string paging_problem() const override { return loader_ ? loader_->problem() : ""; }
  void for_each_chunk(const std::function<void(const SurfaceChunk&)>& visit) const override {
    frames_.for_each_chunk(visit);
  }
  std::optional<double> error_at(const Vec3& place) override { return frames_.error_at(place); }
  std::vector<std::vector<Vec3>> cells_in(const Plane& plane) override { return frames_.cells_in(plane); }
  [[nodiscard]] PageCounts counts() const override {
    PageCounts counts = pages_.counts();
    // What the loader has read is there once more in the memory of the frames.
    if (loader_) {
      counts.pages = counts.predictors = 0;
      counts += loader_->counts();
    }
    return counts;
  }
  [[nodiscard]] Box3 data_box() const override { return frames_.diamonds().data_box(); }

 private:
  using Word = OrderedWord<Sample>;

  static bool is_same(const FrameRequest& a, const FrameRequest& b) {
    return a.viewpoint == b.viewpoint && a.depths == b.depths && a.isovalue == b.isovalue &&
           a.pixels == b.pixels && a.max_triangles == b.max_triangles;
  }
  std::pair<std::uint64_t, MissingPage::Part> key(const MissingPage& page) const {
    return {pages_.grid().number(page.id), page.part};
  }

  void take_pages(const FrameRequest& request) {
    if (!loader_) {
      // The pages that predict others are decoded once more by the loader.
      const std::size_t of_loader = memory_ / 4;
      pages_.set_memory(memory_ - of_loader);
      loader_ = std::make_unique<PageLoader<Word>>(pages_, of_loader, arrived_);
    }
    if (!last_ || !is_same(*last_, request)) {
      come_.clear();
      is_full_ = false;
    }
    last_ = request;
    last_->stop = nullptr;
    const auto taken = loader_->take(pages_, frames_.gradients());
    for (const MissingPage& page : taken.pages) come_.insert(key(page));
    is_full_ = is_full_ || taken.is_full;
  }

  void want_pages() {
    std::vector<MissingPage> wanted = frames_.missing_pages();
    std::erase_if(wanted, [&](const MissingPage& page) { return is_full_ || come_.contains(key(page)); });
    is_paging_ = !wanted.empty();
    loader_->want(std::move(wanted));
  }

  std::size_t memory_;
  StoredPages<Word> pages_;
  PagedFrames<Sample> frames_;
  std::function<void()> arrived_;
  std::optional<FrameRequest> last_;
  std::set<std::pair<std::uint64_t, MissingPage::Part>> come_;  ///< for the view of last_
  bool is_full_ = false, is_paging_ = false;
  std::unique_ptr<PageLoader<Word>> loader_;
};

}  // namespace

std::unique_ptr<StoreFrames> StoreFrames::open(StoreFile& file, std::uint32_t step, std::size_t memory,
                                               std::function<void()> arrived) {
  return with_sample_type(file.header().grid.type, [&](auto sample) -> std::unique_ptr<StoreFrames> {
    return std::make_unique<StoreFramesOf<decltype(sample)>>(file, step, memory, std::move(arrived));
  });
}

}  // namespace adamas
