#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// The name of the array by which a resampled mesh that adamas has written is known.
inline constexpr const char* kResampledVersion = "adamas version";

/// A named array attached to the points or cells of a mesh, or to the mesh itself. `components` values per
/// item.
struct NamedArray {
  std::string name;
  int components = 1;
  std::variant<std::vector<double>, std::vector<float>, std::vector<std::int32_t>, std::vector<std::uint8_t>,
               std::vector<std::string>>
      values;
};

enum class CellKind { kTetrahedra, kPolygons, kLines };

/// A mesh as files hold it: what io writes to .vtu and .vtp and reads back. Cell c has the points
/// `connectivity[offsets[c] .. offsets[c + 1])`.
struct UnstructuredMesh {
  CellKind kind = CellKind::kTetrahedra;
  std::vector<Vec3> points;
  std::vector<std::uint32_t> connectivity;
  std::vector<std::size_t> offsets{0};
  std::vector<NamedArray> point_arrays, cell_arrays, field_arrays;

  [[nodiscard]] std::size_t cell_count() const { return offsets.size() - 1; }
};

}  // namespace adamas::inline core
