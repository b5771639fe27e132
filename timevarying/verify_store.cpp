#include "timevarying/verify_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/lattice/diamond.h"
#include "isosurface/storage/number_remainders.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/samples.h"
#include "timevarying/restore_steps.h"
#include "timevarying/step_pages.h"

namespace adamas::timevarying {

using namespace isosurface;

namespace {

constexpr std::size_t kMostProblems = 20;

void add_problem(const std::string& text, std::uint32_t step, VerifiedStore& result) {
  auto& problems = result.problems;
  auto known = std::find_if(problems.begin(), problems.end(),
                            [&](const PageProblem& each) { return each.what == text; });
  if (known == problems.end()) {
    if (problems.size() >= kMostProblems) {
      ++result.further_problems;
      return;
    }
    known = problems.insert(known, {text, {}});
  }
  known->steps.push_back(step);
}

void add_bad(const std::string& text, std::uint32_t step, VerifiedStore& result) {
  ++result.bad_pages;
  if (result.bad_steps.empty() || result.bad_steps.back() != step) result.bad_steps.push_back(step);
  add_problem(text, step, result);
}

/// Checks the records of remainders of a step; damaged ones count as damaged pages.
void check_remainders(StoreFile& file, std::uint32_t step, VerifiedStore& result) {
  const StoreHeader& header = file.header();
  if (!has_remainders(header.numbers.type)) return;
  std::vector<std::byte> remainders;
  const std::uint64_t planes = remainder_planes(header.grid);
  for (std::uint64_t record = 0; record < remainder_records(header.grid); ++record) {
    const std::uint64_t first = record * planes, end = std::min(first + planes, header.grid.dimensions[2]);
    if (!read_remainders(file, step, record, remainders))
      add_bad(fmt::format("the remainders of planes {} to {} are damaged", first, end - 1), step, result);
  }
}

template <class Sample>
class Verifier {
 public:
  using Word = OrderedWord<Sample>;

  Verifier(StoreFile& file, std::uint32_t step, std::size_t memory, VerifiedStore& result)
      : file_(file), step_(step), pages_(file, step, memory), result_(result) {
    if (file.header().gradients) gradients_ = std::make_unique<StoredGradients>(file, step, memory / 4);
  }

  void run(Progress& progress) {
    const PageGrid& grid = pages_.grid();
    std::uint64_t done = 0;
    for (int lod = grid.top(); lod >= 0; --lod) {
      const LatticePoint n = grid.blocks(lod);
      for (std::int32_t k = 0; k < n.k; ++k) {
        for (std::int32_t j = 0; j < n.j; ++j) {
          progress.step("verifying", static_cast<double>(done) / static_cast<double>(grid.page_count()));
          for (std::int32_t i = 0; i < n.i; ++i) {
            const PageId id{lod, {i, j, k}};
            if (!grid.contains(id)) continue;
            ++done;
            check(id);
          }
        }
      }
    }
  }

 private:
  void check(const PageId& id) {
    ++result_.pages;
    const StoreFile::Payload payload = file_.read(step_, id);
    PagePayload parts;
    const bool has_gradients =
        split_payload(payload.bytes, file_.header(step_).coding, parts) && !parts.gradients.empty();
    const std::optional<PageEntry> entry = file_.entry(step_, id);
    if (payload.state == PageState::kCopied ||
        (payload.state == PageState::kWhole && entry && !file_.copy_is_whole(*entry))) {
      ++result_.bad_copies;
      add_problem(text(id, "one of its two copies is damaged"), step_, result_);
    }
    if (!pages_.copy(id, page_)) {
      add_bad(
          text(id, payload.state == PageState::kDamaged ? "is damaged" : "is predicted from a damaged one"),
          step_, result_);
    } else if (const char* what = fault(id, page_, entry, has_gradients)) {
      add_bad(text(id, what), step_, result_);
    }
  }

  /// The fault of a page that can be decoded, except in its gradients; null if there is none.
  const char* fault(const PageId& id, const Page<Word>& page, const std::optional<PageEntry>& entry,
                    bool has_gradients) {
    if (entry && !is_summary(id, page, *entry)) return "is not what the directory says of it";
    if (!is_lawful(id, page)) return "has errors or ranges greater than those of the diamonds they come from";
    if (!gradients_ && has_gradients) return "has gradients, which the store does not have";
    if (gradients_ && gradients_->samples(id) == nullptr) return "has gradients that are damaged";
    return nullptr;
  }

  bool is_summary(const PageId& id, const Page<Word>& page, const PageSummary& expected) const {
    return summary(page_shape(pages_.grid(), id), page) == expected;
  }

  /// Whether diamonds of a page satisfy the laws with their parents, as far as the page has both.
  bool is_lawful(const PageId& id, const Page<Word>& page) const {
    const PageGrid& grid = pages_.grid();
    const PageShape shape = page_shape(grid, id);
    LatticePoint q{};
    for (q.k = 0; q.k < shape.count.k; ++q.k) {
      for (q.j = 0; q.j < shape.count.j; ++q.j) {
        for (q.i = 0; q.i < shape.count.i; ++q.i) {
          const LatticePoint at = PageGrid::kSide * id.block + q;
          const int zeros = trailing_zeros(at);
          if (id.lod + zeros + 1 >= grid.depth() || (!shape.complete && zeros > 0)) continue;
          const DiamondType& type = kDiamondTypes[static_cast<std::size_t>(diamond_type(at, zeros))];
          for (int c = 0; c < type.parent_count; ++c) {
            const LatticePoint parent = q + (1 << zeros) * type.parent_offsets[static_cast<std::size_t>(c)];
            if (is_in(parent, shape) && reaches_data(PageGrid::kSide * id.block + parent, id.lod) &&
                !is_within(page, q, parent, zeros, id))
              return false;
          }
        }
      }
    }
    return true;
  }

  /// Whether the diamond of a point of an LOD, in units of the LOD, intersects the data. In the coarsest page
  /// some diamonds do not; nothing is known of them, so they bound no others.
  [[nodiscard]] bool reaches_data(LatticePoint at, int lod) const {
    const int zeros = trailing_zeros(at);
    const LatticePoint end = pages_.grid().reach(lod + zeros);
    return at.i >> zeros <= end.i && at.j >> zeros <= end.j && at.k >> zeros <= end.k;
  }

  static bool is_in(LatticePoint q, const PageShape& shape) {
    return q.i >= 0 && q.j >= 0 && q.k >= 0 && q.i < shape.count.i && q.j < shape.count.j &&
           q.k < shape.count.k;
  }

  static bool is_within(const Page<Word>& page, LatticePoint child, LatticePoint parent, int child_zeros,
                        const PageId& id) {
    const std::size_t c = PageGrid::place(child, 0), p = PageGrid::place(parent, 0);
    const int parent_zeros = trailing_zeros(PageGrid::kSide * id.block + parent);
    if (error_class(page.errors[p], parent_zeros) < error_class(page.errors[c], child_zeros)) return false;
    return page.low[c] > page.high[c] || (page.low[p] <= page.low[c] && page.high[p] >= page.high[c]);
  }

  static std::string text(const PageId& id, const char* what) {
    return fmt::format("{} {}", page_name(id), what);
  }

  StoreFile& file_;
  std::uint32_t step_;
  SeriesPages<Word> pages_;
  Page<Word> page_;
  std::unique_ptr<StoredGradients> gradients_;  ///< null if the store has none
  VerifiedStore& result_;
};

}  // namespace

VerifiedStore verify_store(StoreFile& file, std::size_t memory, Progress& progress) {
  file.check_directory();
  VerifiedStore result;
  for (std::uint32_t step = 0; step < file.steps(); ++step) {
    with_sample_type(file.header().grid.type, [&](auto sample) {
      Verifier<decltype(sample)>(file, step, memory, result).run(progress);
    });
    check_remainders(file, step, result);
  }
  return result;
}

}  // namespace adamas::timevarying
