#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/contents/drawn_mesh.h"
#include "viewer/contents/open_store.h"

namespace adamas::viewer {

/// Computes cross sections of a store by planes in a thread: values on a grid of places in the plane.
class StoreSection {
 public:
  /// A section that is wanted. Its places are half the least sample spacing of the grid, times 2^coarseness,
  /// apart.
  struct Wanted {
    Plane plane;  ///< the plane in space
    int coarseness = 0;
    /// Whether its values are those of the store that colours surfaces, not of the store itself.
    bool is_of_colours = false;
    std::uint32_t step = 0;

    bool operator==(const Wanted&) const;
  };
  struct Found {
    Wanted wanted;
    SharedMesh mesh;        ///< the triangles; null if the plane does not cut the data
    std::string problem;    ///< why it could not be computed; empty if nothing is wrong
    bool is_rough = false;  ///< whether its places are still farther apart than wanted
  };

  /// `colours`: the store whose values colour surfaces, or null. The stores must outlive this object.
  StoreSection(OpenStore& store, OpenStore* colours);
  StoreSection(const StoreSection&) = delete;
  StoreSection& operator=(const StoreSection&) = delete;
  ~StoreSection();

  /// The section for a picture from a viewpoint in space: its places are about one pixel apart where the
  /// plane is nearest to the eye, and there are at most a million of them.
  [[nodiscard]] Wanted wanted(const Plane& plane, const isosurface::Viewpoint& viewpoint, bool is_of_colours,
                              std::uint32_t step) const;
  /// Requests a section, and replaces the one that was requested before.
  void want(const Wanted& wanted);
  /// The section that was found last, for whichever request; null before the first one.
  [[nodiscard]] std::shared_ptr<const Found> found() const;
  /// Whether the section that was requested last is found, or none was requested.
  [[nodiscard]] bool is_current() const;
  /// Waits until this section is found, which must be the one that was requested last.
  void wait_for(const Wanted& wanted);

 private:
  void run();
  [[nodiscard]] bool is_overtaken(const Wanted& wanted) const;
  /// Computes a section whose places are `roughness` times as far apart as wanted.
  void find(const Wanted& wanted, int roughness);
  [[nodiscard]] SharedMesh mesh_of(const Wanted& wanted, int roughness);
  [[nodiscard]] double least_step() const;

  OpenStore& store_;
  OpenStore* colours_;  ///< null if no store colours surfaces
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_ended_ = false;
  std::optional<Wanted> wanted_;
  std::shared_ptr<const Found> found_;
  std::thread thread_;
};

}  // namespace adamas::viewer
