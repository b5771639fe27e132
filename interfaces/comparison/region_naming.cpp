#include "interfaces/comparison/region_naming.h"

#include <algorithm>
#include <unordered_map>

#include "core/base/hash.h"
#include "core/base/sort_unique.h"
#include "interfaces/mesh/conforming_mesh.h"

namespace adamas::interfaces {

namespace {

using Corners = std::array<std::uint32_t, 3>;

struct CornersHash {
  std::size_t operator()(const Corners& c) const {
    const std::uint64_t hash = fibonacci_hash(fibonacci_hash(c[0]) + c[1]) + c[2];
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

Corners sorted(Corners c) {
  std::sort(c.begin(), c.end());
  return c;
}

/// A contact of a region of tetrahedra with another one, or with the outside, across a patch.
struct Contact {
  std::uint32_t region, other, patch;
  auto operator<=>(const Contact&) const = default;
};

class Namer {
 public:
  Namer(const PiecewiseLinearComplex& complex, const std::vector<std::array<std::uint32_t, 4>>& tetrahedra)
      : complex_(complex),
        tetrahedra_(tetrahedra),
        neighbours_(find_neighbours(tetrahedra, complex.source)) {}

  void mark(const std::vector<Corners>& faces, const std::vector<std::uint32_t>& patches) {
    for (std::size_t f = 0; f < faces.size(); ++f) patch_of_[sorted(faces[f])] = patches[f];
  }
  void find_regions();
  /// Passes names on to neighbouring regions; returns false if two names are found for one region.
  bool spread();
  [[nodiscard]] bool complete() const {
    return std::all_of(names_.begin(), names_.end(), [](BodyId body) { return body.valid(); });
  }
  [[nodiscard]] BodyId body(std::size_t tetrahedron) const { return names_[region_[tetrahedron]]; }

 private:
  [[nodiscard]] const std::uint32_t* patch(std::uint32_t t, std::size_t i) const {
    const auto& v = tetrahedra_[t];
    const auto found = patch_of_.find(sorted({v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4]}));
    return found == patch_of_.end() ? nullptr : &found->second;
  }
  bool name(std::uint32_t region, BodyId body);

  const PiecewiseLinearComplex& complex_;
  const std::vector<std::array<std::uint32_t, 4>>& tetrahedra_;
  std::vector<std::array<std::uint32_t, 4>> neighbours_;
  std::unordered_map<Corners, std::uint32_t, CornersHash> patch_of_;
  std::vector<std::uint32_t> region_;  ///< by tetrahedron
  std::vector<Contact> contacts_;      ///< in ascending order
  std::vector<BodyId> names_;          ///< by region
  std::vector<std::uint32_t> fresh_;   ///< the regions whose names have not been passed on yet
};

void Namer::find_regions() {
  region_.assign(tetrahedra_.size(), kNoNeighbour);
  std::vector<std::uint32_t> stack;
  std::uint32_t regions = 0;
  for (std::uint32_t first = 0; first < tetrahedra_.size(); ++first) {
    if (region_[first] != kNoNeighbour) continue;
    region_[first] = regions;
    stack.push_back(first);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t other = neighbours_[t][i];
        if (other == kNoNeighbour || region_[other] != kNoNeighbour || patch(t, i) != nullptr) continue;
        region_[other] = regions;
        stack.push_back(other);
      }
    }
    ++regions;
  }
  for (std::uint32_t t = 0; t < tetrahedra_.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t* mark = patch(t, i);
      if (mark == nullptr) continue;
      const std::uint32_t other = neighbours_[t][i];
      contacts_.push_back({region_[t], other == kNoNeighbour ? other : region_[other], *mark});
    }
  }
  sort_unique(contacts_);
  names_.assign(regions, BodyId());
}

bool Namer::name(std::uint32_t region, BodyId body) {
  if (names_[region].valid()) return names_[region] == body;
  names_[region] = body;
  fresh_.push_back(region);
  return true;
}

bool Namer::spread() {
  for (const Contact& c : contacts_) {
    const auto& patch = complex_.patches[c.patch];
    if (patch.box_side >= 0 && !name(c.region, patch.back)) return false;
  }
  while (!fresh_.empty()) {
    const std::uint32_t region = fresh_.back();
    fresh_.pop_back();
    const auto first = std::lower_bound(contacts_.begin(), contacts_.end(), Contact{region, 0, 0});
    for (auto c = first; c != contacts_.end() && c->region == region; ++c) {
      const auto& patch = complex_.patches[c->patch];
      if (c->other == kNoNeighbour || patch.box_side >= 0) continue;
      const BodyId here = names_[region];
      if (here != patch.front && here != patch.back) return false;
      if (!name(c->other, here == patch.front ? patch.back : patch.front)) return false;
    }
  }
  return true;
}

}  // namespace

std::string name_regions(const PiecewiseLinearComplex& complex,
                         const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                         const std::vector<std::array<std::uint32_t, 3>>& marked,
                         const std::vector<std::uint32_t>& patches, std::vector<BodyId>& bodies) {
  Namer namer(complex, tetrahedra);
  namer.mark(marked, patches);
  namer.find_regions();
  if (!namer.spread()) return "lost a part of an interface: regions of different bodies are one";
  if (!namer.complete()) return "made a region that no interface bounds";
  bodies.resize(tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) bodies[t] = namer.body(t);
  return "";
}

}  // namespace adamas::interfaces
