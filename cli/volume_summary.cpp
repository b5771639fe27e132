#include "cli/volume_summary.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/grid_summary.h"
#include "cli/volume_places.h"
#include "core/io/file_summary.h"
#include "core/io/input_file.h"
#include "core/io/nifti_header.h"
#include "isosurface/volume/samples.h"

namespace adamas {

namespace {

/// Least and greatest finite sample.
void set_range(VolumeReader& reader, ArraySummary& array, Progress& progress) {
  std::vector<std::byte> plane(reader.grid().plane_bytes());
  array.min = std::numeric_limits<double>::infinity();
  array.max = -array.min;
  const std::uint64_t planes = reader.grid().dimensions[2];
  for (std::uint64_t k = 0; k < planes; ++k) {
    progress.step("reading", static_cast<double>(k) / static_cast<double>(planes));
    reader.read_plane(k, plane);
    with_sample_type(reader.grid().type, [&](auto sample) {
      for (std::size_t at = 0; at < plane.size(); at += sizeof(sample)) {
        std::memcpy(&sample, plane.data() + at, sizeof(sample));
        const auto value = static_cast<double>(sample);
        if (!std::isfinite(value)) continue;
        array.min = std::min(array.min, value);
        array.max = std::max(array.max, value);
      }
    });
  }
}

}  // namespace

Figures print_volume(VolumeReader reader, const std::string& path, Session& session) {
  const VolumeGrid& grid = reader.grid();
  FileSummary summary;
  summary.kind = file_extension(path).starts_with(".nii") ? "NIfTI" : "volume";
  summary.points = summary.cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    summary.nodes[axis] = grid.dimensions[axis];
    summary.points *= grid.dimensions[axis];
    summary.cells *= grid.dimensions[axis] - 1;
  }
  summary.box = grid.box();
  summary.directions = grid.directions;
  summary.origin = grid.origin;
  summary.space = grid.space;
  summary.arrays.push_back({file_stem(path), stored_name(reader.source().stored), "points", 1, 0, 0});
  set_range(reader, summary.arrays.front(), session.console);
  Figures figures{{"file", path}, {"kind", summary.kind}};
  session.console.print("{}: {}\n", path, summary.kind);
  print_grid(summary, session.console, figures);
  add_places(grid, figures);
  print_arrays(summary, session.console, figures);
  if (const std::string note = reader.note(); !note.empty()) session.console.note("{}", note);
  return figures;
}

std::optional<VolumeReader> find_volume(const InputOptions& input, VolumeInput volume, Session& session) {
  const std::string path = input.path, extension = file_extension(path);
  const auto is = [&extension](const char* one) { return extension == one; };
  volume.path = path;
  if (!volume.option().empty() || is(".h5") || is(".hdf5") || is(".he5"))
    return open_volume_input(volume, session);
  if (!input.grid_option().empty()) return {};
  const bool pair = is(".hdr") || is(".hdr.gz") || is(".img") || is(".img.gz");
  // Pictures of high dynamic range end in .hdr too.
  if (pair && !read_beginning(path).starts_with("#?")) return open_volume_input(volume, session);
  if (!(is(".nii") || is(".nii.gz"))) return {};
  // One of colours is no volume.
  if (!NiftiHeader::parse(read_nifti_header(path), path).type()) return {};
  return open_volume_input(volume, session);
}

}  // namespace adamas
