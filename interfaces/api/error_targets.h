#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/geometry.h"
#include "interfaces/input/resampling_source.h"

namespace adamas::interfaces {

/// The facts about an input that are known before long work.
struct InputFacts {
  std::string name;
  Box3 box;
  std::vector<FieldInfo> fields;
  double voxel = 0;         ///< as in ResamplingSource
  bool has_labels = false;  ///< whether interfaces are reconstructed from labels
};
InputFacts facts_of(const ResamplingSource& source);

/// Returns the names of fields for messages, as "'a', 'b'"; "none" if there are none.
std::string field_names(const std::vector<FieldInfo>& fields);

/// Returns the index of a field by its name. Throws Error that names `option` and `source` if there is no
/// such field.
std::size_t field_number(const std::string& option, const std::vector<FieldInfo>& fields,
                         const std::string& name, const std::string& source);

/// Returns an interface error in units of length. Throws Error (kUsage) that names the option if the error is
/// not above 0 and less than the domain's diagonal, or if it is in voxels and the input has no grid.
double interface_error_of(const std::string& option, const ErrorTarget& error, const InputFacts& input);

using FieldErrorTargets = std::vector<std::pair<std::string, ErrorTarget>>;

/// Returns field errors in the units of the input's fields, one for each field. There is none if no positive
/// error is wanted, or if it is relative to the range of a field that has one value everywhere. Throws Error
/// for a field that the input does not have, and for an error that is not finite.
std::vector<std::optional<double>> field_errors_of(const FieldErrorTargets& targets, const InputFacts& input);

}  // namespace adamas::interfaces
