#include "isosurface/preprocessing/preprocess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/lattice/diamond_type.h"
#include "isosurface/preprocessing/coarse_errors.h"
#include "isosurface/preprocessing/cube_samples.h"
#include "isosurface/preprocessing/error_code.h"
#include "isosurface/preprocessing/finest_errors.h"
#include "isosurface/preprocessing/lod_values.h"
#include "isosurface/preprocessing/octant_errors.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// Own errors of all diamonds, slab by slab of 16 cells along k.
template <class Sample>
class SlabErrors {
 public:
  using Word = OrderedWord<Sample>;
  using Lods = std::vector<LodValues<Word>>;

  /// Makes the object. `looks_for_noise`: whether diamonds in noise get the same bounds.
  SlabErrors(const PageGrid& grid, const Vec3& spacing, const CoarseSamples<Word>& coarse,
             bool looks_for_noise)
      : depth_(grid.depth()),
        looks_for_noise_(looks_for_noise),
        last_(grid.last()),
        finest_(depth_, last_, spacing),
        stencils_(depth_, spacing),
        small_(stencils_, spacing),
        large_(depth_, last_, spacing, coarse) {
    // Cubes that touch the data only with a side count: they have tetrahedra of diamonds on that side.
    const std::int32_t cubes = std::max(1, (std::int32_t{1} << depth_) >> 4);
    for (int axis = 0; axis < 3; ++axis) cubes_[axis] = std::min(last_[axis] / 16 + 1, cubes);
  }

  [[nodiscard]] std::int32_t slabs() const { return cubes_.k; }

  /// Raises own codes by the errors of slab `k`; its samples are in lods.front(), up to the plane 16 k + 16.
  void measure(std::int32_t k, Lods& lods) {
    measure_finest(k, lods.front());
    // Cubes that are processed at the same time have no point in common.
    for (const LatticePoint first : {LatticePoint{0, 0, k}, {1, 0, k}, {0, 1, k}, {1, 1, k}}) {
      const auto columns = static_cast<std::size_t>((cubes_.i - first.i + 1) / 2);
      const auto rows = static_cast<std::size_t>((cubes_.j - first.j + 1) / 2);
      parallel_chunks(columns * rows, 4, [&](std::size_t begin, std::size_t end) {
        const auto work = std::make_unique_for_overwrite<Work>();
        for (std::size_t n = begin; n < end; ++n) {
          const auto i = static_cast<std::int32_t>(n % columns), j = static_cast<std::int32_t>(n / columns);
          measure_cube({16 * (first.i + 2 * i), 16 * (first.j + 2 * j), 16 * k}, lods, *work);
        }
      });
    }
  }

 private:
  struct Work {
    CubeSamples<Sample> samples;
    typename OctantErrors<Sample>::Codes codes;
  };

  /// Measures the diamonds of scale 1 in the planes of the slab, in the last slab up to the end.
  void measure_finest(std::int32_t slab, LodValues<Word>& lod) {
    const auto blocks = [](std::int32_t size) { return static_cast<std::size_t>((size + 15) / 16); };
    const std::size_t columns = blocks(lod.size().i), rows = blocks(lod.size().j);
    const std::int32_t end = slab + 1 == slabs() ? lod.size().k : 16 * (slab + 1);
    const auto [low, high] = range_of(lod, 16 * slab);
    const double least_noise = looks_for_noise_ ? FinestErrors<Sample>::least_noise(low, high)
                                                : std::numeric_limits<double>::infinity();
    for (std::int32_t first = 16 * slab; first < end; first += 16) {
      std::vector<std::uint8_t> noise(columns * rows);
      const auto base = [columns, first](std::size_t n) {
        return LatticePoint{16 * static_cast<std::int32_t>(n % columns),
                            16 * static_cast<std::int32_t>(n / columns), first};
      };
      parallel_chunks(columns * rows, 4, [&](std::size_t begin, std::size_t chunk_end) {
        const auto work = std::make_unique_for_overwrite<typename FinestErrors<Sample>::Work>();
        for (std::size_t n = begin; n < chunk_end; ++n)
          noise[n] = finest_.measure(lod, base(n), least_noise, *work) ? 1 : 0;
      });
      if (std::find(noise.begin(), noise.end(), 1) != noise.end()) {
        // With one range for all noise up to here, diamonds between two blocks have it too.
        noise_low_ = std::min(noise_low_, low);
        noise_high_ = std::max(noise_high_, high);
        for (std::size_t n = 0; n < noise.size(); ++n) {
          if (noise[n] != 0) finest_.set_noise(lod, base(n), noise_low_, noise_high_);
        }
      }
      if (first == 16 * slab) noise_ = std::move(noise);
    }
    columns_ = columns;
  }

  /// Returns whether a block of the present slab is noise.
  [[nodiscard]] bool is_noise(LatticePoint base) const {
    return noise_[static_cast<std::size_t>(base.i >> 4) + columns_ * static_cast<std::size_t>(base.j >> 4)] !=
           0;
  }

  /// Returns the range of the finite samples in the planes from `first` to `first` + 15 and in those next to
  /// them.
  std::pair<Word, Word> range_of(const LodValues<Word>& lod, std::int32_t first) const {
    Word low = LodValues<Word>::kGreatest, high = 0;
    for (std::int32_t k = std::max(first - 1, 0); k <= std::min(first + 16, last_.k); ++k) {
      for (std::int32_t j = 0; j <= last_.j; ++j) {
        const Word* row = lod.samples(j, k);
        for (std::int32_t i = 0; i <= last_.i; ++i) {
          if (!is_finite_word(row[i])) continue;
          low = std::min(low, row[i]);
          high = std::max(high, row[i]);
        }
      }
    }
    return {low, high};
  }

  void measure_cube(LatticePoint base, Lods& lods, Work& work) const {
    work.samples.load(lods.front(), last_, base);
    if (depth_ > OctantStencils::kLeastBits && !work.samples.is_constant()) {
      if (is_noise(base)) {
        work.codes.fill(ErrorScale::kCodes - 1);
      } else {
        small_.measure(work.samples, work.codes);
      }
      for (int lod = OctantStencils::kLeastBits; lod < std::min(depth_, 3); ++lod)
        raise(lods[static_cast<std::size_t>(lod)], lod, base, work.codes.data());
    }
    if (depth_ > 3) large_.measure(work.samples, lods);
  }

  static void raise(LodValues<Word>& values, int lod, LatticePoint base, const std::uint8_t* codes) {
    constexpr std::int32_t kCube = OctantStencils::kCube;
    const LatticePoint size = values.size(), first{base.i >> lod, base.j >> lod, base.k >> lod};
    const std::int32_t side = 16 >> lod;
    for (std::int32_t k = 0; k <= std::min(side, size.k - 1 - first.k); ++k) {
      for (std::int32_t j = 0; j <= std::min(side, size.j - 1 - first.j); ++j) {
        std::uint8_t* row = values.codes(first.j + j, first.k + k) + first.i;
        const std::uint8_t* from = codes + kCube * ((j << lod) + kCube * (k << lod));
        const std::int32_t end = std::min(side, size.i - 1 - first.i);
        for (std::int32_t i = 0; i <= end; ++i) row[i] = std::max(row[i], from[i << lod]);
      }
    }
  }

  int depth_;
  bool looks_for_noise_;
  LatticePoint last_, cubes_{};
  FinestErrors<Sample> finest_;
  std::vector<std::uint8_t> noise_;  ///< whether each of the slab's blocks is noise, i running fastest
  std::size_t columns_ = 0;          ///< number of blocks along i
  /// The range of samples in noise, in the slabs so far.
  Word noise_low_ = LodValues<Word>::kGreatest, noise_high_ = 0;
  OctantStencils stencils_;
  OctantErrors<Sample> small_;
  CoarseErrors<Sample> large_;
};

/// Least and greatest sample in and on the tetrahedra of the smallest diamonds, those of phase 2 and scale 1:
/// the ends of the split edge and the nine points of the square across its middle. All other diamonds are
/// covered by such diamonds.
template <class Word>
class LeafRanges {
 public:
  /// Makes the object. `values` are those of the finest LOD, `last` is the last sample.
  LeafRanges(LodValues<Word>& values, LatticePoint last)
      : values_(values), last_(last), is_flat_(last.i == 0 || last.j == 0 || last.k == 0) {}

  /// Finds the ranges of row (j, z), which needs the samples of the planes next to it.
  void find(std::int32_t j, std::int32_t z) const {
    if (j % 2 == 1 && z % 2 == 1) return;
    const std::int32_t first = (j + z) % 2 == 0 ? 1 : 0;
    // Near the border, points beyond the data repeat the data next to them, which are among the nine points
    // too. This is not so if a whole axis is a single sample.
    if (is_flat_) {
      for (std::int32_t i = first; i < values_.size().i; i += 2) find_flat({i, j, z});
    } else {
      find_row(j, z, first);
    }
  }

 private:
  void find_row(std::int32_t j, std::int32_t z, std::int32_t first) const {
    const int axis = first == 1 ? 0 : j % 2 == 1 ? 1 : 2;
    for (std::int32_t dz = -1; dz <= 1; ++dz) {
      for (std::int32_t dj = -1; dj <= 1; ++dj) {
        const bool is_across = axis == 0 || (axis == 1 ? dj == 0 : dz == 0);
        const bool is_along = axis == 1 ? dz == 0 : axis == 2 && dj == 0;
        if (!is_across && !is_along) continue;
        const Word* row = values_.samples(std::clamp(j + dj, 0, last_.j), std::clamp(z + dz, 0, last_.k));
        // These are three samples of the row, or the one at i.
        const bool is_middle = axis == 0 ? dj == 0 && dz == 0 : is_across;
        if (is_middle) {
          widen<3>(row, j, z, first);
        } else {
          widen<1>(row, j, z, first);
        }
      }
    }
  }

  /// Takes Width samples round each point from a row.
  template <int Width>
  void widen(const Word* row, std::int32_t j, std::int32_t z, std::int32_t first) const {
    Word *low = values_.low(j, z), *high = values_.high(j, z);
    for (std::int32_t i = first; i <= last_.i; i += 2) {
      Word least = row[i], greatest = row[i];
      if constexpr (sizeof(Word) == 4) {
        if (!is_finite_word(row[i])) least = LodValues<Word>::kGreatest, greatest = 0;
      }
      if constexpr (Width == 3) {
        for (const std::int32_t at : {std::max(i - 1, 0), std::min(i + 1, last_.i)}) {
          if (!is_finite_word(row[at])) continue;
          least = std::min(least, row[at]);
          greatest = std::max(greatest, row[at]);
        }
      }
      low[i] = std::min(low[i], least);
      high[i] = std::max(high[i], greatest);
    }
  }

  void find_flat(LatticePoint p) const {
    Word &low = values_.low(p.j, p.k)[p.i], &high = values_.high(p.j, p.k)[p.i];
    for (int n = 0; n < 27; ++n) {
      const LatticePoint d = step_around(n);
      const LatticePoint q = p + d;
      int along = 0, across = 0;
      for (int axis = 0; axis < 3; ++axis) ((p[axis] & 1) != 0 ? along : across) += std::abs(d[axis]);
      if (along != 0 && across != 0) continue;
      if (std::min({q.i, q.j, q.k}) < 0 || q.i > last_.i || q.j > last_.j || q.k > last_.k) continue;
      const Word sample = values_.samples(q.j, q.k)[q.i];
      if (!is_finite_word(sample)) continue;
      low = std::min(low, sample);
      high = std::max(high, sample);
    }
  }

  LodValues<Word>& values_;
  LatticePoint last_;
  bool is_flat_;
};

/// Makes errors and ranges monotone, from the finest LOD up, plane by plane: a diamond includes the bounds of
/// its children. With a point's coordinates in units of its LOD the children are its two neighbours along
/// each odd axis, except in phase 2, which has one odd coordinate: there they are the eight points of the
/// next finer LOD round it.
template <class Word>
class LodSweep {
 public:
  /// Makes the object. `last` is the last sample of the volume.
  LodSweep(std::vector<LodValues<Word>>& lods, LatticePoint last)
      : lods_(lods), last_(last), next_(lods.size(), 0) {}

  /// Processes as many planes as possible, in this LOD alone. All tetrahedra that touch the diamonds in
  /// planes of the LOD up to `measured` must have been measured. It is called from the finest LOD up.
  void advance(int lod, std::int32_t measured) {
    std::int32_t complete = measured;
    if (lod > 0 && done(lod - 1) < lods_[index(lod - 1)].size().k - 1)
      complete = std::min(complete, (done(lod - 1) - 1) >> 1);
    for (; next_[index(lod)] <= complete; ++next_[index(lod)]) {
      const std::int32_t z = next_[index(lod)];
      if (lod == 0) find_leaf_ranges(z);
      const bool is_end = z + 1 == lods_[index(lod)].size().k;
      if (z % 2 == 0) {
        sweep_plane(lod, z);
        if (z > 0) finish_odd_plane(lod, z - 1);
      } else if (is_end) {
        finish_odd_plane(lod, z);
      }
    }
  }

  /// Returns the last plane whose points, and those of all planes before it, have their final values.
  [[nodiscard]] std::int32_t done(int lod) const {
    const std::int32_t next = next_[index(lod)];
    // An odd plane still needs the one behind it.
    return next % 2 == 1 || next == lods_[index(lod)].size().k ? next - 1 : next - 2;
  }

 private:
  using Values = LodValues<Word>;
  static std::size_t index(int lod) { return static_cast<std::size_t>(lod); }
  static constexpr std::size_t kGrain = 16;

  void find_leaf_ranges(std::int32_t z) {
    Values& values = lods_.front();
    const LeafRanges<Word> ranges(values, last_);
    parallel_for(static_cast<std::size_t>(values.size().j), kGrain,
                 [&](std::size_t j) { ranges.find(static_cast<std::int32_t>(j), z); });
  }

  void finish_odd_plane(int lod, std::int32_t z) {
    sweep_plane(lod, z);
    if (index(lod) + 1 == lods_.size()) return;
    Values& parents = lods_[index(lod) + 1];
    for (const std::int32_t parent : {(z - 1) / 2, (z + 1) / 2}) {
      if (parent >= parents.size().k) continue;
      parallel_for(static_cast<std::size_t>(parents.size().j), kGrain, [&](std::size_t j) {
        pull(lods_[index(lod)], parents, static_cast<std::int32_t>(j), parent, z);
      });
    }
  }

  /// Processes phase 1, and in odd planes phase 0 after it.
  void sweep_plane(int lod, std::int32_t z) {
    Values& values = lods_[index(lod)];
    for (const int odd_axes : {2, 3}) {
      parallel_for(static_cast<std::size_t>(values.size().j), kGrain, [&](std::size_t row) {
        const auto j = static_cast<std::int32_t>(row);
        const std::int32_t odd_i = odd_axes - j % 2 - z % 2;
        if (odd_i == 0 || odd_i == 1) take_neighbours(values, j, z, odd_i);
      });
    }
  }

  /// Makes the points of the row whose first coordinate has this parity include the bounds of their children.
  static void take_neighbours(Values& values, std::int32_t j, std::int32_t z, std::int32_t odd_i) {
    const LatticePoint size = values.size();
    if (odd_i == 1) {
      take(values, j, z, 1, j, z, -1, size.i);
      take(values, j, z, 1, j, z, 1, size.i - 1);
    }
    if (j % 2 == 1) {
      take(values, j, z, odd_i, j - 1, z, 0, size.i);
      if (j + 1 < size.j) take(values, j, z, odd_i, j + 1, z, 0, size.i);
    }
    if (z % 2 == 1) {
      take(values, j, z, odd_i, j, z - 1, 0, size.i);
      if (z + 1 < size.k) take(values, j, z, odd_i, j, z + 1, 0, size.i);
    }
  }

  /// Includes the bounds of the points `shift` along another row.
  static void take(Values& values, std::int32_t j, std::int32_t z, std::int32_t first, std::int32_t from_j,
                   std::int32_t from_z, std::int32_t shift, std::int32_t end) {
    std::uint8_t* to = values.codes(j, z);
    const std::uint8_t* from = values.codes(from_j, from_z);
    for (std::int32_t i = first; i < end; i += 2) to[i] = std::max(to[i], from[i + shift]);
    Word *low = values.low(j, z), *high = values.high(j, z);
    const Word *from_low = values.low(from_j, from_z), *from_high = values.high(from_j, from_z);
    for (std::int32_t i = first; i < end; i += 2) {
      low[i] = std::min(low[i], from_low[i + shift]);
      high[i] = std::max(high[i], from_high[i + shift]);
    }
  }

  /// Makes the points of phase 2 in row (j, z) of the coarser LOD include the bounds in the plane `fine_z` of
  /// the finer one.
  static void pull(Values& fine, Values& coarse, std::int32_t j, std::int32_t z, std::int32_t fine_z) {
    if (j % 2 == 1 && z % 2 == 1) return;
    const std::int32_t first = (j + z) % 2 == 0 ? 1 : 0;
    for (const std::int32_t fine_j : {2 * j - 1, 2 * j + 1}) {
      if (fine_j < 0 || fine_j >= fine.size().j) continue;
      for (const std::int32_t shift : {-1, 1})
        pull_row(fine, coarse, j, z, fine_j, fine_z, first == 0 && shift < 0 ? 2 : first, shift);
    }
  }

  static void pull_row(Values& fine, Values& coarse, std::int32_t j, std::int32_t z, std::int32_t fine_j,
                       std::int32_t fine_z, std::int32_t first, std::int32_t shift) {
    const std::int32_t end = std::min(coarse.size().i, (fine.size().i - 1 - shift) / 2 + 1);
    std::uint8_t* to = coarse.codes(j, z);
    const std::uint8_t* from = fine.codes(fine_j, fine_z);
    for (std::int32_t i = first; i < end; i += 2)
      to[i] = std::max(to[i], coarser_code(from[2 * i + shift], 1));
    Word *low = coarse.low(j, z), *high = coarse.high(j, z);
    const Word *from_low = fine.low(fine_j, fine_z), *from_high = fine.high(fine_j, fine_z);
    for (std::int32_t i = first; i < end; i += 2) {
      low[i] = std::min(low[i], from_low[2 * i + shift]);
      high[i] = std::max(high[i], from_high[2 * i + shift]);
    }
  }

  std::vector<Values>& lods_;
  LatticePoint last_;
  std::vector<std::int32_t> next_;
};

/// Makes pages of the LODs' values, as soon as these are final.
template <class Sample>
class PageWriter {
 public:
  using Word = OrderedWord<Sample>;
  using Lods = std::vector<LodValues<Word>>;

  PageWriter(const PageGrid& grid, Lods& lods, const CoarseSamples<Word>& coarse,
             const PageSink<Sample>& sink)
      : grid_(grid),
        lods_(lods),
        coarse_(coarse),
        sink_(sink),
        next_(lods.size(), 0),
        page_(std::make_unique<Page<Word>>()) {}

  /// Hands over the pages of an LOD whose planes are all among those up to `done`; not the coarsest page.
  void write(int lod, std::int32_t done) {
    if (lod >= grid_.top()) return;
    const LatticePoint blocks = grid_.blocks(lod);
    const std::int32_t last = grid_.extent(lod).k;
    std::int32_t& k = next_[static_cast<std::size_t>(lod)];
    for (; k < blocks.k && std::min(PageGrid::kSide * k + PageGrid::kSide - 1, last) <= done; ++k) {
      for (std::int32_t j = 0; j < blocks.j; ++j) {
        for (std::int32_t i = 0; i < blocks.i; ++i) {
          const PageId id{lod, {i, j, k}};
          if (grid_.contains(id)) write(id);
        }
      }
    }
  }

  /// Hands over the coarsest page, for which all values must be final.
  void write_coarsest() { write(PageId{grid_.top(), {0, 0, 0}}); }

 private:
  void write(const PageId& id) {
    const LatticePoint count = grid_.count(id);
    for (std::int32_t k = 0; k < count.k; ++k) {
      for (std::int32_t j = 0; j < count.j; ++j) {
        fill_samples(id, j, k, count.i);
        if (grid_.is_complete(id)) {
          for (std::int32_t i = 0; i < count.i; ++i) fill_point({i, j, k}, id.lod);
        } else {
          fill_bounds(id, j, k, count.i);
        }
      }
    }
    sink_(id, *page_);
  }

  static std::size_t place(LatticePoint q) { return PageGrid::place(q, 0); }

  void fill_samples(const PageId& id, std::int32_t j, std::int32_t k, std::int32_t count) {
    const LatticePoint p = PageGrid::kSide * id.block + LatticePoint{0, j, k};
    Word* to = page_->samples.data() + place({0, j, k});
    if (id.lod < CoarseSamples<Word>::kBits) {
      const LodValues<Word>& values = lods_[static_cast<std::size_t>(id.lod)];
      // Only the coarsest page extends farther than its LOD; beyond it the last values are repeated.
      const LatticePoint end = values.size() - LatticePoint{1, 1, 1};
      const Word* from = values.samples(std::min(p.j, end.j), std::min(p.k, end.k));
      const std::int32_t there = std::min(count, end.i + 1 - p.i);
      std::copy_n(from + p.i, there, to);
      std::fill(to + there, to + count, from[end.i]);
    } else {
      for (std::int32_t i = 0; i < count; ++i)
        to[i] = coarse_.at((std::int32_t{1} << id.lod) * (p + LatticePoint{i, 0, 0}));
    }
  }

  /// Fills the bounds of the points that the LOD adds, and undefined values at the others.
  void fill_bounds(const PageId& id, std::int32_t j, std::int32_t k, std::int32_t count) {
    const LatticePoint p = PageGrid::kSide * id.block + LatticePoint{0, j, k};
    const std::size_t at = place({0, j, k});
    LodValues<Word>& values = lods_[static_cast<std::size_t>(id.lod)];
    std::copy_n(values.low(p.j, p.k) + p.i, count, page_->low.data() + at);
    std::copy_n(values.high(p.j, p.k) + p.i, count, page_->high.data() + at);
    std::copy_n(values.codes(p.j, p.k) + p.i, count, page_->errors.data() + at);
  }

  /// Fills the bounds of a point of the coarsest page, whose points belong to several LODs.
  void fill_point(LatticePoint q, int page_lod) {
    const std::size_t at = place(q);
    const int lod = page_lod + trailing_zeros(q);
    if (lod >= grid_.depth()) {
      fill_empty(at);
      return;
    }
    const int shift = lod - page_lod;
    const LatticePoint p{q.i >> shift, q.j >> shift, q.k >> shift};
    LodValues<Word>& values = lods_[static_cast<std::size_t>(lod)];
    // Other LODs of the page may extend farther.
    const LatticePoint size = values.size();
    if (p.i >= size.i || p.j >= size.j || p.k >= size.k) {
      fill_empty(at);
      return;
    }
    page_->low[at] = values.low(p.j, p.k)[p.i];
    page_->high[at] = values.high(p.j, p.k)[p.i];
    page_->errors[at] = values.codes(p.j, p.k)[p.i];
  }

  void fill_empty(std::size_t at) {
    page_->low[at] = LodValues<Word>::kGreatest;
    page_->high[at] = 0;
    page_->errors[at] = 0;
  }

  const PageGrid& grid_;
  Lods& lods_;
  const CoarseSamples<Word>& coarse_;
  const PageSink<Sample>& sink_;
  std::vector<std::int32_t> next_;  ///< the next row of pages along k, by LOD
  std::unique_ptr<Page<Word>> page_;
};

/// LODs finer than this one are held in part, in as many planes as are being processed.
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
      // If an axis is a single sample, the diamonds beside it are held between those on it.
      for (int axis = 0; axis < 3; ++axis) size[axis] = std::max(size[axis], 2);
      const bool is_whole = lod >= kWholeLod;
      // The planes are those of a slab; of a row of pages that it does not finish; and the slab's last two,
      // which are not final.
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

  /// Reads the planes behind those of the slab before, up to the first of the slab behind.
  void read_slab(std::int32_t slab) {
    const std::int32_t first = slab == 0 ? 0 : kSlab * slab + 1, end = kSlab * (slab + 1);
    for (std::int32_t k = first; k <= end; ++k) {
      if (k <= last_.k) read(k);
      for (int lod = 0; lod < std::min(kWholeLod, static_cast<int>(lods_.size())); ++lod) {
        if ((k & ((1 << lod) - 1)) != 0 || k >> lod >= lods_[static_cast<std::size_t>(lod)].size().k)
          continue;
        lods_[static_cast<std::size_t>(lod)].open(k >> lod);
        // The samples beyond the data are those of the last plane, which are still there.
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
  std::vector<Sample> samples_;  ///< the samples of the plane that was read
  std::vector<Word> words_;      ///< these samples as words
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

ADAMAS_INSTANTIATE_FUNCTION_FOR_SAMPLES(preprocess);

}  // namespace adamas::isosurface
