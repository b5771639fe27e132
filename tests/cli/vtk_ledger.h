#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace adamas::test {

/// Volume of a material, and the integral of a field over its region.
struct LedgerEntry {
  double volume = 0, mass = 0;
};

// By material, from what a file holds, read and added up with VTK alone; without a field of that name the
// integrals are 0.

/// A grid of adamas: sums over its cells.
std::map<std::string, LedgerEntry> grid_ledger(const std::filesystem::path& vtr, const std::string& density);
/// A cut mesh: sums over tetrahedra, in which fields are linear, or known by their means.
std::map<std::string, LedgerEntry> cut_mesh_ledger(const std::filesystem::path& vtu,
                                                   const std::string& density);

}  // namespace adamas::test
