#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "isosurface/gradients/gradient_smoothing.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// A function that receives one page. Only its `samples` are set: to the OctahedralCode of each point, the
/// first byte lowest.
using GradientPageSink = std::function<void(const PageId&, const Page<std::uint16_t>&)>;

/// Options that say how gradients are made into pages.
struct GradientPageOptions {
  /// The smoothing of gradients; none: they stay as least squares gives them.
  std::optional<GradientSmoothingOptions> smoothing = GradientSmoothingOptions{};
  /// The folder for directions, two bytes for each sample, if a plane takes more memory than `memory`. If it
  /// is empty, it is the system's folder for temporary files.
  std::filesystem::path scratch{};
  std::size_t memory = std::size_t{384}
                       << 20;  ///< bytes for smoothing; at least some rows of all planes are held
};

/// Gives every page of the volume's PageGrid once, with the directions of the gradients at its points, also
/// those of coarser LODs. On every LOD they are PlaneGradients of all samples (D 4.3.2), smoothed as
/// GradientSmoother smooths the whole volume, to the bit; components are limited to 1e36 for it. Points
/// beyond the data have the gradient of the nearest sample. The order of pages depends on the volume's
/// dimensions alone.
///
/// Planes are read in ascending order: once; for smoothing twice, or once more than there are strips of rows
/// that fit in the memory. In addition it needs 62 bytes and three samples for each sample of a plane of k.
/// Sample: uint8, uint16, int16 or float, as grid.type says. Throws Error for an invalid grid, Cancelled when
/// `progress` says so, and what `planes` and `sink` throw.
template <class Sample>
void gradient_pages(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageSink& sink,
                    const GradientPageOptions& options, Progress& progress = SilentProgress::instance());

/// A function that receives the directions of the gradients of one plane.
using CodePlaneSink = std::function<void(const std::vector<OctahedralCode>&)>;

/// Gives the directions of a volume's smoothed gradients, plane by plane in ascending order; see
/// gradient_pages(); the options have a smoothing. A first pass finds the scale of the gradients. If not all
/// rows fit in the memory, strips of them are smoothed with as many rows on either side as there are rounds,
/// which are all that they depend on.
template <class Sample>
void smoothed_codes(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageOptions& options,
                    const CodePlaneSink& sink, Progress& progress);

/// Cuts planes of codes, which are added in ascending order, into the pages of all LODs of a volume.
class CodePages {
 public:
  explicit CodePages(const VolumeGrid& grid);
  ~CodePages();
  CodePages(const CodePages&) = delete;
  CodePages& operator=(const CodePages&) = delete;

  /// Adds the codes of all samples of the next plane, and hands over the pages that are complete with it.
  void add(const std::vector<OctahedralCode>& codes, const GradientPageSink& sink);

 private:
  class LodCodes;

  PageGrid grid_;
  std::vector<LodCodes> lods_;
  std::unique_ptr<Page<std::uint16_t>> page_ = std::make_unique<Page<std::uint16_t>>();
  std::int32_t next_ = 0;  ///< the plane that is added next
};

}  // namespace adamas::isosurface
