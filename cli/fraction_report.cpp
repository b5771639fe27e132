#include "cli/fraction_report.h"

#include <utility>
#include <vector>

#include "adamas/notes.h"

namespace adamas::cli {

void print_findings(const FractionFindings& findings, const std::vector<std::string>& materials,
                    const std::string& source, Console& console) {
  if (findings.mixed_cells > 0) {
    if (findings.blur_share > 0) {
      console.print(
          "  {:.3g}% of {} mixed cells are blurred: the standard deviation of a step is {:.2f} cells in the "
          "median, {:.2f} at most\n",
          100 * findings.blur_share, findings.mixed_cells, findings.blur_median, findings.blur_greatest);
    } else {
      console.print("  {} mixed cells, of sharp interfaces\n", findings.mixed_cells);
    }
    if (findings.fraction_error > 0)
      console.print("  fractions have errors of {:.2g}% (standard deviation, estimated)\n",
                    100 * findings.fraction_error);
    console.print(
        "  {} of them differ by more than {:.2g}% from what the interfaces would give{}, at most {:.2g}%\n",
        findings.cells_off, 100 * findings.tolerance, findings.blur_share > 0 ? ", blurred alike" : "",
        100 * findings.greatest_difference);
  }
  if (findings.area_of_fractions > 0 && findings.area != findings.area_of_fractions)
    console.print("  area of interfaces {}, {} of where the greatest fraction changes\n",
                  volume_text(findings.area), difference_text(findings.area_of_fractions, findings.area));
  std::vector<std::pair<double, std::string>> dispersed;
  for (std::size_t m = 0; m < findings.dispersed.size(); ++m) {
    if (findings.dispersed[m] <= 0) continue;
    dispersed.emplace_back(
        findings.dispersed[m],
        fmt::format("{}: {} of '{}' is dispersed: no interface explains it, and the others in its cells take "
                    "its place (--keep-dispersed draws islands)",
                    source, volume_text(findings.dispersed[m]), materials[m]));
  }
  note_several(worst_first(std::move(dispersed)), {"material", "materials"}, console);
}

Figures finding_figures(const FractionFindings& findings, const std::vector<std::string>& materials) {
  Figures dispersed = Figures::array();
  for (std::size_t m = 0; m < findings.dispersed.size(); ++m) {
    if (findings.dispersed[m] > 0)
      dispersed.push_back({{"name", materials[m]}, {"volume", findings.dispersed[m]}});
  }
  return {{"blur_median", findings.blur_median},
          {"blur_greatest", findings.blur_greatest},
          {"blur_share", findings.blur_share},
          {"fraction_error", findings.fraction_error},
          {"mixed_cells", findings.mixed_cells},
          {"cells_off", findings.cells_off},
          {"tolerance", findings.tolerance},
          {"greatest_difference", findings.greatest_difference},
          {"dispersed", dispersed},
          {"area", findings.area},
          {"area_of_fractions", findings.area_of_fractions}};
}

}  // namespace adamas::cli
