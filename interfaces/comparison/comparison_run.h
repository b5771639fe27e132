#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/comparison/box_stitching.h"
#include "interfaces/comparison/comparison.h"
#include "interfaces/comparison/own_mesh.h"
#include "interfaces/comparison/sizing_search.h"

namespace adamas::interfaces {

/// Makes a comparison, row by row.
class Comparison {
 public:
  Comparison(const ResamplingSource& source, const ComparisonOptions& options, Progress& progress)
      : source_(source), options_(options), progress_(progress) {}

  std::vector<ComparedMesh> run();

 private:
  /// Returns the distance of a row that is matched to that of the resampled mesh of its group.
  static double matched_distance(const ComparedMesh& row, const OwnMesh& own);
  /// Adds a row and sets whether its distance matches that of the resampled mesh.
  void finish(ComparedMesh row, const OwnMesh& own);
  void start_clock() { started_ = std::chrono::steady_clock::now(); }
  [[nodiscard]] double seconds_left() const;
  /// Returns the options of meshers, limited to the time that is left for the present mesh.
  [[nodiscard]] MesherOptions mesher() const;
  void stitch_input();
  [[nodiscard]] PiecewiseLinearComplex stitch(std::span<const Vec3> points,
                                              std::span<const BodyTriangle> triangles) const;
  ReferenceResult run_tetgen(const PiecewiseLinearComplex& complex, ComparedMesh& row);
  void add_tetgen(const PiecewiseLinearComplex& complex, const OwnMesh& own, ComparedMesh& row);
  void add_untouched(const OwnMesh& own);
  void add_resampled(const OwnMesh& own);
  void add_simplified(const OwnMesh& own);
  void add_mesh3(const OwnMesh& own);
  void add_mesh3_simplified(const OwnMesh& own);
  void add_mesh3_labels(const OwnMesh& own);
  /// Simplifies and stitches the input's interfaces; `note` gets the number of remaining triangles.
  [[nodiscard]] PiecewiseLinearComplex simplified_input(double error, std::string& note);
  [[nodiscard]] ReferenceResult mesh_labels(const Mesh3Criteria& sizes) const;
  /// The trial of Mesh_3 that came closest.
  struct Mesh3Match {
    ComparedMesh row;
    Mesh3Criteria criteria;
    ReferenceResult result;
    double mismatch = 0;
    std::size_t trials = 0;
    bool over = false;  ///< whether the time limit ended the search
  };
  using Mesher = std::function<ReferenceResult(const Mesh3Criteria&)>;
  void match_mesh3(const OwnMesh& own, const Mesher& make, Mesh3Match& match);
  SizingTrial try_mesh3(const OwnMesh& own, double facet_distance, const Mesher& make, Mesh3Match& match);
  void add_optimised(const OwnMesh& own, const Mesh3Match& match);
  void measure(const ReferenceResult& result, double target, ComparedMesh& row);
  /// Measures the figures that trials of sizes leave out: the condition number and the errors of fields.
  void measure_chosen(const ReferenceResult& result, const OwnMesh& own, ComparedMesh& row);
  [[nodiscard]] std::string lost_materials(const MeshFigures& figures) const;
  [[nodiscard]] Mesh3Criteria criteria(double facet_distance) const;

  const ResamplingSource& source_;
  const ComparisonOptions& options_;
  Progress& progress_;
  std::vector<ComparedMesh> rows_;
  std::optional<PiecewiseLinearComplex> input_;
  std::string input_fault_;
  /// The start of the work on the present mesh of another generator.
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace adamas::interfaces
