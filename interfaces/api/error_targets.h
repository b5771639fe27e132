#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/geometry.h"
#include "interfaces/input/resampling_source.h"

namespace adamas::interfaces {

/// What is known of an input before long work.
struct InputFacts {
  std::string name;
  Box3 box;
  std::vector<FieldInfo> fields;
  double voxel = 0;         ///< the least spacing of the input's grid; 0 where there is none
  bool has_labels = false;  ///< whether interfaces are reconstructed from labels
};
InputFacts facts_of(const ResamplingSource& source);

/// The names of fields for messages: "'a', 'b'"; "none" where there are none.
std::string field_names(const std::vector<FieldInfo>& fields);

/// The place of a field by its name. `option` and `source` are named by the Error that is thrown where there
/// is no field of that name.
std::size_t field_number(const std::string& option, const std::vector<FieldInfo>& fields,
                         const std::string& name, const std::string& source);

/// An interface error in units of length. Throws Error (kUsage), which names the option, where the error is
/// not above 0 and less than the domain's diagonal, or is in voxels and the input has no grid.
double interface_error_of(const std::string& option, const ErrorTarget& error, const InputFacts& input);

using FieldErrorTargets = std::vector<std::pair<std::string, ErrorTarget>>;

/// Field errors in the units of the input's fields, one for each field; none where no positive error is
/// wanted, and for a part of the range of a field that has one value everywhere. Throws Error for a field
/// that the input does not have, and for an error that is not finite.
std::vector<std::optional<double>> field_errors_of(const FieldErrorTargets& targets, const InputFacts& input);

}  // namespace adamas::interfaces
