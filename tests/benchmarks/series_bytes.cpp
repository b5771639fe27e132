// Finds where the bytes of a stored series lie, and which of them a contour needs at all: the bytes of pages
// that it crosses at a step; of pages that these are predicted from in space; and of pages at earlier steps
// that either is coded with in time and that those steps themselves did not need. Prints a line of JSON.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <type_traits>
#include <vector>

#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/volume/samples.h"

namespace adamas::bench {

using namespace isosurface;

namespace {

enum Need : std::uint8_t { kNot, kInTime, kInSpace, kCrossed, kNeeds };
constexpr std::array<const char*, kNeeds> kNames{"not needed", "in time", "in space", "crossed"};

struct Bytes {
  std::uint64_t pages = 0, samples = 0, bounds = 0;
};

class Needs {
 public:
  Needs(StoreFile& file, std::uint32_t word) : file_(file) {
    needs_.resize(file.steps(), std::vector<std::uint8_t>(std::size_t{2} << (3 * file.grid().top()), kNot));
    for (std::uint32_t step = 0; step < file.steps(); ++step) {
      for_each_page([&](const PageId& id) {
        const auto entry = file_.entry(step, id);
        if (entry && entry->low < word && word <= entry->high) need(step, id, kCrossed);
      });
    }
  }

  /// Returns the bytes by what they are needed for.
  std::array<Bytes, kNeeds> bytes() {
    std::array<Bytes, kNeeds> found{};
    for (std::uint32_t step = 0; step < file_.steps(); ++step) {
      for_each_page([&](const PageId& id) {
        const PagePayload parts = parts_of(step, id);
        if (file_.entry(step, id)->size == 0) return;
        Bytes& of = found[needs_[step][file_.grid().number(id)]];
        ++of.pages;
        of.samples += parts.samples.size();
        of.bounds += parts.bounds.size();
      });
    }
    return found;
  }

 private:
  template <class Fn>
  void for_each_page(Fn&& fn) const {
    for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file_.grid().top()); ++number)
      if (const PageId id = file_.grid().page(number); file_.grid().contains(id)) fn(id);
  }

  PagePayload parts_of(std::uint32_t step, const PageId& id) {
    PagePayload parts;
    if (!split_payload(file_.read(step, id).bytes, file_.header(step).coding, parts)) std::abort();
    return parts;
  }

  /// Marks a page as needed. A page that was needed for a lesser reason has all pages that it depends on
  /// already.
  void need(std::uint32_t step, const PageId& id, Need what) {
    std::uint8_t& before = needs_[step][file_.grid().number(id)];
    const bool is_new = before == kNot;
    before = std::max<std::uint8_t>(before, what);
    if (!is_new && what != kCrossed) return;
    const int order = time_order(parts_of(step, id).samples);
    for (int n = 1; n <= order; ++n) need(step - static_cast<std::uint32_t>(n), id, kInTime);
    need_coarser(step, id, what == kInTime ? kInTime : kInSpace);
  }

  void need_coarser(std::uint32_t step, const PageId& id, Need what) {
    if (id.lod == file_.grid().top()) return;
    const LatticePoint n = file_.grid().blocks(id.lod + 1);
    // The page needs the points -1 to 9 of the coarser LOD, counted from the cube's first one.
    const auto first = [](std::int32_t block) { return (8 * block - 1) >> 4; };
    const auto last = [](std::int32_t block) { return (8 * block + 9) >> 4; };
    for (std::int32_t k = std::max(0, first(id.block.k)); k <= std::min(n.k - 1, last(id.block.k)); ++k)
      for (std::int32_t j = std::max(0, first(id.block.j)); j <= std::min(n.j - 1, last(id.block.j)); ++j)
        for (std::int32_t i = std::max(0, first(id.block.i)); i <= std::min(n.i - 1, last(id.block.i)); ++i)
          if (const PageId coarser{id.lod + 1, {i, j, k}}; file_.grid().contains(coarser))
            need(step, coarser, what);
  }

  StoreFile& file_;
  std::vector<std::vector<std::uint8_t>> needs_;
};

void report(StoreFile& file, double isovalue) {
  const auto word = with_sample_type(file.header().grid.type, [&](auto sample) -> std::uint32_t {
    using Sample = decltype(sample);
    const double at = file.header().grid.sample(isovalue);
    return ordered(static_cast<Sample>(std::is_integral_v<Sample> ? std::ceil(at) : at));
  });
  Needs needs(file, word);
  const auto bytes = needs.bytes();
  std::uint64_t all = 0;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const Bytes& of = bytes[n];
    all += of.samples + of.bounds;
    std::printf("%s\"%s\": {\"pages\": %llu, \"samples\": %llu, \"bounds\": %llu}", n == 0 ? "{" : ", ",
                kNames[n], static_cast<unsigned long long>(of.pages),
                static_cast<unsigned long long>(of.samples), static_cast<unsigned long long>(of.bounds));
  }
  std::printf(", \"others\": %llu, \"file\": %llu}\n", static_cast<unsigned long long>(file.size() - all),
              static_cast<unsigned long long>(file.size()));
}

}  // namespace
}  // namespace adamas::bench

/// Usage: bench_series_bytes STORE ISOVALUE.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  adamas::isosurface::StoreFile file(argv[1]);
  adamas::bench::report(file, std::atof(argv[2]));
}
