#include "isosurface/preprocessing/preprocess.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/lattice/diamond_type.h"
#include "isosurface/preprocessing/lod_sweep.h"
#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/page_writer.h"
#include "isosurface/preprocessing/slab_errors.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// Lods finer than this one are held in part, in as many planes as are at work.
constexpr int kWholeLod = CoarseSamples<std::uint8_t>::kBits;
constexpr std::int32_t kSlab = 16;

template <class Sample>
class Preprocessing {
 public:
  using Word = OrderedWord<Sample>;

  Preprocessing(const VolumeGrid& volume, const PlaneSource& planes, const PageSink<Sample>& sink,
                Progress& progress, NoiseBounds noise)
      : grid_(volume.dimensions),
        last_(grid_.last()),
        planes_(planes),
        progress_(progress),
        samples_(volume.plane_samples()),
        words_(volume.plane_samples()),
        coarse_(last_),
        lods_(make_lods(grid_)),
        errors_(grid_, volume.spacing, coarse_, noise == NoiseBounds::kSame),
        sweep_(lods_, last_),
        writer_(grid_, lods_, coarse_, sink) {}

  void run() {
    read_coarse();
    for (std::int32_t slab = 0; slab < errors_.slabs(); ++slab) {
      progress_.step("preprocessing", static_cast<double>(slab) / errors_.slabs());
      read_slab(slab);
      if (grid_.depth() == 0) break;
      errors_.measure(slab, lods_);
      finish(slab);
    }
    writer_.write_coarsest();
    progress_.report("preprocessing", 1);
  }

 private:
  using Lods = std::vector<LodValues<Word>>;

  static Lods make_lods(const PageGrid& grid) {
    Lods lods;
    for (int lod = 0; lod < std::max(1, grid.depth()); ++lod) {
      LatticePoint size = grid.reach(lod) + LatticePoint{1, 1, 1};
      // Where an axis is but one sample the diamonds beside it stand between those on it.
      for (int axis = 0; axis < 3; ++axis) size[axis] = std::max(size[axis], 2);
      const bool is_whole = lod >= kWholeLod;
      // A slab; a row of pages that it does not finish; and that its last two planes are not final.
      const int planes = is_whole ? size.k : 18 + (kSlab >> lod);
      lods.emplace_back(size, planes, !is_whole);
    }
    return lods;
  }

  void read(std::int32_t k) {
    planes_(static_cast<std::uint64_t>(k), std::as_writable_bytes(std::span(samples_)));
    std::transform(samples_.begin(), samples_.end(), words_.begin(),
                   [](Sample s) { return static_cast<Word>(ordered(s)); });
  }

  void read_coarse() {
    if (grid_.depth() <= 3) return;
    for (std::int32_t n = 0; n < coarse_.planes(); ++n) {
      progress_.step("reading coarse samples", static_cast<double>(n) / coarse_.planes());
      read(coarse_.plane(n));
      coarse_.take(n, words_.data());
    }
  }

  /// The planes behind those of the slab before, up to the first of the slab behind.
  void read_slab(std::int32_t slab) {
    const std::int32_t first = slab == 0 ? 0 : kSlab * slab + 1, end = kSlab * (slab + 1);
    for (std::int32_t k = first; k <= end; ++k) {
      if (k <= last_.k) read(k);
      for (int lod = 0; lod < std::min(kWholeLod, static_cast<int>(lods_.size())); ++lod) {
        if ((k & ((1 << lod) - 1)) != 0 || k >> lod >= lods_[static_cast<std::size_t>(lod)].size().k)
          continue;
        lods_[static_cast<std::size_t>(lod)].open(k >> lod);
        // Beyond the data lie the samples of the last plane, which are still there.
        keep_samples(lod, k >> lod);
      }
    }
  }

  void keep_samples(int lod, std::int32_t z) {
    LodValues<Word>& values = lods_[static_cast<std::size_t>(lod)];
    const LatticePoint size = values.size();
    const std::size_t row = static_cast<std::size_t>(last_.i) + 1;
    for (std::int32_t j = 0; j < size.j; ++j) {
      const Word* from = words_.data() + row * static_cast<std::size_t>(std::min(j << lod, last_.j));
      Word* to = values.samples(j, z);
      for (std::int32_t i = 0; i < size.i; ++i) to[i] = from[std::min(i << lod, last_.i)];
    }
  }

  void finish(std::int32_t slab) {
    const bool is_last = slab + 1 == errors_.slabs();
    for (int lod = 0; lod < grid_.depth(); ++lod) {
      const std::int32_t all = lods_[static_cast<std::size_t>(lod)].size().k - 1;
      std::int32_t measured = all;
      if (!is_last) measured = lod < kWholeLod ? std::min(all, (kSlab * (slab + 1) >> lod) - 1) : -1;
      sweep_.advance(lod, measured);
      writer_.write(lod, sweep_.done(lod));
    }
  }

  PageGrid grid_;
  LatticePoint last_;
  const PlaneSource& planes_;
  Progress& progress_;
  std::vector<Sample> samples_;  ///< of the plane that was read
  std::vector<Word> words_;      ///< the same
  CoarseSamples<Word> coarse_;
  Lods lods_;
  SlabErrors<Sample> errors_;
  LodSweep<Word> sweep_;
  PageWriter<Sample> writer_;
};

}  // namespace

template <class Sample>
void preprocess(const VolumeGrid& grid, const PlaneSource& planes, const PageSink<Sample>& sink,
                Progress& progress, NoiseBounds noise) {
  grid.check("volume");
  ADAMAS_ASSERT(sample_bytes(grid.type) == sizeof(Sample));
  Preprocessing<Sample>(grid, planes, sink, progress, noise).run();
}

template void preprocess<std::uint8_t>(const VolumeGrid&, const PlaneSource&, const PageSink<std::uint8_t>&,
                                       Progress&, NoiseBounds);
template void preprocess<std::uint16_t>(const VolumeGrid&, const PlaneSource&, const PageSink<std::uint16_t>&,
                                        Progress&, NoiseBounds);
template void preprocess<std::int16_t>(const VolumeGrid&, const PlaneSource&, const PageSink<std::int16_t>&,
                                       Progress&, NoiseBounds);
template void preprocess<float>(const VolumeGrid&, const PlaneSource&, const PageSink<float>&, Progress&,
                                NoiseBounds);

}  // namespace adamas::isosurface
