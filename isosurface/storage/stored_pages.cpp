#include "isosurface/storage/stored_pages.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/storage/page_payload.h"

namespace adamas::isosurface {

template <class Word>
StoredPages<Word>::StoredPages(StoreFile& file, std::uint32_t step, std::size_t memory)
    : StoredPages(
          file, step, std::make_shared<PageMemory<Word>>(memory),
          parse_sample_codec<Word>(file.header(step).coding, file.header(step).sample_tables, file.name()),
          nullptr) {
  ADAMAS_ASSERT(steps_before(step) == 0);
}

template <class Word>
StoredPages<Word>::StoredPages(StoreFile& file, std::uint32_t step, std::shared_ptr<PageMemory<Word>> memory,
                               SpaceCodec space_codec, const StoredPages* alike)
    : PageCache<Word>(file.grid(), memory),
      file_(file),
      step_(step),
      memory_for_threads_(memory->limit),
      space_codec_(std::move(space_codec)) {
  if (alike != nullptr) bounds_codec_ = alike->bounds_codec_;
}

template <class Word>
bool StoredPages<Word>::load(const PageToLoad<Word>& page) {
  last_damaged_ = page.id;
  const auto is_among = [&](const std::vector<PageId>& pages) {
    return std::find(pages.begin(), pages.end(), page.id) != pages.end();
  };
  const bool is_damaged = is_among(damaged_);
  if (is_damaged && (page.bounds != nullptr || !is_among(damaged_bounds_))) return false;
  const StoreFile::Payload payload = file_.read(step_, page.id);
  const Decoded decoded =
      payload.state == PageState::kDamaged ? Decoded::kNothing : decode(payload.bytes, page);
  if (decoded != Decoded::kAll) {
    if (!is_damaged) damaged_.push_back(page.id);
    if (decoded == Decoded::kSamples) damaged_bounds_.push_back(page.id);
    return false;
  }
  if (has_part(page.parts, PageParts::kSamples)) copies_ += payload.state == PageState::kCopied ? 1 : 0;
  return true;
}

template <class Word>
typename StoredPages<Word>::Decoded StoredPages<Word>::decode(std::span<const std::byte> payload,
                                                              const PageToLoad<Word>& page) {
  const SampleCoding coding = file_.header(step_).coding;
  PagePayload coded;
  if (!split_payload(payload, coding, coded)) return Decoded::kNothing;
  std::vector<std::byte> kept;
  if (time_order(coded.samples) > 0 || coded.has_earlier_bounds()) {
    // Reading another step's page invalidates the bytes of this one.
    kept.assign(payload.begin(), payload.end());
    if (!split_payload(kept, coding, coded)) return Decoded::kNothing;
  }
  if (has_part(page.parts, PageParts::kSamples) && !decode_samples(coded.samples, page))
    return Decoded::kNothing;
  return page.bounds == nullptr || decode_bounds(coded, page) ? Decoded::kAll : Decoded::kSamples;
}

template <class Word>
bool StoredPages<Word>::decode_samples(std::span<const std::byte> coded, const PageToLoad<Word>& page) {
  if (time_order(coded) > 0) return decode_in_time(coded, page);
  return space_codec_->decode_with(coded, page.shape, page.around.samples, page.samples.samples,
                                   page.samples.along);
}

template <class Word>
bool StoredPages<Word>::decode_bounds(const PagePayload& coded, const PageToLoad<Word>& page) {
  const StoreHeader& header = file_.header(step_);
  if (coded.has_earlier_bounds()) {
    if (step_ == header.first_step) return false;
    const PageBounds<Word>* bounds = earlier_bounds(page.id);
    if (bounds == nullptr) return false;
    *page.bounds = *bounds;
    return true;
  }
  if (!bounds_codec_)
    bounds_codec_ = std::make_shared<BoundsCodec<Word>>(
        BoundsCodec<Word>::parse(header.bounds_tables, header.grid.spacing, file_.name()));
  const auto bounds = coded.all_bounds(page.samples.along);
  return bounds && bounds_codec_->decode(*bounds, page.shape, page.around, page.samples, *page.bounds);
}

template <class Word>
PageReads StoredPages<Word>::counts() const {
  const std::uint64_t predictors = this->loaded_as_predictors();
  PageReads all{this->loaded() - predictors, predictors, file_.bytes_read(), copies_, 0};
  // Several threads may find the same damage.
  std::vector<PageId> damaged = damaged_;
  for (const OfThread& other : others_) {
    for (const PageId& page : other.pages->damaged()) {
      if (std::find(damaged.begin(), damaged.end(), page) == damaged.end()) damaged.push_back(page);
    }
    all += other.pages->counts();
  }
  all.damaged = damaged.size();
  return all;
}

template <class Word>
std::vector<StoredPages<Word>*> StoredPages<Word>::for_threads(std::size_t count) {
  while (others_.size() + 1 < count) {
    OfThread other{file_.for_another_thread(), nullptr};
    other.pages = by_file(*other.file, memory_for_threads_);
    others_.push_back(std::move(other));
  }
  std::vector<StoredPages*> result{this};
  for (const OfThread& other : others_) result.push_back(other.pages.get());
  for (StoredPages* pages : result) pages->set_memory(memory_for_threads_ / result.size());
  result.resize(std::max<std::size_t>(1, count));
  if (count <= 1) return result;
  std::vector<std::vector<typename PageCache<Word>::HeldPage>> held;
  for (const StoredPages* pages : result) held.push_back(pages->held_pages());
  parallel_for(result.size(), 1, [&](std::size_t to) {
    for (std::size_t from = 0; from < result.size(); ++from) {
      if (from != to) result[to]->copy_samples(held[from]);
    }
  });
  return result;
}

ADAMAS_INSTANTIATE_FOR_WORDS(StoredPages);

template <class Sample>
std::optional<std::array<double, 2>> sample_range(StoredPages<OrderedWord<Sample>>& pages) {
  using Word = OrderedWord<Sample>;
  const PageGrid& grid = pages.grid();
  const PageId coarsest{grid.top(), {0, 0, 0}};
  const auto value = [](auto word) {
    return static_cast<double>(from_ordered<Sample>(static_cast<Word>(word)));
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (grid.depth() > 0) {
    const std::optional<PageEntry> all = pages.entry(coarsest);
    if (!all) return {};
    // The words of an empty range are no numbers.
    if (all->low > all->high) return std::array{kInfinity, -kInfinity};
    return std::array{value(all->low), value(all->high)};
  }
  // No diamond has a range if all samples are corners of the domain.
  const PageSamples<Word>* page = pages.samples(coarsest);
  if (page == nullptr) return {};
  std::array<double, 2> range{kInfinity, -kInfinity};
  const LatticePoint last = grid.last();
  for (std::int32_t corner = 0; corner < 8; ++corner) {
    const LatticePoint p{corner & 1, corner >> 1 & 1, corner >> 2};
    if (p.i > last.i || p.j > last.j || p.k > last.k) continue;
    const double found = value(page->samples[PageGrid::place(p, 0)]);
    if (std::isfinite(found)) range = {std::min(range[0], found), std::max(range[1], found)};
  }
  return range;
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_SAMPLES(sample_range);

namespace {

GradientCodec gradient_codec_of(const StoreFile& file, std::uint32_t step) {
  const StoreHeader& header = file.header(step);
  if (!header.gradients) fail("{}: expected gradients, found none", file.name());
  return GradientCodec::parse(coding_of_bytes(header.coding), header.gradient_tables, file.name());
}

}  // namespace

StoredGradients::StoredGradients(StoreFile& file, std::uint32_t step, std::size_t memory)
    : PageCache(file.grid(), memory), file_(file), step_(step), codec_(gradient_codec_of(file, step)) {}

bool StoredGradients::load(const PageToLoad<std::uint16_t>& page) {
  const StoreFile::Payload payload = file_.read(step_, page.id);
  PagePayload coded;
  if (payload.state != PageState::kDamaged &&
      split_payload(payload.bytes, file_.header(step_).coding, coded) &&
      codec_.decode(coded.gradients, page.shape, page.around.samples, page.samples.samples))
    return true;
  last_damaged_ = page.id;
  return false;
}

LatticePoint StoredGradients::in_data(LatticePoint p) const {
  for (int axis = 0; axis < 3; ++axis) p[axis] = std::min(p[axis], grid().last()[axis]);
  return p;
}

std::optional<Vec3> StoredGradients::direction(LatticePoint beyond) {
  // Pages do not have all points beyond the data.
  const LatticePoint p = in_data(beyond);
  const PageId id = grid().page(p);
  const PageSamples<std::uint16_t>* found = samples(id);
  if (found == nullptr) return {};
  const unsigned code = found->samples[PageGrid::place(p, id.lod)];
  return decode_octahedral({static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8)});
}

}  // namespace adamas::isosurface
