#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::cli {

/// The options that say how well to resample, as text.
struct ResamplingText {
  std::string interface_error = "1%", volume_error, max_tetrahedra, ghost = "constant", distance = "exact";
  std::vector<std::string> field_errors;
  bool conserve = false;
};

void add_resampling_options(const Command& command, ResamplingText& text);
/// The same without the interface error.
void add_other_resampling_options(const Command& command, ResamplingText& text);

using FieldErrorTargets = std::vector<std::pair<std::string, ErrorTarget>>;
/// "NAME=E" each. Throws UsageError, also for a name that is there twice.
FieldErrorTargets parse_field_errors(const std::vector<std::string>& texts);
/// The place of a field by its name. Throws Error that names the source where it has none of that name.
std::size_t field_number(const std::vector<interfaces::FieldInfo>& fields, const std::string& name,
                         const std::string& source);

/// The options with their values checked, before the input is known.
struct ResamplingRequest {
  /// Throws UsageError.
  explicit ResamplingRequest(const ResamplingText& text);
  /// Throws UsageError for an interface error that says nothing in this domain, and Error for fields that the
  /// input has not.
  void check(const InputFacts& input) const;
  /// For a source that was checked: errors in its units.
  [[nodiscard]] interfaces::ResamplingOptions options(const interfaces::ResamplingSource& source) const;

  ErrorTarget interface_error;
  FieldErrorTargets field_errors;
  std::optional<double> volume_error;  ///< 0.01 for 1%
  std::optional<std::size_t> max_tetrahedra;
  GhostMode ghost = GhostMode::kConstant;
  DistanceMode distance = DistanceMode::kExact;
  bool conserve = false;
};

/// An interface error in units of length. Throws UsageError that names the option where it is not less than
/// the domain's diagonal, or is in voxels and there are none.
double interface_error_of(const std::string& option, const ErrorTarget& error, const InputFacts& input);

/// Field errors in the units of the input's fields, by field; none for fields of one value everywhere, which
/// any mesh meets. Throws Error for fields that the input has not.
std::vector<std::optional<double>> field_errors_of(const FieldErrorTargets& targets, const InputFacts& input);

/// The field whose integral is mass: the one of that name, else, for an empty name, one called density; empty
/// where there is none. Throws Error for a name that no field has, and for a vector.
std::string density_field(const std::string& name, const std::vector<interfaces::FieldInfo>& fields,
                          const std::string& source);

/// The names of a source's fields, for messages: "'a', 'b'"; "none" where it has none.
std::string field_names(const std::vector<interfaces::FieldInfo>& fields);

}  // namespace adamas::cli
