// Measures the prediction from the ends of the split edge on a volume and on its gradients: counts of the
// leading 1, alone and in succession, the coded size, and histograms. Prints JSON, and draws the histograms.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/picture/plot.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/compression/sample_codec.h"
#include "isosurface/compression/split_edge/residual_code.h"
#include "isosurface/gradients/gradient_smoothing.h"
#include "isosurface/gradients/plane_gradients.h"
#include "isosurface/volume/samples.h"
#include "tests/benchmarks/support/volume_in_memory.h"
#include "tests/support/smoothed_block.h"
#include "tests/support/volume_pages.h"

namespace adamas::bench {

using namespace isosurface;
using namespace picture;

namespace {

using Counts = std::map<std::uint64_t, std::uint64_t>;

/// What the prediction leaves of numbers, one per sample.
struct Transformed {
  explicit Transformed(int bits) : statistics(bits), lead_one(bits) {}

  ResidualStatistics statistics;
  LeadOne lead_one;
  Counts magnitudes;
  std::size_t bytes = 0;  ///< size of the code without its tables
};

template <class Word>
using Pages = test::VolumePages<Word>;

/// Returns the residuals of a page, in the order in which they are coded.
template <class Word>
std::vector<std::uint32_t> residuals(const test::PageContent<Word>& page) {
  std::vector<std::uint32_t> found;
  for_each_own_point(page.shape, [&](LatticePoint q, std::uint64_t) {
    const Word sample = page.samples[PageGrid::place(q, 0)];
    Word guess = 0;
    if (page.shape.complete) {
      guess = predicted_inside<Word>(q, page.shape, page.samples);
    } else {
      const LatticePoint d = split_direction(q);
      guess = static_cast<Word>(
          predicted(page.around[surrounding_place(q - d)], page.around[surrounding_place(q + d)]));
    }
    found.push_back(static_cast<Word>(sample - guess));
  });
  return found;
}

std::uint32_t magnitude(std::uint32_t residual, const LeadOne& lead_one) {
  const bool negative = (residual >> (lead_one.bits() - 1) & 1) != 0;
  return (negative ? 0 - residual : residual) & lead_one.mask();
}

/// Returns the statistics of all parts together, coded with the same tables.
template <class Word>
Transformed transform(const std::vector<Pages<Word>>& parts) {
  Transformed result(8 * sizeof(Word));
  const auto survey = sample_survey<Word>(SampleCoding::kSplitEdge);
  test::PageContent<Word> content;
  for (const Pages<Word>& part : parts) {
    for (const PageId& page : part.pages()) {
      part.content(page, content);
      const std::vector<std::uint32_t> found = residuals(content);
      result.statistics.add(found);
      for (const std::uint32_t r : found) ++result.magnitudes[magnitude(r, result.lead_one)];
      survey->add(content.shape, content.around, content.samples);
    }
  }
  const auto codec = survey->codec();
  std::vector<std::byte> code;
  for (const Pages<Word>& part : parts) {
    for (const PageId& page : part.pages()) {
      part.content(page, content);
      code.clear();
      codec->encode(content.shape, content.around, content.samples, code);
      result.bytes += code.size();
    }
  }
  return result;
}

/// Returns the smoothed directions of gradients as a byte for each component (D 4.3), by component.
std::array<std::vector<std::uint8_t>, 3> gradient_bytes(const VolumeInMemory& volume) {
  const auto [nx, ny, nz] = volume.grid.dimensions;
  const std::size_t plane = nx * ny;
  std::vector<Gradient> gradients(volume.grid.samples());
  const PlaneGradients estimate(volume.grid.spacing, nx, ny);
  with_sample_type(volume.grid.type, [&](auto sample) {
    using Sample = decltype(sample);
    const auto* samples = reinterpret_cast<const Sample*>(volume.bytes.data());
    for (std::size_t k = 0; k < nz; ++k) {
      const Sample* middle = samples + k * plane;
      const std::array<const Sample*, 3> planes{k > 0 ? middle - plane : nullptr, middle,
                                                k + 1 < nz ? middle + plane : nullptr};
      estimate(planes, std::span(gradients).subspan(k * plane, plane));
    }
  });
  test::smooth_gradients(gradients, {nx, ny, nz});
  std::array<std::vector<std::uint8_t>, 3> bytes;
  for (const Gradient& g : gradients) {
    const double length = norm(Vec3{g[0], g[1], g[2]});
    for (std::size_t c = 0; c < 3; ++c)
      bytes[c].push_back(static_cast<std::uint8_t>(length > 0 ? 128 + std::lround(127 * g[c] / length) : 0));
  }
  return bytes;
}

void print_counts(const char* name, const Counts& counts) {
  std::printf(",\n \"%s\": {", name);
  const char* between = "";
  for (const auto& [value, count] : counts) {
    std::printf("%s\"%llu\": %llu", between, static_cast<unsigned long long>(value),
                static_cast<unsigned long long>(count));
    between = ", ";
  }
  std::printf("}");
}

/// Returns counts by the position of the leading 1, which is 0 for zero.
Counts lead_ones(const Counts& values) {
  Counts counts;
  for (const auto& [value, count] : values)
    counts[static_cast<std::uint64_t>(std::bit_width(value))] += count;
  return counts;
}

PlotSeries series(const std::string& name, const Counts& counts, std::uint64_t width) {
  Counts bins;
  for (const auto& [value, count] : counts) bins[value / width] += count;
  PlotSeries result;
  result.name = name;
  result.markers = false;
  for (const auto& [bin, count] : bins) {
    result.x.push_back(static_cast<double>(bin * width) + static_cast<double>(width - 1) / 2);
    result.y.push_back(static_cast<double>(count));
  }
  return result;
}

Plot histogram(const std::string& title, const std::string& what, const Counts& raw,
               const Counts& transformed) {
  Plot plot;
  plot.title = title;
  plot.x.label = what;
  const std::uint64_t width = raw.rbegin()->first / 256 + 1;
  plot.y.label = width > 1 ? fmt::format("number, in steps of {}", width) : "number";
  plot.y.kind = AxisKind::kLogarithmic;
  plot.series = {series("raw", raw, width), series("after the prediction", transformed, width)};
  return plot;
}

void print_conditional(const Transformed& transformed) {
  std::printf(",\n \"after\": [");
  for (int previous = 0; previous < transformed.lead_one.symbols(); ++previous) {
    std::printf("%s[", previous > 0 ? ", " : "");
    const char* between = "";
    for (const std::uint64_t count : transformed.statistics.counts(previous)) {
      std::printf("%s%llu", between, static_cast<unsigned long long>(count));
      between = ", ";
    }
    std::printf("]");
  }
  std::printf("]");
}

template <class Sample>
void report(const VolumeInMemory& volume, const std::string& picture) {
  using Word = OrderedWord<Sample>;
  const std::vector<std::byte> bytes = volume.ordered_words();
  std::vector<Word> words(bytes.size() / sizeof(Word));
  std::memcpy(words.data(), bytes.data(), bytes.size());
  Counts raw, raw_gradients;
  for (const Word word : words) ++raw[word];
  std::vector<Pages<Word>> data;
  data.emplace_back(volume.grid.dimensions, std::move(words));
  const Transformed of_data = transform(data);
  data.clear();

  std::vector<Pages<std::uint8_t>> components;
  for (std::vector<std::uint8_t>& component : gradient_bytes(volume)) {
    // Code 0 is that of samples without a direction.
    for (const std::uint8_t code : component)
      if (code != 0) ++raw_gradients[static_cast<std::uint64_t>(std::abs(code - 128))];
    components.emplace_back(volume.grid.dimensions, std::move(component));
  }
  const Transformed of_gradients = transform(components);

  std::printf(
      "{\"volume\": \"%s\", \"type\": \"%s\", \"samples\": %llu, \"input\": %zu, \"data\": %zu, "
      "\"gradients\": %zu",
      volume.name.c_str(), sample_name(volume.grid.type),
      static_cast<unsigned long long>(volume.grid.samples()), volume.bytes.size(), of_data.bytes,
      of_gradients.bytes);
  print_counts("raw", lead_ones(raw));
  print_counts("transformed", lead_ones(of_data.magnitudes));
  print_conditional(of_data);
  std::printf("}\n");
  const std::array<Plot, 2> plots{
      histogram(volume.name + ": samples", "value; of what is left, magnitude", raw, of_data.magnitudes),
      histogram(volume.name + ": gradients", "magnitude of a component", raw_gradients,
                of_gradients.magnitudes)};
  PlotOptions options;
  options.width = 800;
  options.height = 560;
  write_bytes(picture, draw_plots(plots, picture_format(picture), options));
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_volume_tables VOLUME PICTURE, with a volume as load_volume names it.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const adamas::bench::VolumeInMemory volume = adamas::bench::load_volume(argv[1]);
  adamas::isosurface::with_sample_type(
      volume.grid.type, [&](auto sample) { adamas::bench::report<decltype(sample)>(volume, argv[2]); });
}
