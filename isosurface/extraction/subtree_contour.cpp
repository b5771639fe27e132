#include "isosurface/extraction/subtree_contour.h"

#include <algorithm>
#include <vector>

#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/hierarchy/indexed_hierarchy.h"

namespace adamas {

namespace {

/// The fine mesh, in a table. Where neighbours of different generations are bisected equally often they do
/// not meet: the table splits what else must be split.
template <class Sample>
class SubtreeMesh {
 public:
  SubtreeMesh(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages, int bisections)
      : diamonds_(diamonds),
        split_pages_(pages),
        bisections_(bisections),
        mesh_(diamonds.domain(), diamonds.lods()) {}

  [[nodiscard]] const IndexedHierarchy& mesh() const { return mesh_; }
  [[nodiscard]] double greatest_error() const { return diamonds_.error(greatest_class_); }

  void add_root(const Diamond& root) {
    const int error_class = split_pages_.class_if_allowed(root.point());
    greatest_class_ = std::max(greatest_class_, error_class);
    if (!has_subtree(root, error_class)) return;
    for (int slot = 0; slot < root.tetrahedron_count(); ++slot) refine(root, slot, bisections_);
  }

  /// Adds a diamond that is split, and bisects the tetrahedra of those of its children that are not.
  void add(const Diamond& diamond) {
    split(diamond);
    for (std::size_t c = 0; c < static_cast<std::size_t>(diamond.child_count()); ++c) {
      const Diamond child(diamond.child(static_cast<int>(c)));
      if (!split_pages_.is_in_data(child.point()) || split_pages_.is_split(child.point())) continue;
      // What cannot be had has no greater error than what it comes from.
      const int error_class = split_pages_.class_if_allowed(
          split_pages_.is_lost(child.point()) ? diamond.point() : child.point());
      greatest_class_ = std::max(greatest_class_, error_class);
      if (!has_subtree(child, error_class)) continue;
      for (const auto& half : diamond.type().child_tetrahedra[c]) {
        if (is_in_domain(child, half.child_slot)) refine(child, half.child_slot, bisections_);
      }
    }
  }

 private:
  /// Whether the diamond's tetrahedra stand for finer ones. Those of diamonds that are linear, not crossed or
  /// lost do not; of the finest diamonds nothing is known, so that theirs do.
  [[nodiscard]] bool has_subtree(const Diamond& diamond, int error_class) const {
    const bool has_bounds = 3 * diamonds_.lod(diamond.point()) >= bisections_;
    return !has_bounds || (error_class > 0 && !split_pages_.is_lost(diamond.point()));
  }
  [[nodiscard]] bool is_in_domain(const Diamond& diamond, int slot) const {
    const int next = slot + 1 == diamond.tetrahedron_count() ? 0 : slot + 1;
    return diamonds_.domain().contains(diamond.ring(slot)) && diamonds_.domain().contains(diamond.ring(next));
  }
  void split(const Diamond& diamond) {
    mesh_.split(diamond.point(), done_);
    done_.clear();
  }
  void refine(const Diamond& diamond, int slot, int bisections) {
    if (bisections == 0 || diamonds_.lod(diamond.point()) < 0) return;
    split(diamond);
    if (bisections == 1) return;
    for (const int end : {0, 1}) {
      const TetrahedronHalf& half = DiamondHalves::of(diamond.type_index(), slot, end);
      refine(Diamond(diamond.child(half.child)), half.slot, bisections - 1);
    }
  }

  StoredDiamonds<Sample>& diamonds_;
  SplitPages<Sample>& split_pages_;
  int bisections_;
  IndexedHierarchy mesh_;
  std::vector<LatticePoint> done_;
  int greatest_class_ = 0;
};

}  // namespace

template <class Sample>
ExtractedSurface contour_of_subtrees(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages,
                                     const SurfaceRequest& request, int bisections, Progress& progress) {
  SubtreeMesh<Sample> subtrees(diamonds, pages, bisections);
  ExtractedSurface surface;
  if (pages.count() == 0) {
    constexpr std::int32_t kMiddle = std::int32_t{1} << (kRootBits - 1);
    subtrees.add_root(Diamond({kMiddle, kMiddle, kMiddle}));
  }
  pages.for_each_page([&](int lod, const auto& page, double part) {
    progress.step("extracting", part);
    page.split->for_each(
        [&](LatticePoint q) { subtrees.add(Diamond(pages.in_lattice(lod, page.block, q))); });
  });
  surface.diamonds = pages.count();
  surface.max_error = subtrees.greatest_error();
  surface.tetrahedra = subtrees.mesh().tetrahedron_count();
  surface.contour = extract_contour(
      subtrees.mesh(), [&diamonds](LatticePoint p) { return diamonds.sample(p); }, request.isovalue,
      request.contour_options(diamonds.last_sample(), diamonds.spacing()));
  return surface;
}

template ExtractedSurface contour_of_subtrees<std::uint8_t>(StoredDiamonds<std::uint8_t>&,
                                                            SplitPages<std::uint8_t>&, const SurfaceRequest&,
                                                            int, Progress&);
template ExtractedSurface contour_of_subtrees<std::uint16_t>(StoredDiamonds<std::uint16_t>&,
                                                             SplitPages<std::uint16_t>&,
                                                             const SurfaceRequest&, int, Progress&);
template ExtractedSurface contour_of_subtrees<std::int16_t>(StoredDiamonds<std::int16_t>&,
                                                            SplitPages<std::int16_t>&, const SurfaceRequest&,
                                                            int, Progress&);
template ExtractedSurface contour_of_subtrees<float>(StoredDiamonds<float>&, SplitPages<float>&,
                                                     const SurfaceRequest&, int, Progress&);

}  // namespace adamas
