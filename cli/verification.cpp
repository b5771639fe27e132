#include "cli/verification.h"

#include <nlohmann/json.hpp>

#include "adamas/verify.h"
#include "core/data/interface_mesh.h"
#include "interfaces/network/network_mesh.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

/// The verdict is as narrow as this part of the interface error wanted.
constexpr double kPrecision = 0.01;

}  // namespace

void check_verifier(const std::string& name) {
  if (!name.empty()) find_reference_program("--verify-by");
}

void verify_interface_error(const std::string& name, const Resampler& resampler, Figures& figures,
                            Console& console) {
  if (name.empty()) return;
  const ResamplingSource& source = resampler.source();
  const InterfaceTriangles input =
      to_interface_triangles(network_mesh(*source.network, source.materials, source.name));
  const InterfaceTriangles shown = to_interface_triangles(approximated_interfaces(resampler, console));
  VerifyOptions options;
  options.domain = source.box;
  const CgalVerdict verdict =
      verify_by_cgal(input, shown, kPrecision * resampler.options().interface_error, options, console);
  figures["interface_error_by_cgal"] = {
      {"lower", verdict.lower}, {"upper", verdict.upper}, {"seconds", verdict.seconds}};
  const std::string by_cgal = length_text(verdict.lower) + " to " + length_text(verdict.upper);
  const auto& certificate = resampler.certificate();
  if (!certificate) return console.print("\n  interface error by CGAL: {}\n", by_cgal);
  const InterfaceDistance& ours = certificate->networks;
  console.print("\n  interface error {} (certified), CGAL: {}\n", length_text(ours.upper), by_cgal);
  if (ours.upper < verdict.lower || ours.lower > verdict.upper)
    console.note_incomplete("the interface error is {} to {}, and by CGAL {}: they contradict each other",
                            length_text(ours.lower), length_text(ours.upper), by_cgal);
}

}  // namespace adamas::cli
