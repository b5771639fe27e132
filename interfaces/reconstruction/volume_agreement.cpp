#include "interfaces/reconstruction/volume_agreement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/reconstruction/blurred_fractions.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

namespace {

using Entry = SiteValues::Entry;

/// Fractions agree if they differ by at most this many standard deviations of their errors.
constexpr double kOfError = 3;

}  // namespace

CellAgreement volume_agreement(const MultiMaterialData& data, const SiteValues& values,
                               const SiteCells& cells, std::vector<VolumeMove> moves) {
  if (values.mixed_sites().empty()) return {};
  std::ranges::stable_sort(moves, {}, &VolumeMove::cell);
  BlurredFractions blurred(data, values, cells);
  blurred.predict();
  std::vector<float> differences(data.grid.site_count());
  parallel_chunks(differences.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<double> given;
    for (std::size_t site = begin; site < end; ++site) {
      const std::span<const Entry> own = values.at(site);
      find_given_fractions(data, values, site, given);
      for (std::size_t e = 0; e < own.size(); ++e) {
        const std::uint16_t whole = values.material_number(own[e].material);
        const std::size_t entry = values.index(own[e]);
        if (entry != first_entry(values, site, whole)) continue;
        double off = static_cast<double>(blurred.at(entry)) - given[e];
        auto move = std::ranges::lower_bound(moves, site, {}, &VolumeMove::cell);
        for (; move != moves.end() && move->cell == site; ++move) {
          if (values.material(whole) == move->from) off -= move->part;
          if (values.material(whole) == move->to) off += move->part;
        }
        differences[site] = std::max(differences[site], static_cast<float>(std::abs(off)));
      }
    }
  });
  CellAgreement result;
  result.tolerance = std::max(kCellOff, kOfError * values.findings().fraction_error);
  for (const std::uint32_t site : values.mixed_sites()) {
    const auto d = static_cast<double>(std::exchange(differences[site], 0.0f));
    ++result.mixed_cells;
    result.cells_off += d > result.tolerance ? 1 : 0;
    result.greatest_difference = std::max(result.greatest_difference, d);
    result.mean_difference += d / static_cast<double>(values.mixed_sites().size());
  }
  for (const float difference : differences) {
    const auto d = static_cast<double>(difference);
    result.full_cells_off += d > kCellOff ? 1 : 0;
    result.greatest_in_full_cell = std::max(result.greatest_in_full_cell, d);
  }
  return result;
}

}  // namespace adamas::interfaces
