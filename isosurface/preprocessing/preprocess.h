#pragma once

#include <cstdint>
#include <functional>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// The bounds of diamonds of the finest LODs in noise (FinestErrors::least_noise). Either each diamond has
/// its own, or all have the same ones, which cover these: a surface through noise is refined nearly
/// everywhere in any case, and the diamonds' own bounds would take many times the bytes of all other stored
/// data besides the samples.
enum class NoiseBounds : std::uint8_t { kOwn, kSame };

/// A function that receives one page. It is called for one page at a time, in an order that depends on the
/// volume's dimensions alone.
template <class Sample>
using PageSink = std::function<void(const PageId&, const Page<OrderedWord<Sample>>&)>;

/// Computes the stored data of a volume (D 4.3): every page of its PageGrid once, with the samples, error
/// codes and ranges of the points that are the page's own; other places are undefined.
///
/// A diamond's error is at least that of each of its tetrahedra: the greatest difference between the samples
/// in and on it and the linear interpolation of its corners over the length of that interpolation's gradient,
/// or the tetrahedron's diameter if that is less; 0 where there is no difference; the greatest of the LOD
/// where a sample in or on it is not finite, since no interpolation approximates it. Its range covers the
/// finite samples in and on its tetrahedra. Both cover those of its child diamonds. Corners beyond the data
/// have the nearest sample's value. The corners of the lattice, which are the middle of no diamond, have
/// error 0 and low > high. Errors are codes of lod_error_scale().
///
/// Planes are read in ascending order, every 16th one twice. Memory does not grow with the number of planes,
/// except for 1/4096 of the samples. Sample: uint8, uint16, int16 or float, as grid.type says. Throws Error
/// for an invalid grid, Cancelled when `progress` says so, and what `planes` and `sink` throw.
template <class Sample>
void preprocess(const VolumeGrid& grid, const PlaneSource& planes, const PageSink<Sample>& sink,
                Progress& progress = SilentProgress::instance(), NoiseBounds noise = NoiseBounds::kSame);

}  // namespace adamas::isosurface
