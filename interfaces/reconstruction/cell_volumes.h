#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/data/rectilinear_grid.h"
#include "core/geometry/partition.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas {

/// The volumes of materials in the cell of one site after another, exactly, and how they depend on the values
/// at the sites round it. Materials are those that have a value at the site, by their place there.
class CellVolumes {
 public:
  CellVolumes(const RectilinearGrid& grid, const SiteValues& values, const SiteCells& cells);

  /// How much the first of two materials gains of the second when its values at the neighbours of the site
  /// grow; the second gains as much when its own do.
  struct Pair {
    std::size_t first, second;
    std::array<double, SiteCell::kNeighbours> growth;
  };

  /// Looks up the values round a site.
  void go_to(std::size_t site);
  /// The site's value of a material, here alone.
  double& own(std::size_t m) { return round_[m][SiteCell::kSelf]; }
  /// The volumes as parts of the cell's; with `growth` pairs() are found too.
  const std::vector<double>& measure(bool growth = false);
  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  /// The site that is the n-th neighbour, if it is one.
  [[nodiscard]] std::optional<std::size_t> neighbour(std::size_t n) const;

 private:
  using Values = std::array<double, 4>;
  /// A tetrahedron in a part, and its volume in relation to it.
  struct Piece {
    std::array<Weights, 4> corners;
    double volume;
  };

  template <class Visit>
  void for_each_border(Visit&& visit) const;
  void extend();
  void fold(std::array<double, SiteCell::kNeighbours>& round) const;
  [[nodiscard]] double border_step(int axis, bool high) const;
  void measure_part(const SiteCell::Part& part);
  void share_between_two(const SiteCell::Part& part, std::size_t m, std::size_t n);
  void share_between_all(const SiteCell::Part& part);
  void keep_positive(const Values& function);
  void add_growth(const SiteCell::Part& part, std::size_t m, std::size_t n, const Values& growth);
  [[nodiscard]] Values at_corners(const SiteCell::Part& part, std::size_t m) const {
    const auto& row = at_nodes_[m];
    return {row[part.nodes[0]], row[part.nodes[1]], row[part.nodes[2]], row[part.nodes[3]]};
  }

  const RectilinearGrid& grid_;
  const SiteValues& values_;
  const SiteCells& cells_;
  std::array<std::int64_t, 3> sites_, place_{};
  const SiteCell* cell_ = nullptr;
  SiteCell scratch_;
  std::size_t count_ = 0;
  bool at_border_ = false, with_growth_ = false;
  std::vector<std::array<double, SiteCell::kNeighbours>> round_;  // by material
  std::vector<std::array<bool, SiteCell::kNeighbours>> settled_;  // the same, of the nearest site
  std::vector<std::vector<double>> at_nodes_;
  std::vector<double> volumes_;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> contenders_;
  std::vector<Piece> pieces_, kept_;
};

}  // namespace adamas
