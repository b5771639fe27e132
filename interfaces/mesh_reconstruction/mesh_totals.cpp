#include "interfaces/mesh_reconstruction/mesh_totals.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace adamas::interfaces {

namespace {

using Index = MeshSubdivision::Index;
using Entry = MeshValues::Entry;

/// Totals are closed up to this part of the domain, in at most so many rounds.
constexpr double kTolerance = 2e-11;
constexpr int kMostRounds = 30;
/// A value moves by at most this part of a cell's size in a round.
constexpr double kMostMove = 0.2;

/// What two materials exchange, by their first numbers, by derivatives with respect to the difference of
/// their offsets.
using Exchanges = std::map<std::pair<std::uint16_t, std::uint16_t>, double>;

/// Returns the offsets, by material, that give materials with interfaces the volumes that are missing, to
/// first order; none where there is no interface. Materials without interfaces have the offset 0.
std::vector<double> find_offsets(const Exchanges& exchanged, const std::vector<double>& missing) {
  std::vector<int> unknown(missing.size(), -1);
  double greatest = 0;
  for (const auto& [pair, by] : exchanged) {
    unknown[pair.first] = unknown[pair.second] = 0;
    greatest = std::max(greatest, by);
  }
  if (!(greatest > 0)) return {};
  int size = 0;
  for (int& of_one : unknown) of_one = of_one == 0 ? size++ : -1;
  Eigen::VectorXd right(size);
  for (std::size_t m = 0; m < missing.size(); ++m) {
    if (unknown[m] >= 0) right[unknown[m]] = missing[m];
  }
  right.array() -= right.mean();
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& [pair, by] : exchanged) {
    const int a = unknown[pair.first], b = unknown[pair.second];
    triplets.emplace_back(a, a, by), triplets.emplace_back(b, b, by);
    triplets.emplace_back(a, b, -by), triplets.emplace_back(b, a, -by);
  }
  for (int m = 0; m < size; ++m) triplets.emplace_back(m, m, 1e-9 * greatest);
  Eigen::SparseMatrix<double> growth(size, size);
  growth.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(growth);
  Eigen::VectorXd solution = solver.solve(right);
  solution.array() -= solution.mean();
  std::vector<double> offsets(missing.size(), 0);
  for (std::size_t m = 0; m < missing.size(); ++m) {
    if (unknown[m] >= 0) offsets[m] = solution[unknown[m]];
  }
  return offsets;
}

}  // namespace

IdVector<MaterialId, double> close_totals(const MeshData& data, const IdVector<MaterialId, double>& wanted,
                                          MeshValues& values, MeshVolumes& volumes, Progress& progress) {
  const std::size_t count = values.material_count();
  const PolyhedralMesh& mesh = data.mesh;
  const std::vector<Index>& active = values.active_cells();
  double domain = 0;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) domain += mesh.cell_volume(c);
  std::vector<char> is_active(mesh.cell_count(), 0);
  for (const Index c : active) is_active[c] = 1;
  std::vector<double> sole(count, 0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    if (is_active[c] == 0) sole[values.whole(values.sole(c))] += mesh.cell_volume(c);
  }
  for (int round = 0;; ++round) {
    progress.step("closing volumes", static_cast<double>(round) / kMostRounds);
    values.interpolate();
    volumes.measure(true);
    std::vector<double> owned = sole, missing(count);
    Exchanges exchanged;
    for (std::size_t n = 0; n < active.size(); ++n) {
      const double volume = mesh.cell_volume(active[n]);
      const std::span<const Entry> own = std::as_const(values).at(active[n]);
      for (std::size_t e = 0; e < own.size(); ++e)
        owned[values.whole(own[e].material)] += volume * volumes.parts(n)[e];
      for (const auto& exchange : volumes.exchanges(n)) {
        const std::uint16_t a = values.whole(exchange.first), b = values.whole(exchange.second);
        if (a != b) exchanged[{std::min(a, b), std::max(a, b)}] += volume * exchange.growth;
      }
    }
    IdVector<MaterialId, double> result(wanted.size());
    double most_missing = 0;
    for (std::uint16_t m = 0; m < count; ++m) {
      if (values.whole(m) != m) continue;
      result[values.material(m)] = owned[m];
      missing[m] = wanted[values.material(m)] - owned[m];
      most_missing = std::max(most_missing, std::abs(missing[m]));
    }
    if (most_missing <= kTolerance * domain || round == kMostRounds) return result;
    const std::vector<double> offsets = find_offsets(exchanged, missing);
    if (offsets.empty()) return result;
    for (const Index c : active) {
      const double most = kMostMove * values.size(c);
      for (Entry& entry : values.at(c))
        entry.value += std::clamp(offsets[values.whole(entry.material)], -most, most);
    }
  }
}

}  // namespace adamas::interfaces
