#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/output_folder.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/volume.h"
#include "adamas/volume_input.h"
#include "adamas/volume_store.h"

namespace adamas ADAMAS_API {

// This header makes stores (VolumeStore) of files, and files of stores. Outputs are declared and written in
// an OutputSet, and get their names when it is committed.

/// Options that say what a store is made of.
struct StoreRequest {
  /// A volume, or the steps of a series, as of find_volume_steps().
  std::vector<std::string> inputs;
  VolumeInput input{};  ///< options for reading each input; its path is not used
  BuildOptions options{};
  std::filesystem::path output;  ///< the store (.adm)
  /// Add steps behind the last one of the output, if it exists. If the steps have times of their own, only
  /// the later ones are added; others are taken to be behind the last one.
  bool append = false;
  /// Receives the number of steps that were added to a store for good, and the number of steps to add; it is
  /// called also before an Error is thrown.
  std::function<void(std::uint32_t added, std::size_t wanted)> added{};
};

/// The result of store_files().
struct StoreReport {
  VolumeGrid grid;
  /// Number of steps that were stored; 0, which only `append` allows: nothing was done.
  std::size_t steps = 0;
  std::uint64_t steps_before = 0;  ///< number of steps that the store had before
  std::uint64_t bytes_before = 0;  ///< size of the file up to the end of these
  std::uint64_t input_bytes = 0;   ///< bytes of the samples in the input's files
  BuildReport stored{};
  StoredType numbers = StoredType::kUint8;  ///< the type of the numbers that samples are read from
  /// The name of the first step's array, or of the group of all; empty where the file has none.
  std::string array;
  /// The number of samples that are no finite numbers, by the number of the step among those stored.
  std::map<std::uint32_t, std::uint64_t> infinite_samples;

  /// Returns the number of bytes of the file that this call has added.
  [[nodiscard]] std::uint64_t added_bytes() const { return stored.file_bytes - bytes_before; }
};

/// Makes a store of files, step after step, or adds them to a store at once. Needs 1 GiB of memory and 64
/// bytes for each sample of a plane. Notes tell of numbers that were converted, of samples that are not
/// finite and of times that were assumed. Throws Error, with the file's name, where an input cannot be used
/// or has another grid than the first; Error (kUsage) for options that contradict each other or the store.
StoreReport store_files(const StoreRequest& request, OutputSet& outputs,
                        Progress& progress = SilentProgress::instance());

/// Options that say what is restored of a store, and to which files.
struct RestoreRequest {
  std::filesystem::path store;
  OpenOptions open{};
  VolumePart part{};
  /// The number of one step, from 0 on. Without it, a series (.pvd, .zarr) gets all steps, and a single
  /// volume the first one, which a note says where there are several.
  std::optional<std::uint64_t> step{};
  std::optional<StepRange> steps{};  ///< the steps of a series that are restored; none: all
  /// The output: a volume .vti, .nrrd, .mha, .nii, .nii.gz, .nhdr or .mhd with a .raw beside it, or .raw
  /// alone; for a series also .pvd, with a .vti of each step beside it; or a folder .zarr with volumes and
  /// series and their coarser LODs, as OME-Zarr 0.4.
  std::filesystem::path output;
  /// Replace an existing folder .zarr, or existing files of the steps of a .pvd.
  bool overwrite = false;
};

/// The result of restore_files().
struct RestoreReport {
  VolumeGrid grid;                          ///< the grid of each step, at the finest LOD
  StoredType written = StoredType::kUint8;  ///< the type that numbers or values were written with
  int lod = 0;                              ///< the finest LOD
  std::size_t lods = 1;                     ///< number of LODs that were written to a .zarr
  std::vector<std::uint32_t> steps;         ///< the steps that were written, ascending
  /// The steps that were left out since they are damaged, ascending.
  std::vector<std::uint32_t> damaged_steps;
  std::uint64_t bytes = 0;  ///< size of all files
  PageReads reads{};
  /// The folder .zarr, which gets its name when it is committed; null for other outputs.
  std::shared_ptr<OutputFolder> folder;
};

/// Returns whether a name is that of a folder F.zarr, also with a slash behind it.
bool is_zarr(const std::filesystem::path& path);

/// Restores samples, bit for bit; where the format has no scale, their values as float32. Damaged steps of
/// several are left out, with a note. Throws Error where there is nothing to restore, a page of a single step
/// is damaged, or files exist already; Error (kUsage) for options that contradict each other, unknown steps,
/// and outputs of another format.
RestoreReport restore_files(const RestoreRequest& request, OutputSet& outputs,
                            Progress& progress = SilentProgress::instance());

}  // namespace adamas
