#pragma once

#include <string>
#include <vector>

#include "adamas/input.h"
#include "adamas/probe.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Volumes of the materials and integrals of their fields, in the input or in a mesh. The integral of a
/// density is mass.
struct Ledger {
  std::string subject;  ///< whose volumes these are: "input", "mesh", "cut mesh"
  std::vector<MaterialTotals> materials;
};

/// The components of a field from `first` on, as a number, or as a list of the numbers of a vector; a number
/// that is not finite is written as null.
Figures component_figures(const std::vector<double>& values, std::size_t first, int count);

/// Returns a row for each ledger and material, for `--json`.
Figures ledger_figures(const std::vector<Ledger>& ledgers, const std::vector<FieldDescription>& fields);
/// Returns the ledgers as CSV; values that a material does not have are empty.
std::string ledger_csv(const std::vector<Ledger>& ledgers, const std::vector<FieldDescription>& fields);

}  // namespace adamas::cli
