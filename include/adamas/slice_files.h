#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/export.h"
#include "adamas/fractions.h"
#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/read_input.h"
#include "adamas/series.h"
#include "adamas/steps.h"
#include "adamas/volume_input.h"

namespace adamas ADAMAS_API {

/// The sections that a picture of a slice shows side by side.
enum class SliceSections : std::uint8_t {
  kDefault,    ///< the input for data, the fields of each material for a mesh
  kInput,      ///< the input as it is
  kPlain,      ///< for a mesh: plain linear interpolation of the field
  kMaterials,  ///< for a mesh: the fields of each material
  kAll,        ///< all that there are
};

/// Options that say which files are cut by a plane, and how the slice is shown.
struct SliceRequest {
  /// Data on a grid, a resampled mesh (.vtu), a saved hierarchy, interfaces, a volume or a store; or a series
  /// of them: several files, a pattern of names, or a list (.pvd). Empty: the main file of `input`.
  std::vector<std::string> inputs{};
  InputOptions input{};        ///< how data on a grid and given interfaces are read
  VolumeInput volume{};        ///< how a volume is read; its path is that of the input
  std::string original{};      ///< of a mesh: the data or the network that it was resampled from, or a series
  bool smooth_labels = false;  ///< smooth the interfaces of labels
  FractionOptions fractions{};  ///< of interfaces reconstructed from fractions

  Plane plane{};
  std::string field{};  ///< "NAME", "NAME:C" for component C, or "NAME:x"; empty: the materials
  SliceSections sections = SliceSections::kDefault;
  /// The number of one step of a series, from 0 on; none: all steps of a series of files; for a store or a
  /// file with several times those of `steps`, or the first.
  std::optional<std::uint64_t> step{};
  std::optional<StepRange> steps{};  ///< steps of a series; none: see `step`
  bool gradients = false;            ///< of a store: the directions of the gradients as colours

  // The options below say how pictures are drawn.
  std::optional<std::array<double, 2>> range{};  ///< the values at the ends of the colour map
  std::string colour_map{};                      ///< its name; empty: sequential
  double width = 1600, greatest_height = 1400;   ///< sizes in pixels
  /// Draw the cells; none: those of a mesh, and those of its input if they are wide.
  std::optional<bool> cells{};
  bool interfaces = true;              ///< draw the interfaces
  std::optional<double> frame_rate{};  ///< steps per second of a film; none: 10
};

/// The areas of materials in a section.
struct SliceAreas {
  double area = 0;  ///< area of all materials, in the square of the unit of length
  /// The names and areas of the materials, by number; none where the samples have no materials.
  std::vector<std::pair<std::string, double>> materials;
  bool plain = false;      ///< the data have no materials
  std::size_t pieces = 0;  ///< convex polygons
};

/// One step of a series and the areas of its section.
struct SlicedStep {
  std::size_t number = 0;  ///< its number in the whole series, from 0 on
  double time = 0;
  std::string file;
  SliceAreas areas;
};

/// The result of write_slice().
struct SliceReport {
  bool is_series = false;
  /// The areas of the last section, for an input that is no series; none for gradients.
  std::optional<SliceAreas> areas{};
  std::vector<SlicedStep> steps{};      ///< of a series: those that were drawn
  std::vector<LeftOutStep> left_out{};  ///< of a series: steps that cannot be read
  /// Of a series: the least and the greatest value that the colours stand for.
  std::optional<std::array<double, 2>> range{};
  /// The part of the pixels without gradient, in a picture of gradients.
  std::optional<double> part_without_gradient{};
};

/// Returns the steps of the series that the input of a request is: several files, a pattern or a list, a
/// stored series, or a file with several times. `step` and `steps` are not read. Throws Error (kUsage), in
/// the name of
/// --steps, where the input is no series.
std::vector<SeriesEntry> slice_steps(const SliceRequest& request);

/// Cuts files by a plane and returns the section, of a series that of `step`: what write_slice() writes as
/// polygons. How pictures are drawn is not read. Throws Error (kUsage) for options that do not go together
/// and for `sections` that are several, and Error where an input cannot be used or the plane does not cut it.
Slice slice(const SliceRequest& request, Progress& progress = SilentProgress::instance());

/// Cuts files by a plane and writes what is cut to `output`: a picture (.png, .svg, .pdf) or polygons (.vtp);
/// of a series a film (.mp4, .webm, .gif), a pattern of pictures as S_%04d.png, or a list of polygons (.pvd),
/// with one scale of colours. The output is declared and written in `outputs`, and committed by the caller;
/// inputs are protected there. Throws Error (kUsage) for options that do not go together, and Error where an
/// input cannot be used or the plane does not cut it.
SliceReport write_slice(const SliceRequest& request, const std::filesystem::path& output, OutputSet& outputs,
                        Progress& progress = SilentProgress::instance());

}  // namespace adamas
