#include "interfaces/resampling/shortfall.h"

#include <cmath>

namespace adamas::interfaces {

namespace {

std::string budget_reason(const Resampler& resampler) {
  return fmt::format("the mesh may have no more than {} tetrahedra",
                     resampler.options().max_tetrahedra.value_or(0));
}

constexpr const char* kDeep = "the hierarchy is as deep there as it can be";

}  // namespace

std::vector<UnreachedError> unreached_errors(const Resampler& resampler,
                                             const std::vector<FieldFigures>& fields) {
  std::vector<UnreachedError> result;
  const std::string wanted = "the interface error wanted";
  const auto add_distance = [&](const std::string& whose, const InterfaceDistance& distance) {
    if (auto why = interface_shortfall(resampler, distance))
      result.push_back(
          {wanted + whose, distance.upper, resampler.options().interface_error, std::move(*why)});
  };
  if (const auto& certificate = resampler.certificate()) {
    add_distance("", certificate->networks);
    // Of two materials the boundary of each consists of all interfaces.
    if (resampler.source().materials.size() > 2)
      add_distance(
          fmt::format(" for the boundary of '{}'", resampler.source().materials[certificate->worst_material]),
          certificate->materials);
    if (certificate->junctions)
      add_distance(" for the lines where three materials meet", *certificate->junctions);
  }
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (auto why = field_shortfall(resampler, f, fields[f].all))
      result.push_back(
          {fmt::format("the error wanted of the field '{}'", resampler.source().fields->fields()[f].name),
           fields[f].all.max, *resampler.options().field_errors[f], std::move(*why)});
  }
  return result;
}

std::optional<Shortfall> interface_shortfall(const Resampler& resampler, const InterfaceDistance& distance) {
  if (distance.upper <= resampler.options().interface_error) return {};
  const InterfaceNetwork& network = *resampler.source().network;
  // Where no interfaces are approximated, all points of the input's are equally far.
  const Vec3 place =
      std::isfinite(distance.lower) ? distance.worst : network.points()[network.triangles()[0][0]];
  switch (resampler.interface_end()) {
    case RefinementEnd::kBudget:
      return Shortfall{budget_reason(resampler), place};
    case RefinementEnd::kDepth:
      return Shortfall{kDeep, place};
    case RefinementEnd::kRounds:
      return Shortfall{"it still changed when measuring and refining had been repeated often enough", place};
    case RefinementEnd::kSmallestCells:
    case RefinementEnd::kReached:
      break;
  }
  const bool open = network.has_open_border() || network.inconsistencies() > 0;
  return Shortfall{
      open ? "the input's interfaces have open borders or do not match, and cells far smaller than "
             "the error do not bring the mesh's nearer"
           : "cells far smaller than the error do not bring the mesh's interfaces nearer",
      place};
}

std::optional<Shortfall> field_shortfall(const Resampler& resampler, std::size_t field,
                                         const FieldError& errors) {
  const auto& target = resampler.options().field_errors[field];
  if (!target || errors.count() == 0 || errors.max <= *target) return {};
  const ResamplingSource& source = resampler.source();
  const NativeElement& element = source.fields->native_elements()[errors.worst];
  const MaterialId owner = source.network->table().material(resampler.owner_at(element.position));
  const auto because = [&](std::string reason) { return Shortfall{std::move(reason), element.position}; };
  if (owner != element.material && element.kind == ElementKind::kMinority) {
    return because(
        fmt::format("the input's value there is of '{}', which has a part of the cell while the input's "
                    "interfaces give the place to another material, so that smaller cells do not help",
                    source.materials[element.material]));
  }
  if (!source.fields->interpolates(element, field)) {
    return because(
        fmt::format("the input's one value there is for all materials of the cell, and the field of "
                    "'{}' does not follow it, so that smaller cells do not help",
                    source.materials[element.material]));
  }
  if (owner != element.material) {
    return because(
        fmt::format("the input's value there is of '{}', but the mesh's interface, which may be off by its "
                    "own error, leaves the place to '{}'",
                    source.materials[element.material], source.materials[owner]));
  }
  if (resampler.budget_spent()) return because(budget_reason(resampler));
  if (!resampler.hierarchy().can_split(resampler.leaf_at(element.position))) return because(kDeep);
  return because("cells near by were refined after it had been reached there");
}

std::optional<Shortfall> volume_shortfall(const Resampler& resampler, const ResampleFigures& measured,
                                          BodyId body) {
  const auto& target = resampler.options().volume_error;
  const BodyFigures& figures = measured.bodies[body.value];
  if (!target || figures.volume_error() <= *target) return {};
  const auto because = [&](std::string reason) { return Shortfall{std::move(reason), figures.place}; };
  const VolumeGoal* goal = resampler.volume_goal(body);
  if (goal != nullptr && std::abs(goal->volume - *figures.volume_input) > *target * *figures.volume_input)
    return because(fmt::format("the input's interfaces enclose {:.6g}", goal->volume));
  if (resampler.budget_spent()) return because(budget_reason(resampler));
  switch (resampler.volume_end(body)) {
    case RefinementEnd::kDepth:
      return because(kDeep);
    case RefinementEnd::kSmallestCells:
      return because("smaller cells do not bring it nearer");
    default:
      return because("cells or interfaces were changed for other errors after it had been reached");
  }
}

}  // namespace adamas::interfaces
