#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace adamas::test {

/// The volume of a material, and the integral of a field over its region.
struct LedgerEntry {
  double volume = 0, mass = 0;
};

// Both functions read a file and add up its values with VTK alone. They return an entry for each material;
// without a field of that name the integrals are 0.

/// Returns sums over the cells of a grid that adamas wrote.
std::map<std::string, LedgerEntry> grid_ledger(const std::filesystem::path& vtr, const std::string& density);
/// Returns sums over the tetrahedra of a cut mesh, in which fields are linear or known by their means.
std::map<std::string, LedgerEntry> cut_mesh_ledger(const std::filesystem::path& vtu,
                                                   const std::string& density);

}  // namespace adamas::test
