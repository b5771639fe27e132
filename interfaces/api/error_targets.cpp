#include "interfaces/api/error_targets.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace adamas::interfaces {

InputFacts facts_of(const ResamplingSource& source) {
  return {source.name, source.box, source.fields ? source.fields->fields() : std::vector<FieldInfo>(),
          source.voxel};
}

std::string field_names(const std::vector<FieldInfo>& fields) {
  std::string names;
  for (const FieldInfo& f : fields) names += (names.empty() ? "'" : ", '") + f.name + "'";
  return names.empty() ? "none" : names;
}

std::size_t field_number(const std::string& option, const std::vector<FieldInfo>& fields,
                         const std::string& name, const std::string& source) {
  const auto found = std::ranges::find(fields, name, &FieldInfo::name);
  if (found == fields.end())
    fail("{}: {}: expected one of its fields ({}), found '{}'", source, option, field_names(fields), name);
  return static_cast<std::size_t>(found - fields.begin());
}

double interface_error_of(const std::string& option, const ErrorTarget& error, const InputFacts& input) {
  const double whole = input.box.diagonal();
  if (error.unit == ErrorTarget::Unit::kVoxels && !(input.voxel > 0))
    wrong_usage("{}: expected a length or a part of the domain's diagonal, since {} has no grid, found {}",
                option, input.name, error.text());
  const double length = error.absolute(whole, input.voxel);
  if (!(length > 0)) wrong_usage("{}: expected a positive error, found {}", option, error.text());
  if (length < whole) return length;
  wrong_usage("{}: expected less than the domain's diagonal, {:.6g}, found {} (a part of it is written 1%)",
              option, whole, error.text());
}

std::vector<std::optional<double>> field_errors_of(const FieldErrorTargets& targets,
                                                   const InputFacts& input) {
  std::vector<std::optional<double>> result(input.fields.size());
  for (const auto& [name, target] : targets) {
    const std::size_t found = field_number("--field-error", input.fields, name, input.name);
    const double wanted = target.absolute(input.fields[found].max - input.fields[found].min);
    if (!std::isfinite(wanted) && !(wanted < 0))
      fail("{}: --field-error {}: expected a finite error, found {}", input.name, name, target.text());
    if (wanted > 0) result[found] = wanted;
  }
  return result;
}

}  // namespace adamas::interfaces
