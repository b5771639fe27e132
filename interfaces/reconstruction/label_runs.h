#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/data/multi_material_data.h"

namespace adamas::interfaces {

/// The labels of a grid as runs: a run is a longest row of sites along x with one label. Two runs of one
/// label are joined if an edge of the lattice's tetrahedra (MaterialLattice) connects them: from one site to
/// another one that has the same or the next index along each axis. Runs are numbered in the order of their
/// sites, so that memory follows the surface between labels. They stay when the data are gone.
class LabelRuns {
 public:
  /// `numbers`: the number of each label in the order of names. Throws Error if there are too many runs.
  LabelRuns(const MultiMaterialData& data, std::vector<std::uint16_t> numbers);

  [[nodiscard]] std::size_t size() const { return rows_->starts.size(); }
  /// Returns the first run of a row of sites, rows counted along y and then along z; for the number of rows,
  /// the number of runs.
  [[nodiscard]] std::uint32_t first_of_row(std::size_t row) const { return rows_->first[row]; }
  /// Returns the index along x of a run's first site.
  [[nodiscard]] std::uint32_t start(std::uint32_t run) const { return rows_->starts[run]; }
  /// Returns the index behind a run's last site along x; `behind`: the first run of the next row.
  [[nodiscard]] std::uint32_t end(std::uint32_t run, std::uint32_t behind) const {
    return run + 1 < behind ? rows_->starts[run + 1] : static_cast<std::uint32_t>(n_[0]);
  }
  [[nodiscard]] std::uint16_t number(std::uint32_t run) const { return numbers_[rows_->labels[run]]; }
  /// Returns the run that holds the i-th site of a row.
  [[nodiscard]] std::uint32_t find(std::size_t i, std::size_t row) const { return rows_->find(i, row); }
  /// Finds the numbers of the labels of sites of a row from the i-th on.
  void read(std::size_t i, std::size_t row, std::span<std::uint16_t> found) const;
  /// Returns the run that represents each run's connected runs: the first of them.
  [[nodiscard]] std::vector<std::uint32_t> roots() const;

 private:
  std::array<std::size_t, 3> n_;
  std::shared_ptr<const LabelRows> rows_;
  std::vector<std::uint16_t> numbers_;  ///< by label
};

}  // namespace adamas::interfaces
