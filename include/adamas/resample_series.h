#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/material_colours.h"
#include "adamas/output_set.h"
#include "adamas/probe.h"
#include "adamas/progress.h"
#include "adamas/read_input.h"
#include "adamas/resample.h"
#include "adamas/series.h"
#include "adamas/steps.h"
#include "adamas/text_table.h"

namespace adamas ADAMAS_API {

/// Options of a film of the meshes of a series in a plane; the program ffmpeg makes it.
struct SeriesFilmOptions {
  std::filesystem::path file{};  ///< .mp4, .webm or .gif; empty: there is no film
  std::optional<Plane> plane{};  ///< the plane, which a film needs; it must cut the domain
  std::string field{};  ///< the field that is shown, "NAME:x" for a component; empty: the materials are shown
  std::optional<double> frames_per_second{};  ///< none: 10
};

/// Options that say how a series is resampled, and which files are written meanwhile.
struct ResampleSeriesOptions {
  InputOptions input{};  ///< how each step is read; its `path` is replaced by the step's file
  ResampleOptions resampling{};
  std::string name{};  ///< the name of the series in titles
  /// The scalar field whose integral is mass; empty: a field called density in any letter case, if there is
  /// one.
  std::string density{};
  /// The list F.pvd of the meshes, which lie beside it as F_0000.vtu, F_0001.vtu, ..., or a pattern of their
  /// names alone, F_%04d.vtu; empty: no meshes are written.
  std::filesystem::path meshes{};
  SeriesFilmOptions film{};
};

/// A field and the range of its values in the input; for vectors, the range of their lengths.
struct FieldRange {
  std::string name, unit;
  int components = 1;
  double min = 0, max = 0;
};

/// The volume of a material and, where there is a density, its mass, in the input and in a mesh.
struct MaterialBalance {
  std::string material;
  double volume_input = 0, volume_mesh = 0;  ///< in the cube of the unit of length
  double mass_input = 0, mass_mesh = 0;      ///< NaN where the material has no density
};

/// A step of a series and its mesh.
struct ResampledStep {
  SeriesEntry entry;       ///< its time and its file
  std::size_t number = 0;  ///< its number in the whole series
  ResampleReport report;
  std::vector<FieldRange> fields;
  std::vector<MaterialTotals> totals_input, totals_mesh;  ///< by material
  std::vector<MaterialBalance> balance;                   ///< by material
  std::optional<Adaptation> adaptation;  ///< none for a mesh that was refined from the coarsest one
  double seconds = 0;                    ///< of refinement, by the clock
  double processor_seconds = 0;          ///< of refinement, of all threads together
};

/// The result of resample_series().
struct ResampledSeries {
  std::vector<FieldRange> fields;  ///< the fields of the first step
  std::string density;             ///< the field whose integral is mass; empty: there is none
  std::vector<ResampledStep> steps;
  std::vector<LeftOutStep> left_out;
  MaterialColours colours;  ///< those that files of steps have for materials, the first one that has any
};

/// Resamples the steps of a series of data on one grid, each from the mesh of the step before, which takes
/// less time and gives the same meshes as single runs. Colours of materials that a step's files have are
/// those of that step and all later ones, in meshes, film and curves. Declares the meshes and the film and
/// writes them into `outputs`, which the caller commits; the steps' files are protected from being
/// overwritten. Steps that are damaged are left out. Notes begin with the step's file. Throws Error as
/// read_input() and resample() do, where a step has another grid, other materials or other fields than the
/// first one, and where no step can be read; Error (kUsage) for options that do not go together.
ResampledSeries resample_series(const std::vector<SeriesEntry>& steps, const ResampleSeriesOptions& options,
                                OutputSet& outputs, Progress& progress = SilentProgress::instance());

/// Returns two tables over time: sizes and errors, and differences of volumes and masses between the mesh and
/// the input. There must be at least one step.
std::vector<TextTable> series_tables(const ResampledSeries& series);

/// Returns errors, volumes and masses over time as comma-separated values: a line for each step, with all
/// digits. There must be at least one step.
std::string series_csv(const ResampledSeries& series);

/// Writes errors, volumes and masses over time: series_csv() for a .csv file, or curves side by side as .png,
/// .svg or .pdf.
void write_series_curves(const std::filesystem::path& path, const ResampledSeries& series);

}  // namespace adamas
