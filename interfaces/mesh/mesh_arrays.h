#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/data/unstructured_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {

/// Finds arrays by name and type and checks their lengths. Throws Error that names the source.
class ArrayReader {
 public:
  ArrayReader(const std::vector<NamedArray>& arrays, std::string prefix, const std::string& source)
      : arrays_(arrays), prefix_(std::move(prefix)), source_(source) {}

  template <class Values>
  const Values& get(const std::string& name) const {
    for (const NamedArray& array : arrays_) {
      if (array.name != prefix_ + name) continue;
      if (const auto* values = std::get_if<Values>(&array.values)) return *values;
      fail("{}: array '{}{}': expected another type of values", source_, prefix_, name);
    }
    // This stands for an array that the writer left out because it was empty.
    static const Values kNone;
    return kNone;
  }
  template <class Values>
  const Values& get(const std::string& name, std::size_t length) const {
    const Values& values = get<Values>(name);
    if (values.size() != length) {
      fail("{}: array '{}{}': expected {} values, found {}", source_, prefix_, name, length, values.size());
    }
    return values;
  }
  [[nodiscard]] std::uint32_t index(std::int32_t value, std::size_t end, const std::string& name) const {
    if (value < 0 || static_cast<std::size_t>(value) >= end) {
      fail("{}: array '{}{}': expected indices below {}, found {}", source_, prefix_, name, end, value);
    }
    return static_cast<std::uint32_t>(value);
  }
  [[nodiscard]] std::size_t total(const std::vector<std::int32_t>& counts, const std::string& name) const {
    std::size_t sum = 0;
    for (const std::int32_t count : counts)
      sum += index(count, std::numeric_limits<std::int32_t>::max(), name);
    return sum;
  }

 private:
  const std::vector<NamedArray>& arrays_;
  std::string prefix_;
  const std::string& source_;
};

/// Adds the parts of a mesh other than its points and cells, as arrays whose names begin with the prefix:
/// materials, bodies, interfaces, fields, and the distances and rows of its vertices. The vertices' bodies
/// are left out.
void add_knowledge(const ResampledMesh& mesh, const std::string& prefix, std::vector<NamedArray>& arrays);

/// Reads the arrays that add_knowledge() has written into a mesh that has its points. `bodies`: the bodies of
/// the vertices. Throws Error if arrays are missing or have the wrong length, or if indices are out of range.
void read_knowledge(const ArrayReader& arrays, const std::vector<std::int32_t>& bodies, ResampledMesh& mesh);

}  // namespace adamas::interfaces
