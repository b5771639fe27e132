#include "cli/resampling_options.h"

#include <algorithm>
#include <cctype>

#include "cli/usage_error.h"
#include "core/base/error.h"

namespace adamas::cli {

using namespace interfaces;

namespace {

bool same_letters(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace

void add_resampling_options(const Command& command, ResamplingText& text) {
  command
      .add_option("--interface-error", text.interface_error,
                  "Greatest distance between the interfaces and their approximation: a length, in % of the "
                  "domain's diagonal, or in voxels of the input's grid (its least spacing)")
      .type_name("E|E%|Evoxels")
      .show_default();
  add_other_resampling_options(command, text);
}

void add_other_resampling_options(const Command& command, ResamplingText& text) {
  command
      .add_option("--field-error", text.field_errors,
                  "Greatest error of a field, in its unit or in % of its range; repeatable")
      .type_name("NAME=E|E%")
      .one_value_each();
  command
      .add_option("--volume-error", text.volume_error,
                  "Refine until every body has its volume in the input but for so much of it, besides the "
                  "interface error")
      .type_name("P%");
  command.add_option("--max-tetrahedra", text.max_tetrahedra, "Stop at this size, whatever the errors")
      .type_name("N");
  command
      .add_option("--ghost", text.ghost, "How a material's field goes on beyond the material, within a cell")
      .one_of({"constant", "linear", "least-squares"})
      .show_default();
  command.add_flag(
      "--conserve", text.conserve,
      "Move the interfaces, within the interface error, until every body has its volume in the input");
  command
      .add_option("--distance", text.distance,
                  "What vertices measure: the distance to an interface, or to the nearest vertex of its mesh")
      .one_of({"exact", "nearest-vertex"})
      .show_default();
}

FieldErrorTargets parse_field_errors(const std::vector<std::string>& texts) {
  FieldErrorTargets result;
  for (const std::string& each : texts) {
    const auto [name, value] = parse_assignment("--field-error", each, true);
    const auto same = [&name = name](const auto& other) { return other.first == name; };
    if (std::any_of(result.begin(), result.end(), same)) {
      wrong_usage("--field-error: expected one error per field, found '{}' twice", name);
    }
    result.emplace_back(name, parse_error_target("--field-error " + name, value));
  }
  return result;
}

std::size_t field_number(const std::vector<FieldInfo>& fields, const std::string& name,
                         const std::string& source) {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
  if (found == fields.end()) {
    fail("{}: --field-error: expected one of its fields ({}), found '{}'", source, field_names(fields), name);
  }
  return static_cast<std::size_t>(found - fields.begin());
}

ResamplingRequest::ResamplingRequest(const ResamplingText& text)
    : interface_error(parse_error_target("--interface-error", text.interface_error, true)),
      field_errors(parse_field_errors(text.field_errors)) {
  if (!text.volume_error.empty()) volume_error = parse_percentage("--volume-error", text.volume_error);
  if (!text.max_tetrahedra.empty()) max_tetrahedra = parse_count("--max-tetrahedra", text.max_tetrahedra);
  if (text.ghost == "linear") ghost = GhostMode::kLinear;
  if (text.ghost == "least-squares") ghost = GhostMode::kLeastSquares;
  conserve = text.conserve;
  if (text.distance == "nearest-vertex") distance = DistanceMode::kNearestVertex;
}

double interface_error_of(const std::string& option, const ErrorTarget& error, const InputFacts& input) {
  const double whole = input.box.diagonal();
  if (error.unit == ErrorTarget::Unit::kVoxels && !(input.voxel > 0))
    wrong_usage("{}: expected a length or a part of the domain's diagonal, since {} has no grid, found {}",
                option, input.name, error.text());
  const double length = error.of(whole, input.voxel);
  if (length < whole) return length;
  wrong_usage("{}: expected less than the domain's diagonal, {:.6g}, found {} (a part of it is written 1%)",
              option, whole, error.text());
}

std::vector<std::optional<double>> field_errors_of(const FieldErrorTargets& targets,
                                                   const InputFacts& input) {
  std::vector<std::optional<double>> result(input.fields.size());
  for (const auto& [name, target] : targets) {
    const std::size_t found = field_number(input.fields, name, input.name);
    const double wanted = target.of(input.fields[found].max - input.fields[found].min);
    if (wanted > 0) result[found] = wanted;
  }
  return result;
}

void ResamplingRequest::check(const InputFacts& input) const {
  static_cast<void>(interface_error_of("--interface-error", interface_error, input));
  for (const auto& [name, target] : field_errors)
    static_cast<void>(field_number(input.fields, name, input.name));
}

ResamplingOptions ResamplingRequest::options(const ResamplingSource& source) const {
  const InputFacts input = facts_of(source);
  check(input);
  if ((conserve || volume_error) && source.body_volumes.empty() && !source.network->triangles().empty())
    fail("{}: {}: expected interfaces that enclose volumes, found open ones", input.name,
         conserve ? "--conserve" : "--volume-error");
  ResamplingOptions result;
  result.interface_error = interface_error_of("--interface-error", interface_error, input);
  result.max_tetrahedra = max_tetrahedra;
  result.ghost = ghost;
  result.distance = distance;
  result.conserve = conserve;
  result.volume_error = volume_error;
  result.field_errors = field_errors_of(field_errors, input);
  return result;
}

std::string field_names(const std::vector<FieldInfo>& fields) {
  std::string names;
  for (const FieldInfo& f : fields) names += (names.empty() ? "'" : ", '") + f.name + "'";
  return names.empty() ? "none" : names;
}

std::string density_field(const std::string& name, const std::vector<FieldInfo>& fields,
                          const std::string& source) {
  for (const FieldInfo& info : fields) {
    if (name.empty() ? same_letters(info.name, "density") : info.name == name) {
      if (info.components == 1) return info.name;
      fail("{}: --density: expected a scalar field, found '{}' with {} components", source, info.name,
           info.components);
    }
  }
  if (name.empty()) return {};
  fail("{}: --density: expected one of its fields ({}), found '{}'", source, field_names(fields), name);
}

}  // namespace adamas::cli
