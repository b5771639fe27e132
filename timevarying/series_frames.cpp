#include "timevarying/series_frames.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/view/paged_frames.h"
#include "isosurface/volume/samples.h"
#include "timevarying/page_loader.h"
#include "timevarying/step_pages.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

template <class Sample>
class SeriesFramesOf final : public SeriesFrames {
 public:
  SeriesFramesOf(StoreFile& file, std::size_t memory, std::function<void()> arrived, SurfaceForm form)
      : memory_(memory),
        steps_(file, memory),
        frames_(steps_.at(0), PagedFrames<Sample>::kMemory, form),
        arrived_(std::move(arrived)) {}

  FrameFigures next(std::uint32_t step, const FrameRequest& request) override {
    try {
      StoredPages<Word>& pages = steps_.at(step);
      frames_.set_pages(pages);
      if (loader_ || request.resident_only) take_pages(step, request);
      // What is read ahead comes sooner than it would be read once more.
      if (loader_ && !request.resident_only) {
        while (!is_ready(step) && !loader_->is_idle()) {
          loader_->wait();
          take_arrived();
        }
      }
      const FrameFigures figures = frames_.refine(request);
      if (loader_ && !figures.stopped) want_pages(request.resident_only);
      return figures;
    } catch (const PageLost& lost) {
      fail("{}: {} is damaged", steps_.file().name(), page_name(lost.damaged));
    }
  }
  void expect(std::vector<std::uint32_t> steps) override {
    if (!steps.empty()) open_loader();
    if (steps == expected_) return;
    expected_ = std::move(steps);
    if (loader_) want_pages(is_resident_);
  }
  [[nodiscard]] bool is_ready(std::uint32_t step) override {
    take_arrived();
    StoredPages<Word>& pages =
        step == frames_.pages().step() ? frames_.pages() : steps_.ahead(step, frames_.pages());
    return std::ranges::all_of(needed_, [&](const MissingPage& page) {
      return pages.is_lost(page.id) || pages.has(page.id, parts_of(page));
    });
  }
  [[nodiscard]] std::vector<LoadedStep> loaded_steps() override {
    take_arrived();
    std::vector<LoadedStep> loaded;
    steps_.for_each_in_memory([&](const StoredPages<Word>& pages) {
      const auto there = std::ranges::count_if(needed_, [&](const MissingPage& page) {
        return pages.is_lost(page.id) || pages.holds(page.id, parts_of(page));
      });
      loaded.push_back({pages.step(), static_cast<std::uint64_t>(there), needed_.size()});
    });
    return loaded;
  }
  [[nodiscard]] bool is_paging() const override { return is_paging_; }
  [[nodiscard]] bool is_reading_ahead() override {
    take_arrived();
    return loader_ && !loader_->is_idle();
  }
  void wait() override {
    if (loader_) loader_->wait();
  }
  [[nodiscard]] std::string paging_problem() const override { return loader_ ? loader_->problem() : ""; }
  void for_each_chunk(const std::function<void(const SurfaceChunk&)>& visit) const override {
    frames_.for_each_chunk(visit);
  }
  std::optional<double> error_at(const Vec3& place) override { return frames_.error_at(place); }
  std::vector<std::vector<Vec3>> cells_in(const Plane& plane) override { return frames_.cells_in(plane); }
  [[nodiscard]] PageCounts counts() const override {
    PageCounts counts = steps_.counts();
    if (!loader_) return counts;
    // What the loader has read is there once more in the memory of the frames.
    const PageCounts loaded = loader_->counts();
    if (is_resident_) counts.pages = counts.predictors = 0;
    counts += loaded;
    return counts;
  }
  [[nodiscard]] std::uint64_t page_reads() const override {
    return steps_.file().page_reads() + (loader_ ? loader_->page_reads() : 0);
  }
  [[nodiscard]] Box3 data_box() const override { return frames_.diamonds().data_box(); }

 private:
  using Word = OrderedWord<Sample>;

  static bool is_same(const FrameRequest& a, const FrameRequest& b) {
    return a.viewpoint == b.viewpoint && a.depths == b.depths && a.isovalue == b.isovalue &&
           a.pixels == b.pixels && a.max_triangles == b.max_triangles;
  }
  static PageParts parts_of(const MissingPage& page) {
    return page.part == MissingPage::Part::kAll ? PageParts::kAll : PageParts::kSamples;
  }
  using Key = std::pair<std::uint64_t, MissingPage::Part>;
  [[nodiscard]] Key key(const MissingPage& page) const {
    return {steps_.file().grid().number(page.id), page.part};
  }

  void open_loader() {
    if (loader_) return;
    // The pages that predict others, and those that others are coded with, are decoded once more by the
    // loader.
    const std::size_t of_loader = steps_.file().steps() > 1 ? memory_ / 2 : memory_ / 4;
    steps_.set_memory(memory_ - of_loader);
    // Some threads are for the frames themselves.
    const std::size_t threads = std::clamp<std::size_t>(thread_limit() / 4, 1, 4);
    loader_ = std::make_unique<PageLoader<Word>>(frames_.pages(), of_loader, arrived_, threads);
  }

  void take_pages(std::uint32_t step, const FrameRequest& request) {
    open_loader();
    if (!last_ || step != last_step_ || !is_same(*last_, request)) {
      arrived_pages_.clear();
      is_full_ = false;
    }
    last_step_ = step;
    last_ = request;
    last_->stop = nullptr;
    is_resident_ = request.resident_only;
    take_arrived();
  }

  void take_arrived() {
    if (!loader_) return;
    const auto pages_of = [this](std::uint32_t step) -> StoredPages<Word>* {
      const bool is_expected = std::ranges::find(expected_, step) != expected_.end();
      return is_expected ? &steps_.ahead(step, frames_.pages()) : nullptr;
    };
    const auto taken = loader_->take(frames_.pages(), frames_.gradients(), pages_of);
    for (const MissingPage& page : taken.pages) arrived_pages_.insert(key(page));
    is_full_ = is_full_ || taken.is_full;
  }

  void want_pages(bool resident_only) {
    std::vector<MissingPage> wanted;
    if (resident_only) wanted = frames_.missing_pages();
    std::erase_if(wanted,
                  [&](const MissingPage& page) { return is_full_ || arrived_pages_.contains(key(page)); });
    is_paging_ = !wanted.empty();
    if (steps_.file().steps() > 1) needed_ = frames_.needed_pages();
    for (const std::uint32_t step : expected_) {
      if (step == frames_.pages().step()) continue;
      StoredPages<Word>& pages = steps_.ahead(step, frames_.pages());
      for (MissingPage page : needed_) {
        page.step = step;
        if (!pages.is_lost(page.id) && !pages.has(page.id, parts_of(page))) wanted.push_back(page);
      }
    }
    loader_->want(std::move(wanted));
  }

  std::size_t memory_;
  StepPages<Word> steps_;
  PagedFrames<Sample> frames_;
  std::function<void()> arrived_;
  std::optional<FrameRequest> last_;
  std::uint32_t last_step_ = 0;
  std::set<Key> arrived_pages_;  ///< pages that have come for the view of last_
  bool is_full_ = false, is_paging_ = false, is_resident_ = false;
  std::vector<std::uint32_t> expected_;
  std::vector<MissingPage> needed_;  ///< by the last frame of a series; none before there is a loader
  std::unique_ptr<PageLoader<Word>> loader_;
};

}  // namespace

std::unique_ptr<SeriesFrames> SeriesFrames::open(StoreFile& file, std::size_t memory,
                                                 std::function<void()> arrived, SurfaceForm form) {
  return with_sample_type(file.header().grid.type, [&](auto sample) -> std::unique_ptr<SeriesFrames> {
    return std::make_unique<SeriesFramesOf<decltype(sample)>>(file, memory, std::move(arrived), form);
  });
}

}  // namespace adamas::timevarying
