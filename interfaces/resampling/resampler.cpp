#include "interfaces/resampling/resampler.h"

#include <algorithm>

#include "core/base/loop_progress.h"
#include "core/base/release_memory.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/resampling/cell_evaluation.h"
#include "interfaces/resampling/certification.h"
#include "interfaces/resampling/conservation.h"
#include "interfaces/resampling/field_measurement.h"
#include "interfaces/resampling/refinement.h"

namespace adamas::interfaces {

namespace {

/// Makes volumes agree, as far as the options want it, without measuring distances.
void make_volumes_agree(ResamplingState& state, VolumeRefinement& volumes) {
  if (!state.options.conserve) return;
  volumes.alternate([&] { Conservation(state).conserve(); }, [] {});
}

}  // namespace

void Resampler::refine() {
  const LoopProgress loops(state_.progress);
  Refinement refinement(state_);
  evaluate_roots(state_);
  refinement.refine_to_targets(state_.leaves());
  refine_further(refinement);
}

void Resampler::refine(MeshHierarchy from) {
  const Domain &own = state_.hierarchy.domain(), &other = from.domain();
  if (other.roots() != own.roots() || other.box().min != own.box().min || other.box().max != own.box().max)
    fail("{}: expected the domain of the mesh that is adapted, found another one", state_.source.name);
  if (state_.options.max_tetrahedra) return refine();
  const LoopProgress loops(state_.progress);
  Refinement refinement(state_);
  state_.hierarchy = std::move(from);
  state_.hierarchy.reset_payloads();
  evaluate_roots(state_);
  adaptation_ = adapt_hierarchy(state_, refinement);
  refine_further(refinement);
}

/// Continues after all estimates of the interfaces are within their targets: certification, volumes and
/// fields.
void Resampler::refine_further(Refinement& refinement) {
  VolumeRefinement volumes(state_, refinement);
  std::optional<Certification> certification;
  const bool has_interfaces = !state_.source.network->triangles().empty();
  const auto finish_interfaces = [&] {
    if (!has_interfaces) return;
    if (!state_.options.certify) {
      volumes.refine();
      return;
    }
    if (!certification) certification.emplace(state_, refinement, volumes);
    interface_end_ = certification->run();
  };
  finish_interfaces();
  if (state_.source.fields) {
    refinement.include_fields();
    const auto wanted = [](const std::optional<double>& target) { return target.has_value(); };
    if (std::any_of(state_.options.field_errors.begin(), state_.options.field_errors.end(), wanted)) {
      measure_fields(state_, state_.leaves(), DisplacedErrors::kWithinTargets);
      const std::size_t before = state_.hierarchy.leaf_count();
      refinement.refine_to_targets(state_.leaves());
      if (state_.hierarchy.leaf_count() != before) finish_interfaces();
    }
  }
  if (certification) {
    interface_end_ = certification->conserve();
  } else if (has_interfaces) {
    make_volumes_agree(state_, volumes);
  }
  // Errors of elements near an interface depend on the neighbouring cells.
  if (state_.source.fields) measure_fields(state_, state_.leaves(), DisplacedErrors::kLeast);
  complete_estimates(state_);
  find_contacts(state_, state_.leaves());
  if (certification) {
    certificate_ = certification->certificate();
    body_report_ = certification->body_report();
  }
  volume_goals_ = volumes.goals();
  volume_ends_ = volumes.ends();
}

std::vector<double> Resampler::row(VertexId v, BodyId body) const { return row_at(state_, v, body); }

std::span<const std::uint32_t> Resampler::elements(TetrahedronId t) const { return elements_in(state_, t); }

BodyId Resampler::owner_at(const Vec3& p) const {
  const TetrahedronId leaf = leaf_at(p);
  CellOwnership owners;
  ownership(leaf, owners);
  if (owners.pure()) return BodyId(owners.problem.candidates[0].owner);
  return BodyId(owners.problem.owner(frame(leaf).weights(p)));
}

ExtractedInterfaces approximated_interfaces(const Resampler& resampler, Progress& progress) {
  const ResamplingSource& source = resampler.source();
  ExtractedInterfaces found =
      extract_interfaces(source.network->table(), resampler.cells(), source.box, progress);
  found.mesh.materials = source.materials;
  found.mesh.source = source.name;
  return found;
}

ResampledMesh resampled_mesh(const Resampler& resampler) {
  const auto& hierarchy = resampler.hierarchy();
  const ResamplingSource& source = resampler.source();
  ResampledMesh mesh;
  mesh.source = source.name;
  mesh.box = source.box;
  mesh.materials = source.materials;
  mesh.table = source.network->table();
  if (source.fields) mesh.fields = source.fields->fields();
  mesh.field_errors.resize(mesh.fields.size());

  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> number(hierarchy.vertex_slots(), kUnused);
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const CellRecord& record = hierarchy.payload(t);
    ResampledMesh::Cell cell{{},
                             static_cast<std::uint8_t>(hierarchy.level(t)),
                             static_cast<std::uint8_t>(hierarchy.phase(t)),
                             record.interface.distance};
    const auto vertices = hierarchy.vertices(t);
    for (std::size_t i = 0; i < 4; ++i) {
      std::uint32_t& n = number[vertices[i].value];
      if (n == kUnused) {
        n = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(hierarchy.position(vertices[i]));
        mesh.vertices.push_back(hierarchy.payload(vertices[i]));
        release_memory(mesh.vertices.back().closest);
      }
      cell.vertices[i] = n;
    }
    mesh.cells.push_back(cell);
    for (std::size_t f = 0; f < mesh.fields.size(); ++f) mesh.field_errors[f].push_back(record.fields[f].max);
  });
  return mesh;
}

}  // namespace adamas::interfaces
