#include "cli/raw_options.h"

#include <utility>
#include <vector>

#include "cli/option_values.h"
#include "cli/usage.h"

namespace adamas::cli {

using namespace io;

namespace {

constexpr StoredType kStoredTypes[] = {
    StoredType::kUint8, StoredType::kInt8,   StoredType::kUint16, StoredType::kInt16,   StoredType::kUint32,
    StoredType::kInt32, StoredType::kUint64, StoredType::kInt64,  StoredType::kFloat32, StoredType::kFloat64};

std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const StoredType type : kStoredTypes) names.emplace_back(stored_name(type));
  return names;
}

}  // namespace

std::string RawOptions::option() const {
  const std::pair<const char*, const std::string*> options[] = {
      {"--dimensions", &dimensions}, {"--type", &type},     {"--spacing", &spacing},
      {"--first-sample", &origin},   {"--endian", &endian}, {"--header-bytes", &header_bytes}};
  for (const auto& [name, text] : options) {
    if (!text->empty()) return name;
  }
  return {};
}

void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* of) {
  command.add_option("--dimensions", options.dimensions, "Of a raw file: numbers of samples")
      .type_name("X,Y,Z")
      .group("Input");
  command.add_option("--type", options.type, "Of a raw file: the type of samples")
      .one_of(type_names())
      .group("Input");
  command.add_option("--endian", options.endian, "Of a raw file: the order of bytes (default little)")
      .one_of({"little", "big"})
      .group("Input");
  command.add_option("--header-bytes", options.header_bytes, "Of a raw file: bytes to pass over (default 0)")
      .type_name("N")
      .group("Input");
  command
      .add_option("--spacing", options.spacing, fmt::format("Between the samples of {} (default 1,1,1)", of))
      .type_name("x,y,z")
      .group("Input");
  command
      .add_option(origin, options.origin,
                  fmt::format("The place of the first sample of {} (default 0,0,0)", of))
      .type_name("x,y,z")
      .group("Input");
}

Vec3 raw_spacing(const RawOptions& options) {
  if (options.spacing.empty()) return {1, 1, 1};
  const Vec3 spacing = parse_vector("--spacing", options.spacing);
  if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0))
    wrong_usage("--spacing: expected positive numbers, found '{}'", options.spacing);
  return spacing;
}

Vec3 raw_origin(const RawOptions& options) {
  return options.origin.empty() ? Vec3{} : parse_vector("--first-sample", options.origin);
}

std::optional<RawVolume> raw_volume(const RawOptions& options) {
  if (options.dimensions.empty()) {
    for (const auto& [option, text] : {std::pair("--type", &options.type),
                                       {"--endian", &options.endian},
                                       {"--header-bytes", &options.header_bytes}}) {
      if (!text->empty()) wrong_usage("{}: expected --dimensions as well", option);
    }
    return {};
  }
  RawVolume raw;
  const auto n = parse_dimensions("--dimensions", options.dimensions);
  raw.dimensions = {n[0], n[1], n[2]};
  if (options.type.empty()) wrong_usage("--dimensions: expected --type as well");
  raw.type = *find_stored_type(options.type);
  raw.big_endian = options.endian == "big";
  if (!options.header_bytes.empty())
    raw.header_bytes = parse_count("--header-bytes", options.header_bytes, 0);
  raw.spacing = raw_spacing(options);
  raw.origin = raw_origin(options);
  return raw;
}

}  // namespace adamas::cli
