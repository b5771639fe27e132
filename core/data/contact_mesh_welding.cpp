// What becomes of points that coincide: they are welded, and the loops and triangles that have lost their
// area go.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/hash.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "core/data/contact_mesh.h"

namespace adamas::inline core {

void ContactMeshBuilder::weld_crowded_points() {
  welded_.resize(points_.size());
  std::iota(welded_.begin(), welded_.end(), 0u);
  const auto box_of = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    std::uint64_t hash = 0;
    for (const std::int64_t index : {i, j, k})
      hash = hash_combine(hash, static_cast<std::uint64_t>(index)) + (hash >> 29);
    return hash;
  };
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> boxes;
  const auto first = std::find(crowded_.begin(), crowded_.end(), 1);
  const Vec3 origin =
      first == crowded_.end() ? Vec3{} : points_[static_cast<std::size_t>(first - crowded_.begin())];
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    LoopProgress::check_step(p);
    if (crowded_[p] == 0) continue;
    const Vec3& x = points_[p];
    std::array<std::int64_t, 3> low{}, high{}, own{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double scaled = (x[axis] - origin[axis]) / (4 * tolerance_);
      low[a] = static_cast<std::int64_t>(std::floor(scaled - 0.25));
      high[a] = static_cast<std::int64_t>(std::floor(scaled + 0.25));
      own[a] = static_cast<std::int64_t>(std::floor(scaled));
    }
    std::uint32_t found = p;
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto box = boxes.find(box_of(i, j, k));
          if (box == boxes.end()) continue;
          for (const std::uint32_t q : box->second) {
            if (distance(points_[q], x) <= tolerance_) found = std::min(found, q);
          }
        }
      }
    }
    welded_[p] = welded_[found];
    if (found == p) boxes[box_of(own[0], own[1], own[2])].push_back(p);
  }
}

void ContactMeshBuilder::drop_repeated(std::vector<std::uint32_t>& loop) {
  // What is left of an edge that was run along and back is a point between two equal ones.
  for (std::size_t before = 0; before != loop.size();) {
    before = loop.size();
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    for (std::size_t i = 0; loop.size() > 2 && i < loop.size(); ++i) {
      const std::size_t next = (i + 1) % loop.size(), last = (i + 2) % loop.size();
      if (loop[i] != loop[last]) continue;
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(next));
      break;
    }
  }
  if (loop.size() < 3) loop.clear();
}

bool ContactMeshBuilder::passes(std::uint32_t a, std::uint32_t b, std::uint32_t p) const {
  const Vec3 along = points_[b] - points_[a], offset = points_[p] - points_[a];
  const double length = norm(along), at = dot(offset, along) / length;
  return at > tolerance_ && at < length - tolerance_ &&
         squared_norm(cross(offset, along)) <= tolerance_ * tolerance_ * length * length;
}

void ContactMeshBuilder::close_spikes(std::vector<Loops>& parts) const {
  // Each round makes edges shorter; the bound is for what round-off may do.
  constexpr int kMostRounds = 64;
  using Passed = std::pair<std::uint64_t, std::uint32_t>;  // an edge, and a point that it passes
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<std::vector<Passed>> found(parts.size());
    parallel_for(parts.size(), 1, [&](std::size_t part) {
      parts[part].for_each([&](std::size_t, std::span<const std::uint32_t> loop) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], tip = loop[(i + 1) % loop.size()], b = loop[(i + 2) % loop.size()];
          if (passes(a, tip, b)) found[part].emplace_back(edge_key(a, tip), b);
          if (passes(tip, b, a)) found[part].emplace_back(edge_key(tip, b), a);
        }
      });
    });
    std::unordered_map<std::uint64_t, std::uint32_t> passed;
    for (const auto& some : found) passed.insert(some.begin(), some.end());
    if (passed.empty()) return;
    for (Loops& part : parts) {
      Loops divided;
      std::vector<std::uint32_t> longer;
      part.for_each([&](std::size_t, std::span<const std::uint32_t> loop) {
        longer.clear();
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
          longer.push_back(a);
          if (const auto point = passed.find(edge_key(a, b)); point != passed.end())
            longer.push_back(point->second);
        }
        if (longer.size() != loop.size()) drop_repeated(longer);
        divided.add(longer);
      });
      part = std::move(divided);
    }
  }
}

void ContactMeshBuilder::cancel_coinciding(InterfaceMesh& mesh) const {
  // Triangles by their corners, turned so that these run upwards with the smallest first.
  struct Side {
    std::array<std::uint32_t, 3> points;
    std::uint32_t triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  const auto turned = [](const InterfaceTriangle& t) {
    auto p = t.points;
    std::sort(p.begin(), p.end());
    return p;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    if (crowded_[p[0]] != 0 && crowded_[p[1]] != 0 && crowded_[p[2]] != 0)
      sides.push_back({turned(mesh.triangles[t]), t});
  }
  std::sort(sides.begin(), sides.end());
  const auto even = [&](const InterfaceTriangle& t) {
    const auto& p = t.points;
    return (p[0] < p[1]) == (p[1] < p[2]) ? p[0] < p[1] : p[2] < p[0];
  };
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].points == sides[first].points) ++last;
    if (last - first < 2) continue;
    // How often each region lies in front of the stack of triangles rather than behind it.
    std::vector<std::pair<std::uint32_t, int>> net;
    const auto count = [&](MaterialId side, int by) {
      const auto found =
          std::find_if(net.begin(), net.end(), [&](const auto& entry) { return entry.first == side.value; });
      if (found == net.end()) {
        net.emplace_back(side.value, by);
      } else {
        found->second += by;
      }
    };
    for (std::size_t i = first; i < last; ++i) {
      const InterfaceTriangle& t = mesh.triangles[sides[i].triangle];
      count(t.front, even(t) ? 1 : -1);
      count(t.back, even(t) ? -1 : 1);
      gone[sides[i].triangle] = 1;
    }
    std::erase_if(net, [](const auto& entry) { return entry.second == 0; });
    if (net.empty()) continue;
    if (net.size() != 2 || std::abs(net[0].second) != 1) {
      for (std::size_t i = first; i < last; ++i) gone[sides[i].triangle] = 0;
      continue;
    }
    InterfaceTriangle& kept = mesh.triangles[sides[first].triangle];
    if ((net[0].second > 0) != even(kept)) std::swap(net[0], net[1]);
    kept.front = MaterialId(net[0].first);
    kept.back = MaterialId(net[1].first);
    gone[sides[first].triangle] = 0;
  }
  std::size_t left = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (gone[t] == 0) mesh.triangles[left++] = mesh.triangles[t];
  }
  mesh.triangles.resize(left);
}

}  // namespace adamas::inline core
