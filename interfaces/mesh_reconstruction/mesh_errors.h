#pragma once

#include <cstddef>
#include <vector>

#include "interfaces/mesh_reconstruction/mesh_films.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// Errors of the fractions of a mesh, by the values from which correction starts (docs/blurred_fractions.md,
/// Errors of fractions): the quadrics are those through the neighbours of cells in a mesh.
class MeshErrors {
 public:
  /// `widths`, `extents`: of steps (Steps). Cells of films count as without errors: no surface alone predicts
  /// their fractions. All arguments must outlive this object.
  MeshErrors(const std::vector<double>& widths, const std::vector<double>& extents, const MeshFilms& films,
             const MeshValues& values);

  /// Returns the standard deviation of errors, estimated; 0 where too few cells can be predicted. `width`:
  /// the median width of steps.
  [[nodiscard]] double deviation(double width) const;
  /// Smooths values and fractions of mixed entries by surfaces through their neighbours, as far as errors of
  /// this size allow.
  void smooth(double deviation, MeshValues& values) const;
  /// Replaces numbers, by entry of active cells, at steps that have a width by their means with those round
  /// them, which count the more the nearer they are to the cell and to the interface.
  void take_means(std::vector<double>& numbers) const;

 private:
  using Index = MeshSubdivision::Index;
  struct Prediction;
  struct Place {
    std::size_t n;            ///< of the cell among active ones
    std::array<double, 3> x;  ///< from the cell that is looked at, in cells
    double squared;
  };

  void find_places(std::size_t n, std::vector<Place>& places) const;
  [[nodiscard]] Prediction predict(std::size_t n, std::size_t e, const std::vector<Place>& places) const;
  [[nodiscard]] double part_behind(Index cell, const Vec3& towards, double distance) const;
  [[nodiscard]] double width_of(std::size_t n, std::size_t e) const;
  [[nodiscard]] bool has_no_third(std::size_t n, std::size_t other) const;

  [[nodiscard]] bool is_examined(Index cell) const;

  const std::vector<double>&widths_, &extents_;
  const MeshFilms& films_;
  const MeshValues& values_;
  std::vector<std::size_t> firsts_;      // by active cell: its first entry
  std::vector<std::uint32_t> of_cells_;  // by cell: its number among active ones, or kNone
  std::vector<std::array<double, 6>>
      moments_;  // by active cell: the second ones about the centre, per volume
};

}  // namespace adamas::interfaces
