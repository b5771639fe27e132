#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/shared_pool.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/storage/missing_page.h"
#include "isosurface/storage/page_comparison.h"
#include "isosurface/view/crossed_page.h"
#include "isosurface/view/page_chunk.h"
#include "isosurface/view/page_view.h"
#include "isosurface/view/viewed_diamonds.h"

namespace adamas::isosurface {

/// The diamonds of a page in a walk of ViewedPages, and in a frame.
struct ViewedMasks {
  PageMask above;   ///< those of greater classes than the walk's least one
  PageMask at_low;  ///< those of the walk's least class
  PageMask split;
};

/// A page of an LOD that some frame has met with, and what is known of it for one contour.
struct ViewedPage {
  int lod = 0;
  LatticePoint block{};
  std::uint64_t order = 0;  ///< the place of its cube in z-order
  /// An error class that none of its diamonds exceeds; the greatest one where the directory does not tell.
  int greatest = 0;
  std::uint32_t step = 0;                ///< of the store: all that is known of the page is of this one
  bool is_told = false;                  ///< the directory was asked for that
  std::unique_ptr<CrossedPage> crossed;  ///< null where it is not known
  std::unique_ptr<ViewedMasks> masks;    ///< null where `crossed` is
  std::uint64_t used = 0;                ///< when that was last looked at
  std::uint64_t met = 0;                 ///< the walk that met with it last
  std::uint64_t looked_at = 0;           ///< the walk that looked at it last
  std::uint64_t suspect = 0;             ///< the walk in which pages with parents of its diamonds lack some
  /// How many groups the walk wants. Where it loads no pages: for how many all members are in memory; after
  /// how many pages had left the memory that was so.
  std::size_t groups_in_memory = 0, groups_wanted = 0;
  std::uint64_t left_then = 0;
  /// In that walk: where the children of its diamonds of the walk's classes are, as CrossedPage has them.
  ChildPages children = 0;
  /// In that walk: what its diamonds of the least class add and take away, by phase.
  std::array<std::uint32_t, 3> at_low{}, lost_at_low{};
  const PageMask* split = nullptr;  ///< in the present frame; null where nothing is
  std::uint64_t changed_in = 0;     ///< the walk after which `changed` was noted
  std::uint64_t changed = 0;     ///< the cells of the chunk in which not all is as in the last frame, as bits
  std::uint32_t chunk_step = 0;  ///< the step of the store that `chunk` is of
  /// No step: the chunk is to be made anew.
  static constexpr std::uint32_t kNoStep = ~std::uint32_t{0};
  std::unique_ptr<PageChunk> chunk;  ///< its triangles in the last frame; null where it had none
};

/// The pages that matter in a view, and what a cut splits on them. What does not depend on the view is kept
/// from frame to frame: which diamonds of a page the contour crosses, by their errors, and what they add. In
/// a page that is small for its distance all diamonds of one error mostly fall in one class, and are not
/// looked at one by one.
template <class Sample>
class ViewedPages {
 public:
  /// `memory`: bytes that what is known of crossed diamonds may take after a frame. The diamonds must outlive
  /// this.
  ViewedPages(ViewedDiamonds<Sample>& diamonds, const SurfaceRequest& surface, std::size_t memory);

  /// Forgets all pages, for another contour.
  void clear();
  /// Forgets how many triangles splits add, for another contour of which the same samples are above: the
  /// border of the data cuts other ones.
  void forget_counts() {
    for (ViewedPage& page : pages_) {
      if (page.crossed != nullptr) page.crossed->forget_counts();
    }
  }
  /// The pages of the step until now, where the diamonds have those of another one by now; null: none.
  void set_before(StoredPages<typename ViewedDiamonds<Sample>::Word>* pages) { before_ = pages; }
  /// Whether walks load pages. Otherwise diamonds are not split whose pages are not in memory, and what comes
  /// from splitting them neither.
  void set_loading(bool loads) { loads_ = loads; }
  /// The pages for want of which the last walk does not split diamonds in sight, in no order.
  [[nodiscard]] const std::vector<MissingPage>& missing() const { return missing_; }
  /// How many pages that it wants cannot be had at all.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// Has the memory of pages spare those that the last walk needs.
  void spare_needed();
  /// These pages, in no order, each as often as it is needed: what another frame much like the last one will
  /// need.
  [[nodiscard]] std::vector<MissingPage> needed();
  /// Called for each page that is looked at; may throw.
  using Check = std::function<void()>;

  /// Numbers of triangles: those that splits add, and those that splits of other diamonds, which the data's
  /// border cuts, take away.
  struct Sum {
    std::uint64_t added = 0, lost = 0;
    Sum& operator+=(const Sum& other) {
      added += other.added;
      lost += other.lost;
      return *this;
    }
    Sum& operator-=(const Sum& other) {
      added -= other.added;
      lost -= other.lost;
      return *this;
    }
  };
  /// The sums over the diamonds of classes from some class on.
  struct Added {
    Sum above;                        ///< those of greater classes than the least
    std::vector<Sum> of_generations;  ///< those of the least class, by generation
    [[nodiscard]] Sum all() const;
  };
  static constexpr std::uint64_t kAnyNumber = ~std::uint64_t{0};
  /// Walks over all pages on which diamonds may have at least a class, from the coarsest LOD on. Nothing
  /// where the diamonds of greater classes alone add more than `room`; triangles are not counted where that
  /// is kAnyNumber. Throws PageLost.
  std::optional<Added> walk(int least_class, std::uint64_t room, const Check& check);
  struct CutAndSum {
    SurfaceCut cut;
    Sum sum;  ///< over all that the cut splits
  };
  /// The cut in the least class of the last walk that ends where the diamonds' added triangles are more than
  /// there is room for. There must not be room for all.
  CutAndSum cut_within(int least_class, const Added& added, std::uint64_t room);
  /// Finds what a cut splits whose class is the least one of the last walk, for split() and shown(). Returns
  /// the greatest class of the diamonds in sight that are crossed and not split, as SplitPages does.
  int split(const SurfaceCut& cut, const Check& check);

  /// The pages on which something is split, from the coarsest LOD on, in z-order.
  [[nodiscard]] const std::vector<ViewedPage*>& shown() const { return shown_; }
  /// Null where no frame has met with the page.
  [[nodiscard]] ViewedPage* find(int lod, LatticePoint block);
  /// The page of a diamond, null as above, and the diamond's place on it.
  struct PageAndPlace {
    ViewedPage* page;
    LatticePoint place;
  };
  [[nodiscard]] PageAndPlace find(LatticePoint p);
  /// Null where nothing of the page is split in the present frame.
  [[nodiscard]] const PageMask* split_of(int lod, LatticePoint block) {
    const ViewedPage* const page = find(lod, block);
    return page == nullptr || page->met != walk_ ? nullptr : page->split;
  }
  /// How many diamonds and pages the last walk looked up in depths, and how many of them are hidden.
  [[nodiscard]] std::uint64_t depth_tests() const { return depth_tests_; }
  [[nodiscard]] std::uint64_t hidden() const { return hidden_; }
  /// A number for the last walk, greater than that of all before.
  [[nodiscard]] std::uint64_t walk_number() const { return walk_; }
  /// Forgets crossed diamonds of the pages that were not looked at for longest, until there is room. To be
  /// called between frames.
  void forget_old();
  /// Bytes that what is known of crossed diamonds takes.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  [[nodiscard]] int lods() const { return static_cast<int>(places_.size()); }
  [[nodiscard]] int generations() const { return 3 * lods(); }

 private:
  /// The greatest depths at which errors have at least a class, by error class.
  using Depths = std::vector<double>;
  [[nodiscard]] Depths depths_of(int view_class) const;

  ViewedPage& page(int lod, LatticePoint block);
  /// Forgets what is known of a page for another step, unless nothing has changed there.
  void renew(ViewedPage& page);
  /// Whether all samples and bounds that matter on a page are at the present step what they were when it was
  /// renewed last.
  [[nodiscard]] bool is_still(const ViewedPage& page);
  /// Sets candidates_ to the pages of an LOD on which diamonds may be split, since coarser ones may.
  void find_candidates(int lod);
  void add_candidate(int lod, LatticePoint block);
  /// Sets in_sight_ to those that may have diamonds of the walk's classes in sight.
  void find_in_sight(const Check& check);
  /// Reads, by several threads, what the walk will want of these and what is in memory.
  void read_ahead_of_walk();
  /// Calls work(begin, end, reader) for parts of so much work by several threads, which load no pages.
  template <class Work>
  void with_readers(std::size_t count, std::size_t grain, Work&& work);
  /// Counts the groups of one page before `groups`; false where there are few, or pages are not in memory.
  bool count_by_threads(ViewedPage& page, std::size_t groups);
  void read_from_memory(ViewedPage& page, const PageView& view, CrossedPageReader<Sample>& reader);
  /// Adds the diamonds of a page.
  void look_at(ViewedPage& page, const PageView& view, Added& added);
  /// Whether depths hide a diamond; counts.
  bool is_occluded(const PageView& view, std::uint16_t place, int phase);
  /// Finds the groups of a page that the walk looks at, and what splits in them add. Returns how many.
  std::size_t find_groups(ViewedPage& page, const PageView& view);
  void read(ViewedPage& page);
  /// How many groups of a page may have diamonds of the walk's classes.
  [[nodiscard]] std::size_t groups_within(const CrossedPage& known, int lod, double depth) const;
  /// Asks the directory, if that may be done.
  bool tell(ViewedPage& page);
  [[nodiscard, gnu::cold]] int greatest_of_parents(const ViewedPage& page);
  /// Finds what of a page is in memory, and notes what is missing. Returns false where nothing can be split.
  bool find_in_memory(ViewedPage& page, const PageView& view);
  [[nodiscard]] std::size_t groups_in_memory(const ViewedPage& page);
  /// Finds the pages that have members of the first groups of a page.
  void find_members(const ViewedPage& page, std::size_t groups);
  /// Calls visit(id) for pages round one, by bits as CrossedPage::members has them; until it returns false.
  template <class Visit>
  bool for_each_member_page(const ViewedPage& page, std::uint32_t members, Visit&& visit);
  /// Calls visit(id, part, class, depth) for the pages that the last walk needs.
  template <class Visit>
  void for_each_needed(Visit&& visit);
  [[gnu::cold]] void note_missing(const PageId& id, MissingPage::Part part, int view_class, double depth);
  [[gnu::cold]] void note_missing_groups(const ViewedPage& page, const PageView& view);
  /// Takes diamonds out of the masks of an LOD whose parents are not in those of their pages.
  void drop_without_parents(int lod, Added& added);
  [[gnu::cold]] bool drop_without_parents(ViewedPage& page, int phase, Added& added);
  [[nodiscard, gnu::cold]] bool has_parents(LatticePoint p);
  [[gnu::cold]] void suspect_round(const ViewedPage& page);
  [[gnu::cold]] void suspect_children(const ViewedPage& page);
  [[nodiscard]] PageView view_of(const ViewedPage& page) const {
    return {diamonds_.view(), places_[static_cast<std::size_t>(page.lod)], page.block};
  }
  void forget_crossed(ViewedPage& page) {
    bytes_ -= bytes_of(page);
    page.crossed.reset();
    page.masks.reset();
  }
  static void set_crossed(ViewedPage& page, CrossedPage crossed) {
    page.crossed = std::make_unique<CrossedPage>(std::move(crossed));
    page.masks = std::make_unique<ViewedMasks>();
  }
  static std::size_t bytes_of(const ViewedPage& page) { return page.crossed->bytes() + sizeof(ViewedMasks); }
  /// Ends a cut on a page, at the first diamond of the last generation for which there is no room.
  static void end_on(const ViewedPage& page, std::uint64_t room, CutAndSum& found);
  /// Sets the split diamonds of a page that was looked at.
  static void set_split(ViewedPage& page, int generation, const SurfaceCut& cut);
  /// The greatest class that is left on a page where not all is split.
  [[nodiscard]] int left_on(const ViewedPage& page, const PageView& view, int known) const;
  [[nodiscard]] int class_at(int error_class, double depth) const {
    return diamonds_.view_class(diamonds_.view().pixels_at(diamonds_.error(error_class), depth));
  }

  ViewedDiamonds<Sample>& diamonds_;
  const SurfaceRequest& surface_;
  CrossedPageReader<Sample> reader_;
  SharedPool<CrossedPageReader<Sample>> readers_;                         ///< for threads
  StoredPages<typename ViewedDiamonds<Sample>::Word>* before_ = nullptr;  ///< of the step before; null: none
  std::size_t memory_, bytes_ = 0;
  std::vector<LodPlaces> places_;  ///< by LOD
  std::deque<ViewedPage> pages_;
  std::vector<LatticeMap<ViewedPage*>> index_;  ///< by LOD and block
  std::uint64_t walk_ = 0, frame_ = 1;
  std::uint64_t depth_tests_ = 0, hidden_ = 0;
  Depths low_, next_;        ///< of the least class of the walk, and the next one
  int greatest_passed_ = 0;  ///< of the pages that the walk met with and did not look at
  bool loads_ = true;
  bool counts_ = true;  ///< in the last walk
  std::vector<MissingPage> missing_;
  std::uint64_t lost_ = 0;
  int greatest_missing_ = 0;                          ///< of the diamonds for whose split pages are missing
  std::vector<std::vector<ViewedPage*>> incomplete_;  ///< by LOD: those that lack diamonds
  std::vector<ViewedPage*> candidates_, shown_;
  struct InSight {
    ViewedPage* page;
    PageView view;
  };
  std::vector<InSight> in_sight_;
  std::vector<std::vector<ViewedPage*>> active_;  ///< by LOD, in z-order: those that the walk looked at
};

extern template class ViewedPages<std::uint8_t>;
extern template class ViewedPages<std::uint16_t>;
extern template class ViewedPages<std::int16_t>;
extern template class ViewedPages<float>;

}  // namespace adamas::isosurface
