#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/error_target.h"
#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"

namespace adamas ADAMAS_API {

/// Describes a field of an input: a scalar of one component, or a vector.
struct FieldDescription {
  std::string name;
  std::string unit;  ///< empty where the input states none
  int components = 1;
};

/// Options that say how given interfaces are repaired before they are used.
struct MendingOptions {
  /// Gaps up to this width are closed: a length, or a part of the domain's diagonal, of which it is at most
  /// 5%; with 0 no gaps are closed. None: 0.0001% of the diagonal.
  std::optional<ErrorTarget> gaps{};
  /// Take interfaces that intersect, contradict each other or do not match, in place of throwing Error.
  bool tolerant = false;
};

/// The input of resampling: data on a grid, from whose volume fractions or labels interfaces are
/// reconstructed, or given interfaces in a domain, with or without fields on a grid. Copies share their
/// contents.
class Input {
 public:
  /// Makes an input of data whose arrays stay the caller's: they must outlive the input and all meshes that
  /// are made of it. Throws Error as check() does.
  explicit Input(const GridData& data);
  explicit Input(OwnedGridData data);
  /// Makes an input of interfaces, which are copied, in a domain. `fields`, if not null, gives fields on a
  /// grid, with the materials of the interfaces by name; its arrays stay the caller's. Throws Error at arrays
  /// that do not fit each other, a domain without volume, and interfaces apart from it.
  Input(const InterfaceTriangles& interfaces, const Box3& domain, const MendingOptions& mending = {},
        const GridData* fields = nullptr);

  [[nodiscard]] const std::string& name() const;  ///< the name in messages: a file's name
  /// Returns the name for messages and, where data come from several files, how many more there are.
  [[nodiscard]] const std::string& source() const;
  [[nodiscard]] const Box3& domain() const;
  [[nodiscard]] const std::vector<std::string>& materials() const;
  [[nodiscard]] const std::vector<FieldDescription>& fields() const;
  /// Returns the least spacing of the grid, or the size of a typical cell of a mesh; 0 where there is
  /// neither.
  [[nodiscard]] double voxel() const;
  /// Returns whether interfaces are given, and not reconstructed.
  [[nodiscard]] bool has_given_interfaces() const;
  /// Returns whether interfaces are reconstructed from labels.
  [[nodiscard]] bool has_labels() const;

  /// The library itself uses the members below.
  struct Contents;
  explicit Input(std::shared_ptr<Contents> contents);
  [[nodiscard]] Contents& contents() const { return *contents_; }
  [[nodiscard]] std::shared_ptr<Contents> release() &&;

 private:
  std::shared_ptr<Contents> contents_;
};

}  // namespace adamas
