// Finds the magnitudes of the samples of a series of single bytes, before and after the difference transform
// along time of the dissertation (D 5.2), and of the residuals that its store holds: of samples or of
// differences in time, whichever a page was coded as. Prints a line of JSON with a histogram of each.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <vector>

#include "isosurface/compression/interpolation/interpolation_page.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/storage/page_payload.h"
#include "timevarying/restore_steps.h"
#include "timevarying/step_pages.h"

namespace adamas::bench {

using namespace isosurface;
using namespace timevarying;

namespace {

using Counts = std::map<unsigned, std::uint64_t>;
using Word = std::uint8_t;
constexpr std::size_t kMemory = std::size_t{512} << 20;

struct Coefficients {
  Counts samples, differences, residuals;
};

/// Applies equation 5.2 of the dissertation to the whole series: the coefficient is the difference between a
/// sample and the line through the two before it.
void transform(StoreFile& file, Coefficients& found) {
  const RestoredPart part = restored_part(file.header().grid, 0, {}, file.name());
  std::vector<std::vector<Word>> steps(file.steps());
  const auto take = [&](std::uint32_t step, std::span<const std::byte> plane) {
    for (const std::byte sample : plane) steps[step].push_back(std::to_integer<Word>(sample));
  };
  restore_steps(file, {0, file.steps() - 1}, part, kMemory, take, SilentProgress::instance());
  for (std::size_t t = 0; t < steps.size(); ++t) {
    for (std::size_t n = 0; n < steps[t].size(); ++n) {
      const int now = steps[t][n], one = t > 0 ? steps[t - 1][n] : 0, two = t > 1 ? steps[t - 2][n] : one;
      ++found.samples[static_cast<unsigned>(now)];
      ++found.differences[static_cast<unsigned>(std::abs(t > 0 ? now - one - (one - two) : now))];
    }
  }
}

using Around = Surroundings<Word>::Points<Word>;

/// A page of a step with its surroundings.
struct PageNow {
  PagePoints<Word> samples;
  Around around;

  PageNow(StepPages<Word>& steps, std::uint32_t step, const PageId& id) {
    StoredPages<Word>& pages = steps.at(step);
    samples = pages.needed_samples(id).samples;
    Surroundings<Word> found;
    if (!pages.surroundings(id, found, PageParts::kSamples)) std::abort();
    around = found.samples;
  }
  /// Replaces samples by their differences, of order 1 where both steps before are the same.
  void subtract(const PageNow& one, const PageNow& two) {
    subtract(one.samples, two.samples, samples);
    subtract(one.around, two.around, around);
  }
  template <std::size_t N>
  static void subtract(const std::array<Word, N>& one, const std::array<Word, N>& two,
                       std::array<Word, N>& from) {
    for (std::size_t n = 0; n < N; ++n) from[n] = static_cast<Word>(from[n] - 2 * one[n] + two[n] + 128);
  }
};

void add_residuals(const PageShape& shape, const PageNow& page, Counts& counts) {
  InterpolationPage<Depth8> predicted(shape.count, page.around);
  std::array<Word, InterpolationPage<Depth8>::kMostInSet> folded;
  for (int set = 0; set < InterpolationCells<Depth8>::kSets; ++set) {
    predicted.predict(set);
    predicted.residuals(set, page.samples, folded.data());
    predicted.apply(set, folded.data());
    for (std::size_t n = 0; n < predicted.size(set); ++n) ++counts[(folded[n] + 1u) / 2];
  }
}

/// Finds the residuals of all pages but the coarsest one.
void residuals(StoreFile& file, Coefficients& found) {
  StepPages<Word> steps(file, kMemory);
  for (std::uint32_t step = 0; step < file.steps(); ++step) {
    for (std::uint64_t number = 2; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
      const PageId id = file.grid().page(number);
      if (!file.grid().contains(id)) continue;
      const PageShape shape = page_shape(file.grid(), id);
      const auto payload = file.read(step, id).bytes;
      PagePayload parts;
      if (!split_payload(payload, file.header(step).coding, parts)) std::abort();
      const int order = time_order(parts.samples);
      if (order == 1 && parts.samples[0] == kAsBefore) {
        found.residuals[0] += own_points(shape);
        continue;
      }
      PageNow page(steps, step, id);
      // Order 1 is order 2 with two equal steps before: the prediction is 2 a - a.
      if (order > 0) {
        const PageNow one(steps, step - 1, id);
        page.subtract(one, order == 1 ? one : PageNow(steps, step - 2, id));
      }
      add_residuals(shape, page, found.residuals);
    }
  }
}

void print(const char* name, const Counts& counts, const char* end) {
  std::printf("\"%s\": {", name);
  const char* comma = "";
  for (const auto& [magnitude, count] : counts) {
    std::printf("%s\"%u\": %llu", comma, magnitude, static_cast<unsigned long long>(count));
    comma = ", ";
  }
  std::printf("}%s", end);
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_series_coefficients STORE.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  adamas::isosurface::StoreFile file(argv[1]);
  if (file.header().grid.type != adamas::SampleType::kUint8) return 2;
  adamas::bench::Coefficients found;
  adamas::bench::transform(file, found);
  adamas::bench::residuals(file, found);
  std::printf("{");
  adamas::bench::print("samples", found.samples, ", ");
  adamas::bench::print("differences", found.differences, ", ");
  adamas::bench::print("residuals", found.residuals, "}\n");
}
