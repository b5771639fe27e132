#include "isosurface/storage/stored_pages.h"

#include <algorithm>

#include "isosurface/storage/byte_stream.h"

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
StoredPages<Word>::StoredPages(StoreFile& file, std::uint32_t step, std::size_t memory, PageParts parts)
    : file_(file),
      step_(step),
      samples_(parse_sample_codec<Word>(file.header().coding, file.header().sample_tables, file.name())),
      tree_(file.grid(), parts, memory / sizeof(Page<Word>),
            [this](const PageId& id, const PageShape& shape, const Surroundings<Word>& around,
                   Page<Word>& page) { return load(id, shape, around, page); }) {
  if (parts == PageParts::kAll)
    values_ = ValueCodec<Word>::parse(file.header().value_tables, file.header().grid.spacing, file.name());
}

template <class Word>
bool StoredPages<Word>::load(const PageId& id, const PageShape& shape, const Surroundings<Word>& around,
                             Page<Word>& page) {
  last_damaged_ = id;
  if (std::find(damaged_.begin(), damaged_.end(), id) != damaged_.end()) return false;
  const StoreFile::Payload payload = file_.read(step_, id);
  PagePayload parts;
  if (payload.state == PageState::kDamaged || !split_payload(payload.bytes, parts) ||
      !samples_->decode(parts.samples, shape, around.samples, page.samples) ||
      (values_ && !values_->decode(parts.values, shape, around, page))) {
    damaged_.push_back(id);
    return false;
  }
  copies_ += payload.state == PageState::kCopied ? 1 : 0;
  return true;
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
