#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace adamas::interfaces {

/// A linear system for the volumes of materials in cells. It is a sparse matrix in which each exchange
/// between two materials of a cell is stored once.
struct VolumeSystem {
  /// The rows of the two volumes, and the range of the unknowns' coefficients.
  struct Exchange {
    std::uint32_t gains, loses, first, count;
  };
  struct Coefficient {
    std::uint32_t unknown;
    float by;
  };
  /// The equations of a group of cells.
  struct Block {
    std::vector<Exchange> exchanges;
    std::vector<Coefficient> coefficients;
    std::uint32_t first_row = 0, last_row = 0;  ///< the range of its cells' rows
    std::size_t cells_off = 0;

    /// Empties the block for cells with these rows.
    void clear(std::uint32_t first, std::uint32_t last) {
      exchanges.clear(), coefficients.clear();
      first_row = first, last_row = last, cells_off = 0;
    }
  };
  std::vector<Block> blocks;
  std::vector<double> missing;  ///< missing volumes, by row, as parts of cells

  /// The cost of a missing volume: its square if it is small; larger ones grow more slowly (Huber 1964), so
  /// that a cell whose volumes cannot be reached does not spoil the cells round it.
  [[nodiscard]] static double cost_of(double missing);

  [[nodiscard]] std::size_t cells_off() const;
  /// Returns the cost to be minimised: the sum of cost_of() over all rows.
  [[nodiscard]] double cost() const;
  /// Returns approximately the shortest move of the unknowns that gives the missing volumes. `damping`: by
  /// unknown, above 0. The normal equations are solved by conjugate gradients; rows that miss much have less
  /// weight, as in cost(). The equations are damped and the iteration stops early, so that unknowns on which
  /// volumes hardly depend do not oscillate. Throws Cancelled (LoopProgress).
  [[nodiscard]] std::vector<double> solve(const std::vector<double>& damping) const;

 private:
  [[nodiscard]] std::vector<double> preconditioner(const std::vector<double>& weight,
                                                   const std::vector<double>& damping) const;
  static void add_gains(const Block& block, const std::vector<double>& move, std::vector<double>& rows);
  static void add_gradients(const Block& block, const std::vector<double>& rows,
                            std::vector<double>& gradient);
};

}  // namespace adamas::interfaces
