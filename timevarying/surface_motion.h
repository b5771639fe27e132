#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "adamas/progress.h"
#include "isosurface/extraction/surface_certificate.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// How far the isosurface of all samples, which is that of linear interpolation in the finest tetrahedra,
/// moves between steps of a series: no point of either step's surface is farther from the other's than is
/// certified, and some point is as far as was found. Lengths are in space.
class SurfaceMotion {
 public:
  virtual ~SurfaceMotion() = default;

  /// Whether the surface is known to be the same at two steps, by the directory, and by samples where that
  /// does not tell: each page that it crosses at one of them has the samples that it has at the other, and so
  /// have those round it.
  virtual bool is_still(std::uint32_t from, std::uint32_t to, double isovalue) = 0;
  /// Infinite where there is a surface at one of the steps alone. Throws Error where a page is damaged.
  virtual isosurface::SurfaceCertificate between(std::uint32_t from, std::uint32_t to, double isovalue,
                                                 Progress& progress = SilentProgress::instance()) = 0;

  /// `memory`: bytes that decoded pages may take. The file must outlive this.
  static std::unique_ptr<SurfaceMotion> open(isosurface::StoreFile& file, std::size_t memory);
};

}  // namespace adamas::timevarying
