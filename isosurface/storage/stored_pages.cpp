#include "isosurface/storage/stored_pages.h"

#include <algorithm>

#include "isosurface/compression/byte_stream.h"

namespace adamas {

std::vector<std::byte> join_payload(const PagePayload& parts) {
  std::vector<std::byte> bytes;
  bytes.reserve(parts.samples.size() + parts.values.size() + parts.gradients.size() + 8);
  ByteWriter out(bytes);
  out.sized_bytes(parts.samples);
  out.sized_bytes(parts.values);
  out.bytes(parts.gradients);
  return bytes;
}

bool split_payload(std::span<const std::byte> bytes, PagePayload& parts) {
  ByteReader in(bytes);
  parts.samples = in.sized_bytes();
  parts.values = in.sized_bytes();
  parts.gradients = in.rest();
  return in.good();
}

template <class Word>
StoredPages<Word>::StoredPages(StoreFile& file, std::uint32_t step, std::size_t memory)
    : file_(file),
      step_(step),
      sample_codec_(parse_sample_codec<Word>(file.header().coding, file.header().sample_tables, file.name())),
      tree_(file.grid(), memory,
            [this](const PageId& id, const PageShape& shape, const Surroundings<Word>& around,
                   PageParts parts, PageSamples<Word>& samples,
                   PageBounds<Word>* values) { return load(id, shape, around, parts, samples, values); }) {}

template <class Word>
bool StoredPages<Word>::load(const PageId& id, const PageShape& shape, const Surroundings<Word>& around,
                             PageParts parts, PageSamples<Word>& samples, PageBounds<Word>* values) {
  last_damaged_ = id;
  if (std::find(damaged_.begin(), damaged_.end(), id) != damaged_.end()) return false;
  const StoreFile::Payload payload = file_.read(step_, id);
  if (payload.state == PageState::kDamaged || !decode(payload.bytes, shape, around, parts, samples, values)) {
    damaged_.push_back(id);
    return false;
  }
  if (has_part(parts, PageParts::kSamples)) copies_ += payload.state == PageState::kCopied ? 1 : 0;
  return true;
}

template <class Word>
bool StoredPages<Word>::decode(std::span<const std::byte> payload, const PageShape& shape,
                               const Surroundings<Word>& around, PageParts wanted, PageSamples<Word>& samples,
                               PageBounds<Word>* values) {
  PagePayload parts;
  if (!split_payload(payload, parts)) return false;
  if (has_part(wanted, PageParts::kSamples) &&
      !sample_codec_->decode(parts.samples, shape, around.samples, samples.samples))
    return false;
  if (values == nullptr) return true;
  if (!bounds_codec_) {
    const StoreHeader& header = file_.header();
    bounds_codec_ = BoundsCodec<Word>::parse(header.bounds_tables, header.grid.spacing, file_.name());
  }
  return bounds_codec_->decode(parts.values, shape, around, samples, *values);
}

template <class Word>
PageCounts StoredPages<Word>::counts() const {
  return {tree_.loaded() - tree_.loaded_as_predictors(), tree_.loaded_as_predictors(), file_.bytes_read(),
          copies_, damaged_.size()};
}

template class StoredPages<std::uint8_t>;
template class StoredPages<std::uint16_t>;
template class StoredPages<std::uint32_t>;

}  // namespace adamas
