#include "isosurface/compression/gradients/gradient_codec.h"

#include <algorithm>

#include "core/base/error.h"
#include "isosurface/compression/byte_stream.h"

namespace adamas::isosurface {
namespace {

using Bytes = SampleCodec<std::uint8_t>::Samples;
using BytesAround = SampleCodec<std::uint8_t>::Around;

/// One byte of the codes of a page and of those round it.
struct ComponentPage {
  BytesAround around;
  Bytes own;

  static void take(std::size_t component, std::span<const std::uint16_t> from, std::span<std::uint8_t> to) {
    std::ranges::transform(from, to.begin(), [component](std::uint16_t code) {
      return static_cast<std::uint8_t>(code >> 8 * component);
    });
  }

  /// Copies the codes round a page; does nothing for a complete page, for which the caller may have filled
  /// none.
  void take_around(std::size_t component, const PageShape& shape, const GradientCodesAround& codes) {
    if (!shape.complete) take(component, codes, around);
  }
};

}  // namespace

std::vector<std::byte> GradientCodec::tables() const {
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  for (const auto& component : components_) out.sized_bytes(component->tables());
  return bytes;
}

GradientCodec GradientCodec::parse(SampleCoding coding, std::span<const std::byte> tables,
                                   std::string_view name) {
  ByteReader in(tables);
  Components components;
  for (auto& component : components) {
    const auto part = in.sized_bytes();
    if (!in.good()) fail("{}: expected the tables of two components of gradients, found fewer", name);
    component = parse_sample_codec<std::uint8_t>(coding, part, name);
  }
  if (!in.rest().empty()) fail("{}: expected the end after the tables of gradients, found more data", name);
  return GradientCodec(std::move(components));
}

void GradientCodec::encode(const PageShape& shape, const GradientCodesAround& around,
                           const GradientCodes& codes, std::vector<std::byte>& out) const {
  ComponentPage page;
  std::vector<std::byte> part;
  for (std::size_t c = 0; c < kComponents; ++c) {
    page.take_around(c, shape, around);
    page.take(c, codes, page.own);
    part.clear();
    components_[c]->encode(shape, page.around, page.own, part);
    if (c + 1 < kComponents) {
      ByteWriter(out).sized_bytes(part);
    } else {
      ByteWriter(out).bytes(part);
    }
  }
}

bool GradientCodec::decode(std::span<const std::byte> bytes, const PageShape& shape,
                           const GradientCodesAround& around, GradientCodes& codes) const {
  ByteReader in(bytes);
  ComponentPage page;
  for (std::size_t c = 0; c < kComponents; ++c) {
    const auto part = c + 1 < kComponents ? in.sized_bytes() : in.rest();
    page.take_around(c, shape, around);
    page.own.fill(0);
    if (!in.good() || !components_[c]->decode(part, shape, page.around, page.own)) return false;
    for (std::size_t n = 0; n < codes.size(); ++n) {
      const auto before = c > 0 ? static_cast<unsigned>(codes[n]) : 0u;
      codes[n] = static_cast<std::uint16_t>(before | static_cast<unsigned>(page.own[n]) << 8 * c);
    }
  }
  return true;
}

GradientSurvey::GradientSurvey(SampleCoding coding) {
  for (auto& component : components_) component = sample_survey<std::uint8_t>(coding);
}

void GradientSurvey::add(const PageShape& shape, const GradientCodesAround& around,
                         const GradientCodes& codes) {
  ComponentPage page;
  for (std::size_t c = 0; c < components_.size(); ++c) {
    page.take_around(c, shape, around);
    page.take(c, codes, page.own);
    components_[c]->add(shape, page.around, page.own);
  }
}

void GradientSurvey::merge(const GradientSurvey& other) {
  for (std::size_t c = 0; c < components_.size(); ++c) components_[c]->merge(*other.components_[c]);
}

GradientCodec GradientSurvey::codec() const {
  GradientCodec::Components components;
  for (std::size_t c = 0; c < components.size(); ++c) components[c] = components_[c]->codec();
  return GradientCodec(std::move(components));
}

}  // namespace adamas::isosurface
