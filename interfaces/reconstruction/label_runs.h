#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"

namespace adamas::interfaces {

/// The labels of a grid as runs: a run is a longest row of sites along x with one label. Two runs of one
/// label are joined if an edge of the lattice's tetrahedra (MaterialLattice) connects them: from one site to
/// another one that has the same or the next index along each axis. Runs are numbered in the order of their
/// sites, so that memory follows the surface between labels.
class LabelRuns {
 public:
  /// `numbers`: the number of each label in the order of names. Throws Error if there are too many runs.
  LabelRuns(const MultiMaterialData& data, const std::vector<std::uint16_t>& numbers);

  [[nodiscard]] std::size_t size() const { return starts_.size(); }
  /// Returns the first run of a row of sites, rows counted along y and then along z; for the number of rows,
  /// the number of runs.
  [[nodiscard]] std::uint32_t first_of_row(std::size_t row) const { return rows_[row]; }
  /// Returns the index along x of a run's first site.
  [[nodiscard]] std::uint32_t start(std::uint32_t run) const { return starts_[run]; }
  [[nodiscard]] std::uint16_t number(std::uint32_t run) const { return numbers_[run]; }
  /// Returns the run that holds the i-th site of a row.
  [[nodiscard]] std::uint32_t find(std::size_t i, std::size_t row) const;
  /// Returns the run that represents each run's connected runs: the first of them.
  [[nodiscard]] std::vector<std::uint32_t> roots() const;

 private:
  std::array<std::size_t, 3> n_;
  std::vector<std::uint32_t> rows_, starts_;
  std::vector<std::uint16_t> numbers_;
};

}  // namespace adamas::interfaces
