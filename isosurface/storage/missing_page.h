#pragma once

#include <cstdint>
#include <vector>

#include "isosurface/volume/page.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// A page without which a frame was made, since it is not in memory, and its importance.
struct MissingPage {
  /// The missing part: the part of the directory that describes the page; its samples; its samples and
  /// bounds; or its directions of gradients, without which normals are provisional.
  enum class Part : std::uint8_t { kDirectory, kSamples, kAll, kGradients };

  PageId id;
  Part part = Part::kAll;
  /// The greatest error in the picture of diamonds that are not split because the page is missing, in classes
  /// of the frame; 0 if only normals need it.
  int view_class = 0;
  double depth = 0;        ///< the least depth of these diamonds
  std::uint32_t step = 0;  ///< the step of the store

  bool operator==(const MissingPage&) const = default;
};

/// Returns the parts of a page that must be in memory for that.
inline PageParts parts_of(const MissingPage& page) {
  return page.part == MissingPage::Part::kAll ? PageParts::kAll : PageParts::kSamples;
}

/// Sorts missing pages by importance: greater errors first, then nearer ones, then coarser LODs. Each part of
/// a page remains once. All pages are of one step.
void sort_by_importance(const PageGrid& grid, std::vector<MissingPage>& pages);

}  // namespace adamas::isosurface
