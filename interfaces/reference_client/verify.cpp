#include "adamas/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "adamas/geometry.h"
#include "adamas/text.h"
#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "interfaces/reference_client/child_program.h"
#include "interfaces/reference_client/program_messages.h"

namespace adamas {

using namespace interfaces;

namespace {

constexpr const char* kProgram = "adamas-reference";
constexpr const char* kVariable = "ADAMAS_REFERENCE_PROGRAM";

/// Throws Error if a triangle has a point that does not exist or a coordinate is not finite.
void check(const InterfaceTriangles& interfaces) {
  for (const auto& [a, b, c] : interfaces.triangles) {
    const std::uint32_t greatest = std::max({a, b, c});
    if (greatest >= interfaces.points.size())
      fail("interfaces: expected triangles of {} points, found one of point {}", interfaces.points.size(),
           greatest);
  }
  for (const Vec3& p : interfaces.points) {
    if (!is_finite(p)) fail("interfaces: expected points that are finite, found ({}, {}, {})", p.x, p.y, p.z);
  }
}

Box3 box_of(const InterfaceTriangles& a, const InterfaceTriangles& b) {
  Box3 box;
  for (const InterfaceTriangles* interfaces : {&a, &b}) {
    for (const Vec3& p : interfaces->points) box.extend(p);
  }
  return box;
}

}  // namespace

std::string CgalVerdict::text() const { return length_text(lower) + " to " + length_text(upper); }

std::optional<std::string> CgalVerdict::contradiction(double found, double certified) const {
  const bool is_contradiction = certified < lower || found > upper;
  if (!is_contradiction) return {};
  return fmt::format("the interface error is {} to {}, and by CGAL {}: they contradict each other",
                     length_text(found), length_text(certified), text());
}

CgalVerdict verify_by_cgal(const InterfaceTriangles& a, const InterfaceTriangles& b, double bound,
                           const VerifyOptions& options, Progress& progress) {
  if (!(bound > 0)) fail("expected a bound of the distance that is positive, found {}", bound);
  check(a), check(b);
  if (a.triangles.empty() && b.triangles.empty()) return {};
  const Stopwatch watch;
  const Box3 box = options.domain ? *options.domain : box_of(a, b);
  const DistanceRequest request{
      {{{a.points, a.triangles}, {b.points, b.triangles}}}, bound, box.min, box.max};
  progress.step("measuring interfaces by CGAL", -1);
  const auto answer = ask_program<DistanceReply>(find_own_program(kProgram, kVariable), request,
                                                 {options.seconds, 0, options.memory_bytes}, progress);
  if (!answer.reply) fail("{} {}", kProgram, answer.failure);
  if (!answer.reply->failure.empty()) fail("{}: {}", kProgram, answer.reply->failure);
  CgalVerdict verdict{answer.reply->lower, answer.reply->upper, 0, 0};
  if (!(verdict.lower >= 0 && verdict.lower <= verdict.upper))
    fail("{} gave the distance as {} to {}", kProgram, verdict.lower, verdict.upper);
  verdict.seconds = watch.seconds();
  verdict.processor_seconds = watch.processor_seconds();
  return verdict;
}

std::filesystem::path find_reference_program(const std::string& purpose) {
  if (!ADAMAS_WITH_REFERENCE)
    fail("{}: this build is without adamas-reference (ADAMAS_WITH_REFERENCE=OFF)", purpose);
  return find_own_program(kProgram, kVariable);
}

void set_reference_program(const std::filesystem::path& program) { set_own_program(kProgram, program); }

}  // namespace adamas
