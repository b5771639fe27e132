#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/nrrd_header.h"
#include "core/io/volume_source.h"

namespace adamas {

VolumeSource nrrd_source(std::string_view text, const std::filesystem::path& path) {
  VolumeSource source;
  source.name = path.string();
  const NrrdHeader header = parse_nrrd_header(text, source.name);
  if (header.encoding == NrrdEncoding::kGzip) source.coding = SamplePacking::kDeflate;
  if (header.encoding == NrrdEncoding::kBzip2) source.coding = SamplePacking::kBzip2;
  if (header.encoding == NrrdEncoding::kText) source.coding = SamplePacking::kText;
  if (header.components != 1) {
    fail("{}: expected one value per sample, found {}", source.name, header.components);
  }
  source.file = path;
  if (!header.data_file.empty()) {
    source.file = path.parent_path() / header.data_file;
    source.name += ": " + source.file.string();
  } else if (header.header_bytes >= kLongestHeader) {
    fail("{}: expected a header of less than {} bytes, found a longer one", source.name, kLongestHeader);
  }
  source.skip_lines = header.line_skip;
  // From the end one can count only where it is in sight.
  source.at_end = header.byte_skip < 0 && !source.packed();
  if (header.byte_skip > 0) source.skip_bytes = static_cast<std::uint64_t>(header.byte_skip);
  if (header.data_file.empty()) source.header_bytes = header.header_bytes;
  source.set_stored(find_stored_type(header.type).value());
  source.big_endian = header.big_endian;
  for (std::size_t axis = 0; axis < 3; ++axis) source.grid.dimensions[axis] = header.sizes[axis];
  source.grid.space = header.space;
  source.set_axes(header.axes);
  return source;
}

}  // namespace adamas
