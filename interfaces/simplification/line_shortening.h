#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/progress.h"
#include "core/distance/closest_point_tree.h"
#include "interfaces/simplification/near_field.h"

namespace adamas::interfaces {

struct InterfacePatch;
class SurfaceGuard;
struct SurfaceChange;

/// Shortens the lines that patches have in common and their borders in the sides of the domain: an edge of a
/// line is collapsed in all patches at once if both of its ends lie on the same line, the guard allows it and
/// the line stays near the original one. Points where lines end, meet or leave a side of the domain stay, as
/// do open borders inside the domain.
class LineShortener {
 public:
  /// The lines of the patches must be the original ones.
  LineShortener(std::vector<InterfacePatch>& patches, SurfaceGuard& guard);
  ~LineShortener();
  /// Collapses edges until none may be collapsed; returns the number of collapses.
  std::size_t shorten(double least_angle, const Progress& progress);

 private:
  using Edge = std::array<std::uint32_t, 2>;  ///< the lower point first
  struct Use {
    std::uint32_t point, patch;
    int vertex;
  };
  struct Candidate;
  struct Removal;
  /// The original lines of one kind: those between the same interfaces and in the same sides of the domain.
  struct Kind {
    ClosestPointTree tree;
    std::unique_ptr<NearField> near;
  };

  void find_kinds();
  void find_uses();
  [[nodiscard]] std::optional<Edge> neighbours(std::uint32_t point) const;
  [[nodiscard]] std::vector<Candidate> candidates_at(std::uint32_t point) const;
  [[nodiscard]] bool add_change(const Use& use, std::uint32_t to, SurfaceChange& change,
                                std::vector<Removal>& removals) const;
  [[nodiscard]] bool collapse(const Candidate& candidate, double least_angle);
  [[nodiscard]] bool line_allowed(const Candidate& candidate, double limit, std::vector<Vec3>& dropped);
  [[nodiscard]] std::vector<const Use*> uses_of(std::uint32_t point) const;

  std::vector<InterfacePatch>& patches_;
  SurfaceGuard& guard_;
  std::vector<Use> uses_;  ///< by point
  std::map<Edge, std::uint32_t> kind_of_edge_;
  std::vector<Kind> kinds_;
  std::map<Edge, std::vector<Vec3>> dropped_;  ///< the points of the original line along an edge
};

}  // namespace adamas::interfaces
