#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/geometry/vec3.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/document/drawn_mesh.h"
#include "viewer/document/open_store.h"

namespace adamas::viewer {

/// Cross sections of a store by planes: values on a grid of places in the plane, worked out in a thread of
/// its own.
class StoreSection {
 public:
  /// How far places may lie apart: the least sample spacing of the grid, halved, times 2^coarseness.
  struct Wanted {
    Plane plane;  ///< in space
    int coarseness = 0;
    bool is_of_colours =
        false;  ///< of the volume that colours surfaces; otherwise of the store's own samples
    std::uint32_t step = 0;

    bool operator==(const Wanted&) const;
  };
  struct Found {
    Wanted wanted;
    SharedMesh mesh;      ///< null where the plane does not cut the data
    std::string problem;  ///< why it could not be had; empty: nothing
    bool is_rough = false;
  };

  /// `colours`: the store whose values colour surfaces, or null. The stores must outlive this.
  StoreSection(OpenStore& store, OpenStore* colours);
  StoreSection(const StoreSection&) = delete;
  StoreSection& operator=(const StoreSection&) = delete;
  ~StoreSection();

  /// What a picture from a viewpoint, in space, wants: places about one pixel apart where the plane is
  /// nearest, and not more than a million of them.
  [[nodiscard]] Wanted wanted(const Plane& plane, const isosurface::Viewpoint& viewpoint, bool is_of_colours,
                              std::uint32_t step) const;
  void want(const Wanted& wanted);
  /// What was found last, for whatever was wanted then; null before that.
  [[nodiscard]] std::shared_ptr<const Found> found() const;
  /// Whether that is what was wanted last, or nothing was.
  [[nodiscard]] bool is_current() const;
  void wait_for(const Wanted& wanted);

 private:
  void run();
  [[nodiscard]] bool is_overtaken(const Wanted& wanted) const;
  /// Places are so many times as far apart as is wanted.
  void find(const Wanted& wanted, int roughness);
  [[nodiscard]] SharedMesh mesh_of(const Wanted& wanted, int roughness);
  [[nodiscard]] double least_step() const;

  OpenStore& store_;
  OpenStore* colours_;  ///< null where there are none
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ended_ = false;
  std::optional<Wanted> wanted_;
  std::shared_ptr<const Found> found_;
  std::thread thread_;
};

}  // namespace adamas::viewer
