#include "core/io/volume_import.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/io/volume_unpacking.h"

namespace adamas::io {

namespace {

/// The volume as a source without its samples. Throws Error if a file of that size cannot hold them.
VolumeSource checked_source(const ReaderRequest& request, const ImportedVolume& volume) {
  const std::string& name = request.name;
  VolumeSource source;
  source.name = name;
  if (volume.stored > StoredType::kFloat64) fail("{}: expected a type of numbers, found none", name);
  source.set_stored(volume.stored);
  source.grid.dimensions = volume.dimensions;
  source.grid.spacing = volume.spacing;
  source.grid.origin = volume.origin;
  source.grid.directions = volume.directions;
  source.grid.check(name);
  if (source.sample_file_bytes() / kGreatestExpansion > request.input_bytes)
    fail("{}: expected {}, found a file of {}", name, source.size_text(), request.input_bytes);
  return source;
}

}  // namespace

void ImportSink::begin(const ImportedVolume& volume, const std::string& array, const std::string& remark) {
  checked_source(request_, volume);
  bytes_.put(volume);
  bytes_.put(array);
  bytes_.put(remark);
}

VolumeSource import_volume(const ReaderRequest& request, const VolumeOptions& options, Progress& progress) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  VolumeSource result;
  read_in_child(request, [&](ByteSource& bytes) {
    VolumeSource source = checked_source(request, bytes.get<ImportedVolume>());
    source.array = bytes.get<std::string>();
    source.remark = bytes.get<std::string>();
    SampleSink sink(source, FileHandle::scratch(options.scratch_folder), progress);
    std::vector<std::byte> piece;
    while (sink.found() < sink.expected()) {
      piece.resize(static_cast<std::size_t>(std::min(kPiece, sink.expected() - sink.found())));
      bytes.read(piece.data(), piece.size());
      sink.take(piece);
    }
    result = sink.finish();
  });
  return result;
}

}  // namespace adamas::io
