#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "adamas/export.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/volume.h"

namespace adamas ADAMAS_API {

// This header writes volumes as outputs of a run: files .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr and .mhd with
// a .raw beside them, or .raw alone. Planes are written one after another, so that a volume need not fit in
// memory.

/// Declares the file of a volume and, where its samples go to another file, that one. Throws Error (kUsage)
/// as OutputSet::declare does; messages call the option -o.
void declare_volume_output(const std::filesystem::path& output, OutputSet& outputs);

/// Receives the numbers of the next plane with equal k, in the machine's byte order.
using PlaneSink = std::function<void(std::span<const std::byte>)>;

/// Notes the properties of a grid that the format of the output, one file or a list .pvd of files .vti, does
/// not keep: the places of samples and their scale.
void note_lost(const std::filesystem::path& output, const VolumeGrid& grid, Progress& progress);

/// Returns the type of the numbers in a file, `numbers`, or kFloat32 where the format does not keep their
/// scale, so that values are written in their place.
StoredType written_type(const std::filesystem::path& output, const VolumeGrid& grid, StoredType numbers);

/// Writes the declared files. `numbers`: the type of the numbers of planes. `array`: their name in a .vti.
/// `make` is called once, and gives the planes to its sink in ascending order. Returns the number of bytes
/// written. Throws Error where the files cannot be written in full.
std::size_t write_volume_output(const std::filesystem::path& output, const VolumeGrid& grid,
                                StoredType numbers, const std::string& array,
                                const std::function<void(const PlaneSink&)>& make, OutputSet& outputs);

}  // namespace adamas
