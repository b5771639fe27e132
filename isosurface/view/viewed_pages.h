#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/shared_pool.h"
#include "isosurface/extraction/crossed_page.h"
#include "isosurface/extraction/page_walk.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/storage/missing_page.h"
#include "isosurface/storage/page_comparison.h"
#include "isosurface/view/page_chunk.h"
#include "isosurface/view/page_view.h"
#include "isosurface/view/viewed_diamonds.h"

namespace adamas::isosurface {

/// The diamonds of a page in a walk of ViewedPages, and in a frame.
struct ViewedMasks {
  PageMask above;   ///< the diamonds of greater classes than the walk's least class
  PageMask at_low;  ///< the diamonds of the walk's least class
  PageMask split;   ///< the diamonds that are split in the frame
};

/// A page of an LOD that some frame has met, and what is known of it for one contour.
struct ViewedPage : WalkedPage {
  /// An error class that none of its diamonds exceeds; the greatest one where the directory does not tell.
  int greatest = 0;
  std::uint32_t step = 0;                ///< the step of the store to which all that is known belongs
  bool knows_greatest = false;           ///< whether `greatest` is from the directory
  std::unique_ptr<CrossedPage> crossed;  ///< null where it is not known
  std::unique_ptr<ViewedMasks> masks;    ///< null where `crossed` is null
  std::uint64_t used = 0;                ///< the frame that looked at `crossed` last
  std::uint64_t looked_at = 0;           ///< the walk that looked at it last
  std::uint64_t suspect = 0;             ///< the last walk in which parents of its diamonds may be missing
  /// `groups_wanted` is how many groups the walk wants. Where it loads no pages, all members of the first
  /// `groups_in_memory` are in memory; `left_then` pages had left the memory when this was found.
  std::size_t groups_in_memory = 0, groups_wanted = 0;
  std::uint64_t left_then = 0;
  /// How many triangles its diamonds of the least class add and remove, by phase, in the last walk.
  std::array<std::uint32_t, 3> at_low{}, lost_at_low{};
  std::uint64_t changed_in = 0;  ///< the walk after which `changed` was noted
  std::uint64_t changed = 0;     ///< the cells of the chunk that differ from the last frame, as bits
  std::uint32_t chunk_step = 0;  ///< the step of the store that `chunk` is of
  /// The value of chunk_step where the chunk must be made anew.
  static constexpr std::uint32_t kNoStep = ~std::uint32_t{0};
  std::unique_ptr<PageChunk> chunk;  ///< its triangles in the last frame; null where it had none
};

/// The pages that matter in a view, and the diamonds that a cut splits on them. What does not depend on the
/// view is kept from frame to frame: which diamonds of a page the contour crosses, by their errors, and how
/// many triangles their splits add. On a page that is small for its distance all diamonds of one error mostly
/// have one class in the view, and are not looked at one by one.
template <class Sample>
class ViewedPages {
 public:
  /// `memory`: how many bytes the crossed diamonds may take after a frame. The diamonds and the request must
  /// outlive this.
  ViewedPages(ViewedDiamonds<Sample>& diamonds, const SurfaceRequest& surface, std::size_t memory);

  /// Forgets all pages, for another contour.
  void clear();
  /// Forgets how many triangles splits add, for another contour that has the same samples above it: the
  /// border of the data may cut other triangles.
  void forget_counts() {
    for (ViewedPage& page : walk_.pages()) {
      if (page.crossed != nullptr) page.crossed->forget_counts();
    }
  }
  /// Sets the pages of the step before, where the diamonds have gone over to another step; null: none.
  void set_before(StoredPages<typename ViewedDiamonds<Sample>::Word>* pages) { before_ = pages; }
  /// Sets whether walks load pages. Otherwise diamonds whose pages are not in memory are not split, nor are
  /// their descendants.
  void set_loading(bool loads) { loads_ = loads; }
  /// The pages that the last walk lacked to split diamonds in sight, in no order.
  [[nodiscard]] const std::vector<MissingPage>& missing() const { return missing_; }
  /// How often the last walk lacked a page that is lost.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// Has the memory of pages spare those that the last walk needs.
  void spare_needed();
  /// The pages that the last walk needs, in no order, each as often as it is needed. Another frame much like
  /// the last one will need the same.
  [[nodiscard]] std::vector<MissingPage> needed();
  /// A function that walks call for each page that they look at; it may throw.
  using Check = std::function<void()>;

  /// Numbers of triangles: those that splits add, and those that splits of other diamonds remove, which the
  /// border of the data cuts.
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
    Sum above;                        ///< the sum over greater classes than the least
    std::vector<Sum> of_generations;  ///< the sums over the least class, by generation
    [[nodiscard]] Sum all() const;
  };
  static constexpr std::uint64_t kAnyNumber = ~std::uint64_t{0};
  /// Walks over all pages on which diamonds may have at least a class, from the coarsest LOD on. Returns
  /// nothing where the diamonds of greater classes alone add more triangles than `room`; with kAnyNumber
  /// triangles are not counted. Throws PageLost.
  std::optional<Added> walk(int least_class, std::uint64_t room, const Check& check);
  struct CutAndSum {
    SurfaceCut cut;
    Sum sum;  ///< the sum over all diamonds that the cut splits
  };
  /// The cut in the least class of the last walk that ends where the diamonds' added triangles are more than
  /// there is room for. There must not be room for all.
  CutAndSum cut_within(int least_class, const Added& added, std::uint64_t room);
  /// Finds the diamonds that a cut splits, whose class must be the least one of the last walk. Returns the
  /// greatest class of the diamonds in sight that are crossed and not split, as SplitPages does.
  int split(const SurfaceCut& cut, const Check& check);

  /// The pages on which something is split, from the coarsest LOD on, in z-order.
  [[nodiscard]] const std::vector<ViewedPage*>& shown() const { return shown_; }
  /// The page of an LOD at a block; null where no frame has met it.
  [[nodiscard]] ViewedPage* find(int lod, LatticePoint block) const { return walk_.find(lod, block); }
  /// The page of a diamond, or null, and the diamond's place on it.
  struct PageAndPlace {
    ViewedPage* page;
    LatticePoint place;
  };
  [[nodiscard]] PageAndPlace find(LatticePoint p);
  /// The diamonds of a page that are split in the present frame; null where there are none.
  [[nodiscard]] const PageMask* split_of(int lod, LatticePoint block) const {
    return walk_.split_of(lod, block);
  }
  /// How many diamonds and pages the last walk looked up in depths, and how many of them are hidden.
  [[nodiscard]] std::uint64_t depth_tests() const { return depth_tests_; }
  [[nodiscard]] std::uint64_t hidden() const { return hidden_; }
  /// A number for the last walk, greater than that of all before.
  [[nodiscard]] std::uint64_t walk_number() const { return walk_.number(); }
  /// Forgets the crossed diamonds of the pages that were not looked at for the longest time, until their
  /// memory is within the limit. Must be called between frames.
  void forget_old();
  /// How many bytes the crossed diamonds take.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  [[nodiscard]] int lods() const { return walk_.lods(); }
  [[nodiscard]] int generations() const { return 3 * lods(); }

 private:
  /// The greatest depths at which errors have at least a class, by error class.
  using Depths = std::vector<double>;
  [[nodiscard]] Depths depths_of(int view_class) const;

  /// Brings a page to the present step: forgets what is known of it, unless it is the same at both steps.
  void renew(ViewedPage& page);
  /// Whether all samples and bounds that matter on a page are the same at the present step and at the page's.
  [[nodiscard]] bool is_unchanged(const ViewedPage& page);
  /// Sets in_sight_ to the pages of an LOD that may have diamonds of the walk's classes in sight.
  void find_in_sight(int lod, const Check& check);
  /// Reads, by several threads, the pages of in_sight_ whose data are in memory.
  void read_ahead_of_walk();
  /// Calls work(begin, end, reader) for parts of [0, count) by several threads, which load no pages.
  template <class Work>
  void with_readers(std::size_t count, std::size_t grain, Work&& work);
  /// Counts the groups of one page before `groups`. Returns false where there are few, or pages are not in
  /// memory.
  bool count_by_threads(ViewedPage& page, std::size_t groups);
  void read_from_memory(ViewedPage& page, const PageView& view, CrossedPageReader<Sample>& reader);
  /// Finds the diamonds of the walk's classes on a page, and adds what their splits add.
  void look_at(ViewedPage& page, const PageView& view, Added& added);
  /// Tells whether depths hide a diamond, and counts the test.
  bool is_occluded(const PageView& view, std::uint16_t place, int phase);
  /// Finds the groups of a page that the walk looks at, and what splits in them add. Returns how many.
  std::size_t find_groups(ViewedPage& page, const PageView& view);
  void read(ViewedPage& page);
  /// How many groups of a page may have diamonds of the walk's classes.
  [[nodiscard]] std::size_t groups_within(const CrossedPage& known, int lod, double depth) const;
  /// Sets `greatest` of a page by the directory. Returns false where that cannot be read now.
  bool find_greatest(ViewedPage& page);
  [[nodiscard, gnu::cold]] int greatest_of_parents(const ViewedPage& page);
  /// Finds what of a page is in memory, and notes what is missing. Returns false where nothing can be split.
  bool find_in_memory(ViewedPage& page, const PageView& view);
  [[nodiscard]] std::size_t groups_in_memory(const ViewedPage& page);
  /// Finds the pages that have members of the first groups of a page.
  void find_members(const ViewedPage& page, std::size_t groups);
  /// Calls visit(id) for the pages of a set as in CrossedPage::members, until visit returns false.
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
  [[nodiscard]] int greatest_left_on(const ViewedPage& page, const PageView& view, int known) const;
  [[nodiscard]] int class_at(int error_class, double depth) const {
    return diamonds_.view_class(diamonds_.view().pixels_at(diamonds_.error(error_class), depth));
  }

  ViewedDiamonds<Sample>& diamonds_;
  const SurfaceRequest& surface_;
  CrossedPageReader<Sample> reader_;
  SharedPool<CrossedPageReader<Sample>> readers_;                         ///< readers for threads
  StoredPages<typename ViewedDiamonds<Sample>::Word>* before_ = nullptr;  ///< see set_before()
  std::size_t memory_, bytes_ = 0;
  std::vector<LodPlaces> places_;  ///< by LOD
  /// The active pages of this walk are those that it looked at.
  PageWalk<ViewedPage> walk_;
  std::uint64_t frame_ = 1;
  std::uint64_t depth_tests_ = 0, hidden_ = 0;
  Depths low_, next_;        ///< the depths of the least class of the walk, and of the next one
  int greatest_passed_ = 0;  ///< the greatest class of pages that the walk met and did not look at
  bool loads_ = true;
  bool counts_ = true;  ///< whether the last walk counts triangles
  std::vector<MissingPage> missing_;
  std::uint64_t lost_ = 0;
  int greatest_missing_ = 0;                          ///< the greatest class that lacks pages to be split
  std::vector<std::vector<ViewedPage*>> incomplete_;  ///< by LOD: the pages that lack diamonds
  std::vector<ViewedPage*> shown_;
  struct InSight {
    ViewedPage* page;
    PageView view;
  };
  std::vector<InSight> in_sight_;
};

}  // namespace adamas::isosurface
