#include "timevarying/series_frames.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "isosurface/view/paged_frames.h"
#include "isosurface/volume/samples.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

template <class Sample>
class SeriesFramesOf final : public SeriesFrames, private PageUser<OrderedWord<Sample>> {
 public:
  SeriesFramesOf(SharedPagesOf<OrderedWord<Sample>>& shared, SurfaceForm form)
      : shared_(shared),
        pages_(shared.steps().shared(0)),
        gradients_(shared.gradients(0)),
        frames_(*pages_, PagedFrames<Sample>::kMemory, form, gradients_.get()) {
    shared_.add_user(*this);
  }
  ~SeriesFramesOf() override {
    const SharedPages::Lock lock = shared_.lock();
    shared_.remove_user(*this);
    // The pages are freed while the lock is held, since their memory belongs to its holder.
    pages_.reset();
  }

  FrameFigures next(std::uint32_t step, const FrameRequest& request) override {
    const SharedPages::Lock lock = shared_.lock();
    try {
      // A frame begins with the mesh of the last one, and compares that one's pages with its own.
      const auto last_pages = pages_;
      const auto last_gradients = gradients_;
      set_step(step);
      if (shared_.loader() != nullptr || request.resident_only) take_pages(step, request);
      // Pages that are being read ahead are awaited, which is faster than reading them again.
      PageLoader<Word>* const loader = shared_.loader();
      if (loader != nullptr && !request.resident_only) {
        while (!has_needed(step) && !loader->is_idle()) {
          loader->wait();
          take_arrived();
        }
      }
      const FrameFigures figures = frames_.refine(request);
      if (loader != nullptr && !figures.stopped) want_pages();
      return figures;
    } catch (const PageLost& lost) {
      fail("{}: {} is damaged", shared_.file().name(), page_name(lost.damaged));
    }
  }
  void expect(std::vector<std::uint32_t> steps) override {
    const SharedPages::Lock lock = shared_.lock();
    if (!steps.empty()) shared_.open_loader();
    if (steps == this->expected) return;
    this->expected = std::move(steps);
    if (shared_.loader() != nullptr) want_pages();
  }
  [[nodiscard]] bool is_ready(std::uint32_t step) override {
    const SharedPages::Lock lock = shared_.lock();
    return has_needed(step);
  }
  [[nodiscard]] std::vector<LoadedStep> loaded_steps() override {
    const SharedPages::Lock lock = shared_.lock();
    take_arrived();
    std::vector<LoadedStep> loaded;
    shared_.steps().for_each_in_memory([&](const StoredPages<Word>& pages) {
      const auto there = std::ranges::count_if(this->needed, [&](const MissingPage& page) {
        return pages.is_lost(page.id) || pages.holds(page.id, parts_of(page));
      });
      loaded.push_back({pages.step(), static_cast<std::uint64_t>(there), this->needed.size()});
    });
    return loaded;
  }
  [[nodiscard]] bool is_paging() const override { return !this->missing.empty(); }
  [[nodiscard]] bool is_reading_ahead() override {
    const SharedPages::Lock lock = shared_.lock();
    take_arrived();
    return shared_.loader() != nullptr && !shared_.loader()->is_idle();
  }
  void wait() override {
    const SharedPages::Lock lock = shared_.lock();
    if (shared_.loader() != nullptr) shared_.loader()->wait();
  }
  [[nodiscard]] std::string paging_problem() const override {
    const SharedPages::Lock lock = shared_.lock();
    return shared_.loader() != nullptr ? shared_.loader()->problem() : "";
  }
  void for_each_chunk(const std::function<void(const SurfaceChunk&)>& visit) const override {
    frames_.for_each_chunk(visit);
  }
  std::optional<double> error_at(const Vec3& place) override {
    const SharedPages::Lock lock = shared_.lock();
    return frames_.error_at(place);
  }
  std::vector<std::vector<Vec3>> cells_in(const Plane& plane) override {
    const SharedPages::Lock lock = shared_.lock();
    return frames_.cells_in(plane);
  }
  [[nodiscard]] Box3 data_box() const override { return frames_.diamonds().data_box(); }

 private:
  using Word = OrderedWord<Sample>;

  [[nodiscard]] StoredPages<Word>& pages() override { return *pages_; }
  void note(const typename PageLoader<Word>::Taken& taken) override {
    for (const MissingPage& page : taken.pages) {
      if (page.step == pages_->step()) arrived_pages_.insert(key(page));
    }
    for (const MissingPage& page : taken.without_room) {
      const bool is_missing = std::ranges::any_of(this->missing, [&](const MissingPage& own) {
        return own.step == page.step && key(own) == key(page);
      });
      is_full_ = is_full_ || is_missing;
    }
  }

  static bool is_same(const FrameRequest& a, const FrameRequest& b) {
    return a.viewpoint == b.viewpoint && a.depths == b.depths && a.isovalue == b.isovalue &&
           a.pixels == b.pixels && a.max_triangles == b.max_triangles;
  }
  using Key = std::pair<std::uint64_t, MissingPage::Part>;
  [[nodiscard]] Key key(const MissingPage& page) const {
    return {shared_.file().grid().number(page.id), page.part};
  }

  void set_step(std::uint32_t step) {
    auto pages = shared_.steps().shared(step);
    if (pages == pages_) return;
    auto gradients = shared_.gradients(step);
    pages_ = std::move(pages);
    gradients_ = std::move(gradients);
    frames_.set_pages(*pages_, gradients_.get());
  }

  void take_pages(std::uint32_t step, const FrameRequest& request) {
    shared_.open_loader();
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

  void take_arrived() { shared_.take_arrived(*this, gradients_.get()); }

  bool has_needed(std::uint32_t step) {
    take_arrived();
    StoredPages<Word>& pages = step == pages_->step() ? *pages_ : shared_.steps().ahead(step, *pages_);
    return std::ranges::all_of(this->needed, [&](const MissingPage& page) {
      return pages.is_lost(page.id) || pages.has(page.id, parts_of(page));
    });
  }

  void want_pages() {
    this->missing.clear();
    if (is_resident_ && !is_full_) this->missing = frames_.missing_pages();
    std::erase_if(this->missing, [&](const MissingPage& page) { return arrived_pages_.contains(key(page)); });
    if (shared_.file().steps() > 1 || shared_.has_several_users()) this->needed = frames_.needed_pages();
    shared_.load_wanted();
  }

  SharedPagesOf<Word>& shared_;
  std::shared_ptr<StoredPages<Word>> pages_;    ///< pages of the last frame's step
  std::shared_ptr<StoredGradients> gradients_;  ///< gradients of that step; null if the store has none
  PagedFrames<Sample> frames_;
  std::optional<FrameRequest> last_;
  std::uint32_t last_step_ = 0;
  std::set<Key> arrived_pages_;  ///< pages that have arrived for the view of last_
  bool is_full_ = false;         ///< whether the memory had no room for some page of that view
  bool is_resident_ = false;
};

}  // namespace

std::unique_ptr<SeriesFrames> SeriesFrames::open(SharedPages& pages, SurfaceForm form) {
  const SharedPages::Lock lock = pages.lock();
  return with_sample_type(pages.file().header().grid.type, [&](auto sample) -> std::unique_ptr<SeriesFrames> {
    using Sample = decltype(sample);
    return std::make_unique<SeriesFramesOf<Sample>>(static_cast<SharedPagesOf<OrderedWord<Sample>>&>(pages),
                                                    form);
  });
}

}  // namespace adamas::timevarying
