#include "cli/raw_options.h"

#include <vector>

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

namespace {

constexpr StoredType kStoredTypes[] = {
    StoredType::kUint8, StoredType::kInt8,   StoredType::kUint16, StoredType::kInt16,   StoredType::kUint32,
    StoredType::kInt32, StoredType::kUint64, StoredType::kInt64,  StoredType::kFloat32, StoredType::kFloat64};

std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const StoredType type : kStoredTypes) names.push_back(to_string(type));
  return names;
}

Vec3 parse_spacing(const std::string& option, const std::string& text) {
  const Vec3 spacing = parse_vector(option, text);
  if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0))
    wrong_usage("{}: expected positive numbers, found '{}'", option, text);
  return spacing;
}

}  // namespace

void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* subject) {
  command
      .add_converted("--dimensions", "Of a raw file: numbers of samples",
                     [&options](const std::string& option, const std::string& text) {
                       const auto n = parse_dimensions(option, text);
                       options.dimensions = {n[0], n[1], n[2]};
                     })
      .type_name("X,Y,Z")
      .group("Input");
  command
      .add_converted(
          "--type", "Of a raw file: the type of samples",
          [&options](const std::string&, const std::string& text) { options.type = parse_stored_type(text); })
      .one_of(type_names())
      .group("Input");
  command
      .add_converted(
          "--endian", "Of a raw file: the order of bytes (default little)",
          [&options](const std::string&, const std::string& text) { options.big_endian = text == "big"; })
      .one_of({"little", "big"})
      .group("Input");
  command
      .add_converted("--header-bytes", "Of a raw file: bytes to pass over (default 0)",
                     [&options](const std::string& option, const std::string& text) {
                       options.header_bytes = parse_count(option, text, 0);
                     })
      .type_name("N")
      .group("Input");
  command
      .add_converted("--spacing", fmt::format("Between the samples of {} (default 1,1,1)", subject),
                     [&options](const std::string& option, const std::string& text) {
                       options.spacing = parse_spacing(option, text);
                     })
      .type_name("x,y,z")
      .group("Input");
  command
      .add_converted(origin, fmt::format("The place of the first sample of {} (default 0,0,0)", subject),
                     [&options](const std::string&, const std::string& text) {
                       options.origin = parse_vector("--first-sample", text);
                     })
      .type_name("x,y,z")
      .group("Input");
}

}  // namespace adamas::cli
