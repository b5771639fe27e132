#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/generate.h"
#include "adamas/geometry.h"
#include "adamas/output_folder.h"
#include "adamas/picture.h"
#include "adamas/progress.h"
#include "adamas/read_input.h"
#include "adamas/resample.h"
#include "adamas/resample_series.h"
#include "adamas/series.h"

namespace adamas ADAMAS_API {

/// Options of an experiment: an input is resampled, and pictures, curves and a report show what comes of it.
struct ExperimentOptions {
  InputOptions input{};  ///< the input, unless one is generated; for a series, how each step is read
  /// The steps of a series; empty: the input is one data set. The last step that can be read is the input of
  /// everything but the section on the series.
  std::vector<SeriesEntry> steps{};
  std::string series_name{};  ///< the name of the series in titles
  std::optional<GeneratedData> generate{};
  ResampleOptions resampling{};
  std::string title{};  ///< the heading of the report; empty: the input's name
  /// The field in slices and tables, "NAME:x" for a component; empty: slices show the materials.
  std::string field{};
  std::string density{};        ///< the field whose integral is mass, as in ResampleSeriesOptions
  std::vector<Plane> planes{};  ///< the planes of slices
  /// A part of the first plane that is shown enlarged too: a0, a1, b0, b1 in the plane's coordinates.
  std::optional<std::array<double, 4>> detail{};
  /// Interface errors of the curve of error against tetrahedra; empty: 8, 4, 2 and 1 times the interface
  /// error of `resampling`.
  std::vector<ErrorTarget> curve{};
  DrawingOptions drawing{};  ///< how pictures of interfaces are drawn
  SeriesFilmOptions film{};  ///< the film of a series, a file in the folder; its plane and field are not used
  std::string published_by{};  ///< the source of the published figures
  /// Published figures that are set beside those of the experiment: "interface tetrahedra", "tetrahedra",
  /// "tetrahedra with fields", "greatest field error at interfaces", "mean field error at interfaces" or
  /// "triangles A | B" for two materials.
  std::vector<std::pair<std::string, double>> published{};

  /// Throws Error (kUsage) for options that do not go together.
  void check() const;
};

/// Errors of one field over the tetrahedra that were split, made monotone in two ways (docs/method.md,
/// Errors).
struct NestedFieldErrors {
  double greatest = 0, mean = 0;                      ///< the tightest bounds of errors of descendants
  double corrected_greatest = 0, corrected_mean = 0;  ///< bounds by vertex corrections (D 3.1)
  std::size_t tetrahedra = 0;
  std::size_t undefined = 0;  ///< tetrahedra without a correction
};

/// One run of resampling within an experiment.
struct ExperimentRun {
  ResampleReport report;
  std::vector<NestedFieldErrors> nested;  ///< errors of each field; empty where the mesh was not kept
  double seconds = 0;                     ///< duration of refinement (wall clock)
  double processor_seconds = 0;           ///< of refinement, of all threads together
};

/// A picture of an experiment: a file in its folder, and what it shows.
struct ExperimentPicture {
  std::string file, caption;
};

/// A figure that was published, and that of the experiment; NaN where the experiment has none.
struct PublishedFigure {
  std::string name;
  double published = 0, here = 0;
};

/// Everything that an experiment found.
struct ExperimentRecord {
  std::string title;
  std::string input;  ///< what was resampled, in words
  std::vector<FieldRange> fields;
  std::size_t shown = 0;  ///< the number of the field in slices and tables, where there are fields
  /// Numbers of triangles of the input's interfaces, by "A | B".
  std::vector<std::pair<std::string, std::size_t>> triangles;
  ExperimentRun interfaces;  ///< the run that refined for interfaces alone
  /// The run that refined for fields too, where that was asked for.
  std::optional<ExperimentRun> with_fields;
  std::vector<ExperimentRun> curve;      ///< runs that refined for interfaces alone, from coarse to fine
  bool curve_is_given = false;           ///< whether the errors of the curve were asked for
  std::vector<MaterialBalance> balance;  ///< volumes and masses, by material
  std::string density;                   ///< the field whose integral is mass; empty: there is none
  std::string published_by;
  std::vector<PublishedFigure> published;
  std::optional<ResampledSeries> series;  ///< the resampled series, where the input is one
  std::string film;                       ///< its file in the folder; empty: there is none
  /// Pictures of the input, of the mesh, of slices and of the series. The curves of error against tetrahedra
  /// lie beside them.
  std::vector<ExperimentPicture> input_pictures, mesh_pictures, slices, series_pictures;

  /// Returns the run that refined for all that was asked for.
  [[nodiscard]] const ExperimentRun& last() const { return with_fields ? *with_fields : interfaces; }
  /// Returns the runs whose errors were asked for, by name: without those of a curve of default errors, and
  /// without the steps of a series.
  [[nodiscard]] std::vector<std::pair<std::string, const ExperimentRun*>> wanted_runs() const;
};

/// Makes an experiment: writes meshes (.vtu, .vtp), pictures (.png, .svg, .html), of a series mesh.pvd with
/// its meshes and series.csv, and report.html, which shows all of it, into the folder. The caller may add
/// files, and commits the folder. Throws Error as ExperimentOptions::check(), read_input(), resample() and
/// resample_series() do, for a plane that does not cut the domain, and for fields and materials that the
/// input does not have.
ExperimentRecord run_experiment(const ExperimentOptions& options, const OutputFolder& folder,
                                Progress& progress = SilentProgress::instance());

}  // namespace adamas
