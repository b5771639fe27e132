#pragma once

#include <cstdint>
#include <vector>

#include "isosurface/volume/page.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// A page that a frame does without, since it is not in memory, and its importance.
struct MissingPage {
  /// What is missing: the part of the directory that describes the page; its samples; its samples and bounds;
  /// or its directions of gradients, without which normals are provisional.
  enum class Part : std::uint8_t { kDirectory, kSamples, kAll, kGradients };

  PageId id;
  Part part = Part::kAll;
  /// The greatest error in the picture of what is not split for want of the page, in classes of the frame; 0
  /// where only normals need it.
  int view_class = 0;
  double depth = 0;        ///< the least depth of what is not split for want of the page
  std::uint32_t step = 0;  ///< the step of the store

  bool operator==(const MissingPage&) const = default;
};

/// The parts of a page that are to be in memory for that.
inline PageParts parts_of(const MissingPage& page) {
  return page.part == MissingPage::Part::kAll ? PageParts::kAll : PageParts::kSamples;
}

/// Puts missing pages in the order in which they are worth most: greater errors first, then what is nearer to
/// the eye, then coarser LODs. Each part of a page stays once. All are of one step.
void sort_by_importance(const PageGrid& grid, std::vector<MissingPage>& pages);

}  // namespace adamas::isosurface
