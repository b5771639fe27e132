#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace adamas::interfaces {

/// How volumes of materials in cells depend on unknowns, for small moves: sparse, and each exchange between
/// two materials of a cell is there once for both.
struct LinearSystem {
  /// The rows of the two volumes, and the coefficients of the unknowns.
  struct Exchange {
    std::uint32_t gains, loses, first, count;
  };
  struct Coefficient {
    std::uint32_t unknown;
    float by;
  };
  /// The equations of a number of cells.
  struct Block {
    std::vector<Exchange> exchanges;
    std::vector<Coefficient> coefficients;
    std::uint32_t first_row = 0, last_row = 0;  ///< its cells' rows, without the last
    std::size_t cells_off = 0;
  };
  std::vector<Block> blocks;
  std::vector<double> missing;  ///< by row

  [[nodiscard]] std::size_t cells_off() const;
  /// The cost that is to become least: the sum of cost_of() over all rows.
  [[nodiscard]] double cost() const;
  /// The shortest move of the unknowns that gives what is missing, nearly: conjugate gradients for the normal
  /// equations, in which rows that miss much weigh less, as cost() has it; damped and stopped early, so that
  /// unknowns do not swing on which volumes hardly depend.
  [[nodiscard]] std::vector<double> solve(const std::vector<double>& damping) const;

 private:
  [[nodiscard]] std::vector<double> preconditioner(const std::vector<double>& weight,
                                                   const std::vector<double>& damping) const;
  static void add_gains(const Block& block, const std::vector<double>& move, std::vector<double>& rows);
  static void add_gradients(const Block& block, const std::vector<double>& rows,
                            std::vector<double>& gradient);
};

/// The cost of what is missing in a row: its square while that is small, from there on growing less (Huber
/// 1964), so that a cell whose volumes cannot be had does not spoil those round it.
double cost_of(double missing);

}  // namespace adamas::interfaces
