#include "interfaces/comparison/reference_mesher.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "interfaces/comparison/region_naming.h"

namespace adamas::interfaces {

namespace {

MesherRequest request_of(const PiecewiseLinearComplex& complex, MesherKind kind) {
  // Region 0 is the outside.
  const auto region = [](BodyId body) { return body.valid() ? body.value + 1 : 0u; };
  MesherRequest request;
  request.kind = kind;
  request.points = complex.points;
  for (const auto& t : complex.triangles) {
    request.triangles.push_back(t.points);
    request.triangle_patches.push_back(t.patch);
  }
  for (const auto& patch : complex.patches)
    request.patch_regions.push_back({region(patch.front), region(patch.back)});
  return request;
}

/// Returns the fault of a reply, which is not trusted: numbers out of range or points that are not finite;
/// empty if there is none.
std::string fault_of(const MesherReply& reply, std::size_t patches) {
  const auto in_range = [&](const auto& cells) {
    return std::all_of(cells.begin(), cells.end(), [&](const auto& cell) {
      return std::all_of(cell.begin(), cell.end(), [&](std::uint32_t p) { return p < reply.points.size(); });
    });
  };
  const bool finite = std::all_of(reply.points.begin(), reply.points.end(), is_finite);
  if (!finite) return "made points that are not finite";
  if (!in_range(reply.tetrahedra) || !in_range(reply.triangles))
    return "made cells of points that are not there";
  if (!reply.regions.empty() && reply.regions.size() != reply.tetrahedra.size())
    return "made tetrahedra without regions";
  if (reply.triangle_patches.size() != reply.triangles.size() ||
      std::any_of(reply.triangle_patches.begin(), reply.triangle_patches.end(),
                  [&](std::uint32_t patch) { return patch >= patches; }))
    return "made triangles of patches that are not there";
  return "";
}

/// Orients all tetrahedra positively.
void orient(MesherReply& reply) {
  for (auto& cell : reply.tetrahedra) {
    const auto& p = reply.points;
    if (signed_volume(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]) < 0) std::swap(cell[2], cell[3]);
  }
}

/// Requests a mesh. Returns the reply if it can be used; otherwise sets the failure of `result`.
std::optional<MesherReply> ask_for_reply(const MesherRequest& request, const MesherOptions& options,
                                         const Progress& progress, ReferenceResult& result) {
  auto answer = ask_program<MesherReply>(options.program, request, options.limits, progress);
  std::optional<MesherReply>& reply = answer.reply;
  if (!reply) {
    result.failure = answer.failure;
    result.crashed = answer.crashed;
    return std::nullopt;
  }
  result.failure = reply->failure.empty() ? fault_of(*reply, request.patch_regions.size()) : reply->failure;
  result.seconds = reply->seconds;
  result.peak_memory_bytes = static_cast<std::size_t>(reply->peak_memory_bytes);
  if (!result.failure.empty()) return std::nullopt;
  orient(*reply);
  result.mesh.points = std::move(reply->points);
  result.mesh.tetrahedra = std::move(reply->tetrahedra);
  return reply;
}

/// Sets the bodies of tetrahedra from their regions, which must be among the known ones.
void take_regions(const MesherReply& reply, std::vector<std::uint32_t> known, ReferenceResult& result) {
  std::sort(known.begin(), known.end());
  for (const std::uint32_t region : reply.regions) {
    if (region == 0 || !std::binary_search(known.begin(), known.end(), region)) {
      result.failure = "made tetrahedra outside of all regions";
      return;
    }
    result.mesh.bodies.emplace_back(region - 1);
  }
}

ReferenceResult ask(const MesherRequest& request, const PiecewiseLinearComplex& complex,
                    const MesherOptions& options, const Progress& progress) {
  ReferenceResult result;
  const auto reply = ask_for_reply(request, options, progress, result);
  if (!reply) return result;
  if (reply->regions.empty()) {
    result.failure = name_regions(complex, result.mesh.tetrahedra, reply->triangles, reply->triangle_patches,
                                  result.mesh.bodies);
    return result;
  }
  std::vector<std::uint32_t> known;
  for (const auto& sides : request.patch_regions) known.insert(known.end(), sides.begin(), sides.end());
  take_regions(*reply, std::move(known), result);
  return result;
}

}  // namespace

ReferenceResult mesh_by_tetgen(const PiecewiseLinearComplex& complex, const std::string& switches,
                               const MesherOptions& options, const Progress& progress) {
  MesherRequest request = request_of(complex, MesherKind::kTetGen);
  request.switches = switches;
  ReferenceResult result = ask(request, complex, options, progress);
  if (!result.crashed) return result;
  request.kind = MesherKind::kTetGenDiagnosis;
  request.switches = "zpdQ";
  const ReferenceResult diagnosis = ask(request, complex, options, progress);
  // If it crashes again, it has no message.
  if (!diagnosis.crashed) result.failure += "; " + diagnosis.failure;
  return result;
}

ReferenceResult mesh_by_mesh3(const PiecewiseLinearComplex& complex, const Mesh3Criteria& criteria,
                              const MesherOptions& options, const Progress& progress) {
  MesherRequest request = request_of(complex, MesherKind::kMesh3);
  request.criteria = criteria;
  return ask(request, complex, options, progress);
}

ReferenceResult mesh_by_mesh3(const LabelImage& image, const Mesh3Criteria& criteria,
                              const MesherOptions& options, const Progress& progress) {
  MesherRequest request;
  request.kind = MesherKind::kMesh3Labels;
  request.criteria = criteria;
  request.image = image;
  ReferenceResult result;
  const auto reply = ask_for_reply(request, options, progress, result);
  if (!reply) return result;
  if (reply->regions.empty()) {
    result.failure = "made tetrahedra without regions";
    return result;
  }
  std::vector<std::uint32_t> known;
  for (const std::uint16_t label : image.labels) known.push_back(label + 1u);
  take_regions(*reply, std::move(known), result);
  return result;
}

}  // namespace adamas::interfaces
