#include "interfaces/reconstruction/label_totals.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/repeated_sum.h"
#include "interfaces/reconstruction/tetrahedron_shares.h"

namespace adamas::interfaces {

namespace {

using Index = LabelLattice::Index;
using Candidates = std::vector<CornerValues>;

/// These are the constants of close_totals().
constexpr int kMostRounds = 30;
constexpr double kFast = 0.01, kTotalTolerance = 2e-11, kMostShift = 0.1;

/// The numbers of the owners of a tetrahedron's corners in ascending order, in 16 bits each.
using Kind = std::uint64_t;

/// Returns the owners of these corners of a cell.
std::array<std::uint16_t, 4> owners_of(const std::array<std::uint16_t, 8>& numbers,
                                       const std::array<std::uint8_t, 4>& corners) {
  return {numbers[corners[0]], numbers[corners[1]], numbers[corners[2]], numbers[corners[3]]};
}

/// The volumes that materials own, and the derivatives of the volume that the first of two materials gets
/// from the second with respect to the difference of their offsets.
struct Sums {
  std::vector<double> volumes;
  std::map<std::pair<std::uint16_t, std::uint16_t>, double> growth;

  explicit Sums(std::size_t materials) : volumes(materials, 0) {}
};

/// Adds sums of parts, which measure(part, sums) computes in parallel, in the order of the parts. Of a part
/// only the materials that it has are kept until then.
template <class Measure>
void add_parts(std::size_t parts, Sums& all, Measure&& measure) {
  struct Part {
    std::vector<std::pair<std::uint16_t, double>> volumes;
    std::map<std::pair<std::uint16_t, std::uint16_t>, double> growth;
  };
  std::vector<Part> found(parts);
  parallel_for(parts, 1, [&](std::size_t p) {
    Sums sums(all.volumes.size());
    measure(p, sums);
    for (std::size_t m = 0; m < sums.volumes.size(); ++m) {
      if (sums.volumes[m] != 0) found[p].volumes.emplace_back(static_cast<std::uint16_t>(m), sums.volumes[m]);
    }
    found[p].growth = std::move(sums.growth);
  });
  for (const Part& part : found) {
    for (const auto& [m, volume] : part.volumes) all.volumes[m] += volume;
    for (const auto& [pair, by] : part.growth) all.growth[pair] += by;
  }
}

/// Adds the parts that materials own of a tetrahedron of this volume. `share(material, corner)`: the part of
/// an offset by which a value moves.
template <class Share>
void add_shares(const Candidates& candidates, double volume, bool growth, Share&& share,
                TetrahedronShares& shares, Sums& sums) {
  shares.divide(
      candidates, growth, [&](std::uint16_t number, double part) { sums.volumes[number] += volume * part; },
      [&](const CornerValues& a, const CornerValues& b, const std::array<double, 4>& found) {
        double by = 0;
        for (std::size_t c = 0; c < 4; ++c) {
          if (found[c] != 0) by += 0.5 * (share(a, c) + share(b, c)) * found[c];
        }
        if (by != 0) sums.growth[{a.number, b.number}] += volume * by;
      });
}

class LabelTotals {
 public:
  LabelTotals(const MultiMaterialData& data, LabelLattice& lattice)
      : data_(data), lattice_(lattice), lengths_(cell_lengths(lattice)) {}

  IdVector<MaterialId, double> close(const IdVector<MaterialId, double>& volumes, Progress& progress) {
    const std::size_t count = lattice_.material_count();
    const double domain = data_.grid.domain().volume();
    for (std::size_t m = 0; m < count; ++m)
      wanted_.push_back(volumes[lattice_.material(static_cast<std::uint32_t>(m))]);
    const auto n = static_cast<Eigen::Index>(count);
    Eigen::SparseMatrix<double> growth(n, n);
    Eigen::VectorXd missing = measure(&growth);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    double before = std::numeric_limits<double>::infinity();
    bool newton = true;
    for (int round = 0; count > 1 && round < kMostRounds; ++round) {
      progress.step("closing volumes", static_cast<double>(round) / kMostRounds);
      const double most = missing.lpNorm<Eigen::Infinity>();
      if (most <= kTotalTolerance * domain) break;
      if (newton) {
        const double scale = Eigen::VectorXd(growth.diagonal()).maxCoeff();
        if (!(scale > 0)) break;
        Eigen::SparseMatrix<double> identity(n, n);
        identity.setIdentity();
        solver.compute(growth + 1e-9 * scale * identity);
      }
      Eigen::VectorXd offsets = solver.solve(missing);
      offsets.array() -= offsets.mean();
      lattice_.shift({offsets.data(), count}, kMostShift * data_.grid.least_spacing());
      newton = round == 0 || most > kFast * before;
      before = most;
      missing = measure(newton ? &growth : nullptr);
    }
    IdVector<MaterialId, double> result(count, 0);
    for (std::size_t m = 0; m < count; ++m)
      result[lattice_.material(static_cast<std::uint32_t>(m))] = totals_[m];
    return result;
  }

 private:
  /// Returns the volumes that materials lack.
  Eigen::VectorXd measure(Eigen::SparseMatrix<double>* growth) {
    Sums sums =
        lattice_.has_equal_cells() ? measure_kinds(growth != nullptr) : measure_all(growth != nullptr);
    totals_ = std::move(sums.volumes);
    if (growth != nullptr) {
      std::vector<Eigen::Triplet<double>> triplets;
      for (const auto& [pair, by] : sums.growth) {
        const int a = pair.first, b = pair.second;
        triplets.emplace_back(a, a, by), triplets.emplace_back(b, b, by);
        triplets.emplace_back(a, b, -by), triplets.emplace_back(b, a, -by);
      }
      growth->setFromTriplets(triplets.begin(), triplets.end());
    }
    Eigen::VectorXd missing(static_cast<Eigen::Index>(totals_.size()));
    for (std::size_t m = 0; m < totals_.size(); ++m)
      missing[static_cast<Eigen::Index>(m)] = wanted_[m] - totals_[m];
    missing.array() -= missing.mean();
    return missing;
  }

  [[nodiscard]] double tetrahedron_volume(const Index& cell) const {
    const Vec3 size = lattice_.position({cell[0] + 1, cell[1] + 1, cell[2] + 1}) - lattice_.position(cell);
    return size.x * size.y * size.z / 6;
  }

  static std::vector<double> cell_lengths(const LabelLattice& lattice) {
    std::vector<double> lengths;
    for (std::uint32_t i = 0; i + 1 < lattice.points(0); ++i)
      lengths.push_back((lattice.position({i + 1, 0, 0}) - lattice.position({i, 0, 0})).x);
    return lengths;
  }

  /// Calls visit(cell, numbers) for the cells of a layer whose corners have several owners, and adds the
  /// volumes of others. `numbers`: those of the corners' owners.
  template <class Visit>
  void for_each_mixed(std::size_t layer, Sums& sums, Visit&& visit) const {
    Index cell{0, 0, static_cast<std::uint32_t>(layer)};
    std::array<std::uint16_t, 8> numbers{};
    for (; cell[1] + 1 < lattice_.points(1); ++cell[1]) {
      const Vec3 size =
          lattice_.position({1, cell[1] + 1, cell[2] + 1}) - lattice_.position({0, cell[1], cell[2]});
      lattice_.for_each_cell(
          cell[1], cell[2], 0, lattice_.points(0) - 1,
          [&](std::uint32_t i, const std::array<std::uint32_t, 8>& runs) {
            cell[0] = i;
            for (std::size_t c = 0; c < 8; ++c) numbers[c] = lattice_.runs().number(runs[c]);
            visit(std::as_const(cell), std::as_const(numbers));
          },
          [&](std::uint32_t begin, std::uint32_t end, std::uint16_t number) {
            double& sum = sums.volumes[number];
            sum = lengths_.add(sum, begin, end, [&](double x) { return 6 * (x * size.y * size.z / 6); });
          });
    }
  }

  /// Measures all tetrahedra, in layers whose sums are added in their order. Volumes of cells with one owner
  /// do not change: they are summed once.
  Sums measure_all(bool growth) {
    Sums all(lattice_.material_count());
    add_parts(lattice_.points(2) - 1, all, [&](std::size_t k, Sums& sums) {
      TetrahedronShares shares;
      for_each_mixed(k, sums, [&](const Index& cell, const std::array<std::uint16_t, 8>& numbers) {
        measure_cell(cell, numbers, growth, shares, sums);
      });
    });
    return all;
  }

  void measure_cell(const Index& cell, const std::array<std::uint16_t, 8>& numbers, bool growth,
                    TetrahedronShares& shares, Sums& sums) const {
    thread_local Candidates candidates;
    thread_local LabelLattice::CellMaterials materials;
    const double volume = tetrahedron_volume(cell);
    const bool plain = lattice_.is_plain(cell);
    if (!plain) lattice_.find_materials(cell, materials);
    for (std::size_t path = 0; path < MaterialLattice::kPaths.size(); ++path) {
      const auto corners = LabelLattice::cell_corners(path);
      const std::array<std::uint16_t, 4> owners = owners_of(numbers, corners);
      if (owners[0] == owners[1] && owners[1] == owners[2] && owners[2] == owners[3]) {
        sums.volumes[owners[0]] += volume;
        continue;
      }
      if (plain) {
        lattice_.find_owners(owners, candidates);
      } else {
        lattice_.find_candidates(materials, corners, owners, candidates);
      }
      add_shares(
          candidates, volume, growth,
          [&](const CornerValues& candidate, std::size_t c) {
            const std::uint32_t bits = corners[c];
            return lattice_.share({cell[0] + (bits & 1u), cell[1] + (bits >> 1 & 1u), cell[2] + (bits >> 2)},
                                  candidate.number, candidate.values[c]);
          },
          shares, sums);
    }
  }

  /// Counts the kinds of tetrahedra in cells away from the border, and lists the cells at the border.
  void count_kinds() {
    struct Layer {
      std::unordered_map<Kind, std::uint64_t> kinds;
      std::vector<std::pair<Index, std::array<std::uint16_t, 8>>> border;
    };
    const std::uint32_t layers = lattice_.points(2) - 1;
    std::vector<Layer> found(layers);
    Sums uniform(lattice_.material_count());
    add_parts(layers, uniform, [&](std::size_t k, Sums& sums) {
      KindCounts counts;
      for_each_mixed(k, sums, [&](const Index& cell, const std::array<std::uint16_t, 8>& numbers) {
        if (!lattice_.is_plain(cell)) {
          found[k].border.emplace_back(cell, numbers);
          return;
        }
        for (std::size_t path = 0; path < MaterialLattice::kPaths.size(); ++path)
          counts.add(owners_of(numbers, LabelLattice::cell_corners(path)));
      });
      found[k].kinds = std::move(counts).take();
    });
    std::map<Kind, std::uint64_t> kinds;
    for (const Layer& layer : found) {
      for (const auto& [kind, count] : layer.kinds) kinds[kind] += count;
      border_.insert(border_.end(), layer.border.begin(), layer.border.end());
    }
    uniform_ = std::move(uniform.volumes);
    kinds_.assign(kinds.begin(), kinds.end());
  }

  /// Counts kinds of tetrahedra; the kinds that are counted most are found without a table.
  class KindCounts {
   public:
    void add(std::array<std::uint16_t, 4> owners) {
      const auto order = [&](std::size_t i, std::size_t j) {
        if (owners[j] < owners[i]) std::swap(owners[i], owners[j]);
      };
      order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
      const Kind kind = Kind{owners[0]} << 48 | Kind{owners[1]} << 32 | Kind{owners[2]} << 16 | owners[3];
      Slot& slot = slots_[(kind * 0x9e3779b97f4a7c15ull) >> 56];
      if (slot.kind != kind) {
        if (slot.count > 0) counts_[slot.kind] += slot.count;
        slot = {kind, 0};
      }
      ++slot.count;
    }
    std::unordered_map<Kind, std::uint64_t> take() && {
      for (const Slot& slot : slots_) {
        if (slot.count > 0) counts_[slot.kind] += slot.count;
      }
      return std::move(counts_);
    }

   private:
    struct Slot {
      Kind kind = 0;
      std::uint64_t count = 0;
    };
    std::array<Slot, 256> slots_{};
    std::unordered_map<Kind, std::uint64_t> counts_;
  };

  Sums measure_kinds(bool growth) {
    if (uniform_.empty()) count_kinds();
    Sums sums(lattice_.material_count());
    sums.volumes = uniform_;
    TetrahedronShares shares;
    const double volume = kinds_.empty() ? 0 : tetrahedron_volume({1, 1, 1});
    Candidates candidates;
    for (const auto& [kind, count] : kinds_) {
      std::array<std::uint16_t, 4> owners{};
      for (std::size_t c = 0; c < 4; ++c)
        owners[c] = static_cast<std::uint16_t>(kind >> (16 * (3 - c)) & 0xffffu);
      const double all = volume * static_cast<double>(count);
      if (owners[0] == owners[3]) {
        sums.volumes[owners[0]] += all;
        continue;
      }
      lattice_.find_owners(owners, candidates);
      add_shares(
          candidates, all, growth, [](const auto&, std::size_t) { return 1.0; }, shares, sums);
    }
    constexpr std::size_t kChunk = 1024;
    add_parts((border_.size() + kChunk - 1) / kChunk, sums, [&](std::size_t part, Sums& found) {
      TetrahedronShares own;
      for (std::size_t n = part * kChunk; n < std::min((part + 1) * kChunk, border_.size()); ++n)
        measure_cell(border_[n].first, border_[n].second, growth, own, found);
    });
    return sums;
  }

  const MultiMaterialData& data_;
  LabelLattice& lattice_;
  AxisLengths lengths_;  ///< of cells along x
  std::vector<double> wanted_, totals_, uniform_;
  std::vector<std::pair<Kind, std::uint64_t>> kinds_;
  std::vector<std::pair<Index, std::array<std::uint16_t, 8>>> border_;
};

}  // namespace

IdVector<MaterialId, double> close_label_totals(const MultiMaterialData& data,
                                                const IdVector<MaterialId, double>& wanted,
                                                LabelLattice& lattice, Progress& progress) {
  return LabelTotals(data, lattice).close(wanted, progress);
}

}  // namespace adamas::interfaces
