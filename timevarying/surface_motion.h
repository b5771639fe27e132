#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "adamas/progress.h"
#include "isosurface/extraction/surface_certificate.h"
#include "isosurface/storage/store_file.h"

namespace adamas::timevarying {

/// How far the isosurface of all samples, which is that of linear interpolation in the finest tetrahedra,
/// moves between steps of a series: no point of either step's surface is farther from the other one than the
/// certified distance, and some point is as far as the distance found. Lengths are in space.
class SurfaceMotion {
 public:
  virtual ~SurfaceMotion() = default;

  /// Whether the surface is known to be the same at two steps: each page that it crosses at one of them, and
  /// the pages round it, have the same samples at both. The directory says so, or samples are compared.
  virtual bool is_same_surface(std::uint32_t from, std::uint32_t to, double isovalue) = 0;
  /// Measures the distance between the surfaces of two steps; infinite if only one of them has a surface.
  /// Throws Error if a page is damaged.
  virtual isosurface::SurfaceCertificate between(std::uint32_t from, std::uint32_t to, double isovalue,
                                                 Progress& progress = SilentProgress::instance()) = 0;

  /// `memory` is the number of bytes for decoded pages. The file must outlive this object.
  static std::unique_ptr<SurfaceMotion> open(isosurface::StoreFile& file, std::size_t memory);
};

}  // namespace adamas::timevarying
