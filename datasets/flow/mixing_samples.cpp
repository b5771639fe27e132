#include "datasets/flow/mixing_samples.h"

#include <algorithm>
#include <limits>

#include "core/base/parallel.h"

namespace adamas::datasets {

namespace {

/// The result for one plane of a field.
struct PlaneFacts {
  std::uint64_t cut_off = 0;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;

  void put(double value, std::size_t at, const SampleScale& scale, std::span<std::byte> samples) {
    if (!scale.put(value, at, samples)) ++cut_off;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
};

SampleScale scale_of(SampleType type, const MixingRange& range) { return {type, range.low, range.high}; }

}  // namespace

MixingSamples::MixingSamples(const std::array<std::size_t, 3>& cells, double mach, SampleType type)
    : fields_{{{"entropy", "J/(kg K)", scale_of(type, mixing_entropy_range(mach))},
               {"density", "kg/m3", scale_of(type, mixing_density_range(mach))}}} {
  const double size = kMixingLength / static_cast<double>(cells[2]);
  grid_.dimensions = {cells[0], cells[1], cells[2]};
  grid_.type = type;
  grid_.spacing = {size, size, size};
  grid_.origin = {0.5 * size, 0.5 * size, 0.5 * size};
  for (MixingField& field : fields_) field.samples.resize(static_cast<std::size_t>(grid_.bytes()));
}

void MixingSamples::update(const FlowSolver<2>& flow) {
  const auto& n = flow.problem().cells;
  std::vector<std::array<PlaneFacts, 2>> planes(n[2]);
  parallel_for(n[2], 1, [&](std::size_t k) {
    for (std::size_t j = 0; j < n[1]; ++j) {
      for (std::size_t i = 0; i < n[0]; ++i) {
        const FlowCell<2> cell = flow.cell(i, j, k);
        const std::size_t at = i + n[0] * (j + n[1] * k);
        planes[k][0].put(mixing_entropy(cell), at, fields_[0].scale, fields_[0].samples);
        planes[k][1].put(mixing_density(cell), at, fields_[1].scale, fields_[1].samples);
      }
    }
  });
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    MixingField& field = fields_[f];
    for (const auto& plane : planes) {
      field.cut_off += plane[f].cut_off;
      field.least = std::min(field.least, plane[f].least);
      field.greatest = std::max(field.greatest, plane[f].greatest);
    }
  }
}

}  // namespace adamas::datasets
