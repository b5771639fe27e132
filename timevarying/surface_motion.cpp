#include "timevarying/surface_motion.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "isosurface/storage/page_comparison.h"
#include "isosurface/volume/samples.h"
#include "timevarying/step_pages.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

template <class Sample>
class SurfaceMotionOf final : public SurfaceMotion {
 public:
  SurfaceMotionOf(StoreFile& file, std::size_t memory) : file_(file), memory_(memory) {}

  bool is_same_surface(std::uint32_t from, std::uint32_t to, double isovalue) override {
    StoredPages<Word>&before = pages_of(from), &after = pages_of(to);
    const LatticePoint blocks = file_.grid().blocks(0);
    for (LatticePoint b{}; b.k < blocks.k; ++b.k) {
      for (b.j = 0; b.j < blocks.j; ++b.j) {
        for (b.i = 0; b.i < blocks.i; ++b.i) {
          if (!is_crossed(from, b, isovalue) && !is_crossed(to, b, isovalue)) continue;
          if (has_same_samples(b, before, after)) continue;
          const Side side = side_of(before, b, isovalue);
          if (side == Side::kBoth || side != side_of(after, b, isovalue)) return false;
        }
      }
    }
    return true;
  }

  SurfaceCertificate between(std::uint32_t from, std::uint32_t to, double isovalue,
                             Progress& progress) override {
    if (from == to || is_same_surface(from, to, isovalue)) return {};
    SurfaceRequest request;
    request.isovalue = isovalue;
    request.strict = true;
    SurfaceExtractor<Sample> before(pages_of(from)), after(pages_of(to));
    const Contour surface = before.extract(request, progress).contour;
    return in_space(file_.header().grid, certify_surface(after, request, surface, progress));
  }

 private:
  using Word = OrderedWord<Sample>;
  struct StepOfFile {
    std::uint32_t step = 0;
    std::unique_ptr<SeriesPages<Word>> pages;
  };

  /// Whether the samples of a page's cells may lie on both sides of an isovalue.
  bool is_crossed(std::uint32_t step, LatticePoint block, double isovalue) {
    PageId id{0, block};
    // Cubes without a page of their own have the samples of coarser ones.
    while (!file_.grid().contains(id)) id = {id.lod + 1, {id.block.i / 2, id.block.j / 2, id.block.k / 2}};
    const std::optional<PageEntry> entry = file_.entry(step, id);
    if (!entry || id.lod > 0) return true;
    const auto value = [](std::uint32_t word) {
      return static_cast<double>(from_ordered<Sample>(static_cast<Word>(word)));
    };
    return entry->low <= entry->high && !(value(entry->high) < isovalue) && !(value(entry->low) >= isovalue);
  }

  /// Calls fn(page, last) for a page of the finest LOD and those after it that have samples of its cells,
  /// which are the samples up to `last` in each page. Returns false if one of the calls does.
  template <class Fn>
  bool for_page_and_behind(LatticePoint block, Fn fn) const {
    const PageGrid& grid = file_.grid();
    const LatticePoint blocks = grid.blocks(0);
    for (std::int32_t n = 0; n < 8; ++n) {
      const LatticePoint behind{n & 1, n >> 1 & 1, n >> 2}, near = block + behind;
      if (near.i >= blocks.i || near.j >= blocks.j || near.k >= blocks.k) continue;
      LatticePoint last = page_shape(grid, {0, near}).count - LatticePoint{1, 1, 1};
      for (int axis = 0; axis < 3; ++axis) last[axis] = behind[axis] == 1 ? 0 : last[axis];
      if (!fn(PageId{0, near}, last)) return false;
    }
    return true;
  }

  /// Whether a page and those after it have the same samples at two steps. If the directory does not say so,
  /// as between a step and a whole one, samples are read.
  bool has_same_samples(LatticePoint block, StoredPages<Word>& before, StoredPages<Word>& after) const {
    PageComparison<Word> comparison(before, after);
    return for_page_and_behind(block, [&](const PageId& id, LatticePoint) {
      if (comparison.has_same_samples(id)) return true;
      if (before.samples(id) == nullptr || after.samples(id) == nullptr) return false;
      return comparison.has_same_samples(id);
    });
  }

  /// The side of an isovalue on which the samples of a page's cells are. The directory has only rounded
  /// ranges of them. Samples that are no numbers, or cannot be read, count as on both sides.
  enum class Side : std::uint8_t { kBelow, kAbove, kBoth };
  Side side_of(StoredPages<Word>& pages, LatticePoint block, double isovalue) const {
    bool is_below = true, is_above = true;
    const bool is_one = for_page_and_behind(block, [&](const PageId& id, LatticePoint last) {
      const PageSamples<Word>* page = pages.samples(id);
      if (page == nullptr) return false;
      LatticePoint p{};
      for (p.k = 0; p.k <= last.k; ++p.k) {
        for (p.j = 0; p.j <= last.j; ++p.j) {
          for (p.i = 0; p.i <= last.i; ++p.i) {
            const auto value =
                static_cast<double>(from_ordered<Sample>(page->samples[PageGrid::place(p, 0)]));
            is_below = is_below && value < isovalue;
            is_above = is_above && value >= isovalue;
          }
        }
      }
      return is_below || is_above;
    });
    if (!is_one) return Side::kBoth;
    return is_below ? Side::kBelow : Side::kAbove;
  }

  /// The pages of a step. Those of the last two requested steps stay in memory.
  StoredPages<Word>& pages_of(std::uint32_t step) {
    const auto found = std::ranges::find_if(
        steps_, [&](const StepOfFile& known) { return known.pages != nullptr && known.step == step; });
    if (found == steps_.begin()) std::swap(steps_[0], steps_[1]);
    if (found == steps_.end()) {
      steps_[0] = std::move(steps_[1]);
      steps_[1] = {step, std::make_unique<SeriesPages<Word>>(file_, step, memory_ / 2)};
    }
    return *steps_[1].pages;
  }

  StoreFile& file_;
  std::size_t memory_;
  std::array<StepOfFile, 2> steps_;  ///< the last requested step is the second one
};

}  // namespace

std::unique_ptr<SurfaceMotion> SurfaceMotion::open(StoreFile& file, std::size_t memory) {
  return with_sample_type(file.header().grid.type, [&](auto sample) -> std::unique_ptr<SurfaceMotion> {
    return std::make_unique<SurfaceMotionOf<decltype(sample)>>(file, memory);
  });
}

}  // namespace adamas::timevarying
