#include "cli/verify_by.h"

#include <nlohmann/json.hpp>

#include "adamas/report_text.h"
#include "adamas/verify.h"

namespace adamas::cli {

namespace {

/// The width of the verdict's bounds, relative to the interface error wanted.
constexpr double kPrecision = 0.01;

}  // namespace

void check_verifier(const std::string& name) {
  if (!name.empty()) find_reference_program("--verify-by");
}

void verify_interface_error(const AdaptiveMesh& mesh, const InterfaceTriangles& shown, Figures& figures,
                            Console& console) {
  const ResampleReport& report = mesh.report();
  VerifyOptions options;
  options.domain = mesh.domain();
  const CgalVerdict verdict = verify_by_cgal(mesh.input_interfaces(), shown,
                                             kPrecision * report.interface_error_target, options, console);
  figures["interface_error_by_cgal"] = {
      {"lower", verdict.lower}, {"upper", verdict.upper}, {"seconds", verdict.seconds}};
  const std::string by_cgal = length_text(verdict.lower) + " to " + length_text(verdict.upper);
  if (!report.interface_error) return console.print("\n  interface error by CGAL: {}\n", by_cgal);
  const MeasuredDistance& ours = *report.interface_error;
  console.print("\n  interface error {} (certified), CGAL: {}\n", length_text(ours.certified), by_cgal);
  if (ours.certified < verdict.lower || ours.found > verdict.upper)
    console.note_incomplete("the interface error is {} to {}, and by CGAL {}: they contradict each other",
                            length_text(ours.found), length_text(ours.certified), by_cgal);
}

}  // namespace adamas::cli
