#pragma once

#include <string>

#include "adamas/export.h"
#include "adamas/grid_data.h"
#include "adamas/input.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/resample.h"

namespace adamas ADAMAS_API {

struct SliceFieldOptions {
  /// The field by name; "NAME:C" is its component C, from 0 on, and the name of a vector its length. Empty:
  /// the slice has materials alone.
  std::string field{};
  /// Interpolate linearly in cells whatever the interfaces, in place of each material's own field. Only
  /// meshes have this option.
  bool plain = false;
};

/// Cuts a mesh by a plane, with each material's own field up to its interfaces. The polygons fill the
/// plane's part of the domain once. Throws Error where the plane misses the domain or is none, and where
/// there is no such field.
Slice slice(const AdaptiveMesh& mesh, const Plane& plane, const SliceFieldOptions& options = {});

/// Cuts data as they are by a plane: each site shows the material with the largest part there, and its value;
/// areas are by fractions. Throws Error as above and as check() does.
Slice slice(const GridData& data, const Plane& plane, const SliceFieldOptions& options = {});

/// Cuts an input by a plane: data on a grid as above; given interfaces, which are repaired as resample()
/// does, into the regions of their materials. With a field, given interfaces are left aside and the grid is
/// cut that has it. Throws Error as above and at interfaces that cannot be used, and Cancelled where the
/// progress says so.
Slice slice(const Input& input, const Plane& plane, const SliceFieldOptions& options = {},
            Progress& progress = SilentProgress::instance());

}  // namespace adamas
