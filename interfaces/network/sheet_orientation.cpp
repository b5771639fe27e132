#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "interfaces/network/edge_fans.h"
#include "interfaces/network/mending.h"

namespace adamas::interfaces {

namespace {

constexpr double kTieAngle = 1e-3;  // below, the order of the blades round an edge is not certain
/// The greater part of a sheet is right where it has at least so many times the triangles of the other.
constexpr std::size_t kClearMajority = 3;

/// Disjoint sets of triangles whose orientations are known in relation to each other.
class Sheets {
 public:
  explicit Sheets(std::size_t count) : parent_(count), turned_(count, 0), torn_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  struct Place {
    std::uint32_t sheet;  ///< the set's first triangle
    bool turned;          ///< against that triangle
  };
  Place find(std::uint32_t triangle) {
    bool turned = false;
    std::uint32_t root = triangle;
    for (; parent_[root] != root; root = parent_[root]) turned ^= turned_[root] != 0;
    // Path compression.
    bool rest = turned;
    while (parent_[triangle] != root && triangle != root) {
      const std::uint32_t next = parent_[triangle];
      const bool step = turned_[triangle] != 0;
      parent_[triangle] = root;
      turned_[triangle] = rest ? 1 : 0;
      rest ^= step;
      triangle = next;
    }
    return {root, turned};
  }
  void join(std::uint32_t a, std::uint32_t b, bool turned) {
    const Place x = find(a), y = find(b);
    const bool between = x.turned ^ y.turned ^ turned;
    if (x.sheet == y.sheet) {
      if (between) torn_[x.sheet] = 1;
      return;
    }
    const std::uint32_t low = std::min(x.sheet, y.sheet), high = std::max(x.sheet, y.sheet);
    parent_[high] = low;
    turned_[high] = between ? 1 : 0;
    torn_[low] = torn_[low] != 0 || torn_[high] != 0;
  }
  /// Whether the orientations within a sheet contradict each other, as on a Moebius strip.
  [[nodiscard]] bool torn(std::uint32_t sheet) const { return torn_[sheet] != 0; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<char> turned_, torn_;
};

/// Which blades have to be turned for the materials to match, in the one way or two that there are.
struct FanOrientations {
  std::size_t ways = 0;
  std::array<std::vector<bool>, 2> turned;
};

bool order_is_certain(const EdgeFans::Fan& fan) {
  const std::size_t n = fan.blades.size();
  if (n == 2) return true;
  for (std::size_t i = 0; i < n; ++i) {
    const double apart = std::abs(fan.blades[i].angle - fan.blades[(i + 1) % n].angle);
    if (fan.blades[i].flat || apart < kTieAngle || 2 * M_PI - apart < kTieAngle) return false;
  }
  return true;
}

FanOrientations orientations(const EdgeFans& fans, const EdgeFans::Fan& fan) {
  FanOrientations result;
  const std::size_t n = fan.blades.size();
  if (n < 2 || !order_is_certain(fan)) return result;
  const bool open = fan.outside_wedge != EdgeFans::Fan::kNone;
  const std::size_t first = open ? (fan.outside_wedge + 1) % n : 0;
  const Blade& start = fan.blades[first];
  for (const bool turn : {false, true}) {
    std::vector<bool>& turned = result.turned[result.ways];
    turned.assign(n, false);
    turned[first] = turn;
    const auto side = [&](const Blade& b, int s) { return fans.material(b.triangle, s); };
    const int behind = EdgeFans::side_behind(start), ahead = EdgeFans::side_ahead(start);
    const MaterialId before = side(start, turn ? ahead : behind);
    MaterialId material = side(start, turn ? behind : ahead);
    bool fits = true;
    for (std::size_t k = 1; k < n && fits; ++k) {
      const std::size_t i = (first + k) % n;
      const Blade& b = fan.blades[i];
      const MaterialId near = side(b, EdgeFans::side_behind(b)), far = side(b, EdgeFans::side_ahead(b));
      fits = material == near || material == far;
      turned[i] = material != near;
      material = turned[i] ? near : far;
    }
    if (fits && (open || material == before)) ++result.ways;
  }
  return result;
}

/// How many triangles of a sheet are turned as its first one is (0), and against it (1).
struct Tally {
  std::array<std::size_t, 2> triangles{}, votes{};  ///< votes: edges that call these triangles right
};

/// Finds which triangles to turn.
std::vector<char> find_turned(const InterfaceMesh& mesh, const EdgeFans& fans, Sheets& sheets) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  EdgeFans::Fan fan;
  std::vector<std::pair<std::uint32_t, bool>> votes;  // a triangle, and whether it is turned wrongly
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    if (fans.valence(edge) < 2) continue;
    fans.fan(edge, fan);
    const FanOrientations found = orientations(fans, fan);
    if (found.ways == 0) continue;
    for (std::size_t i = 0; i < fan.blades.size(); ++i) {
      const std::uint32_t t = fan.blades[i].triangle;
      const bool turned = found.turned[0][i];
      if (found.ways == 1) votes.emplace_back(t, turned);
      if (found.ways == 2) sheets.join(fan.blades[0].triangle, t, found.turned[0][0] != turned);
    }
  }
  std::vector<Tally> tallies(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [sheet, turned] = sheets.find(t);
    ++tallies[sheet].triangles[turned ? 1 : 0];
  }
  for (const auto& [t, wrong] : votes) {
    const auto [sheet, turned] = sheets.find(t);
    ++tallies[sheet].votes[turned != wrong ? 1 : 0];
  }
  std::vector<char> turn(count, 0);
  for (std::uint32_t t = 0; t < count; ++t) {
    const auto [sheet, turned] = sheets.find(t);
    const Tally& of = tallies[sheet];
    const bool voted = of.votes[0] + of.votes[1] > 0;
    const auto& decisive = voted ? of.votes : of.triangles;
    const std::size_t most = std::max(decisive[0], decisive[1]), least = std::min(decisive[0], decisive[1]);
    if (sheets.torn(sheet) || (voted ? least > 0 : most < kClearMajority * least)) continue;
    turn[t] = turned != (decisive[1] > decisive[0]) ? 1 : 0;
  }
  return turn;
}

void turn_over(InterfaceTriangle& t) { std::swap(t.points[1], t.points[2]); }

/// Takes back the turning of sheets with an edge that still does not match, until none is left.
void take_back(InterfaceMesh& mesh, const Box3* domain, Sheets& sheets, std::vector<char>& turn) {
  for (bool again = true; again;) {
    again = false;
    const EdgeFans fans(mesh, domain);
    EdgeFans::Fan fan;
    std::vector<char> bad(mesh.triangles.size(), 0);
    for (std::size_t edge = 0; edge < fans.size(); ++edge) {
      fans.fan(edge, fan);
      if (fan.consistent) continue;
      for (const Blade& b : fan.blades) bad[sheets.find(b.triangle).sheet] = 1;
    }
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (turn[t] == 0 || bad[sheets.find(t).sheet] == 0) continue;
      turn_over(mesh.triangles[t]);
      turn[t] = 0;
      again = true;
    }
  }
}

bool matches_everywhere(const EdgeFans& fans) {
  EdgeFans::Fan fan;
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    fans.fan(edge, fan);
    if (!fan.consistent) return false;
  }
  return true;
}

}  // namespace

Mended turn_wrong_triangles(InterfaceMesh& mesh, const Box3* domain) {
  Sheets sheets(mesh.triangles.size());
  std::vector<char> turn;
  {
    const EdgeFans fans(mesh, domain);
    if (matches_everywhere(fans)) return {};
    turn = find_turned(mesh, fans, sheets);
  }
  for (std::size_t t = 0; t < turn.size(); ++t) {
    if (turn[t] != 0) turn_over(mesh.triangles[t]);
  }
  take_back(mesh, domain, sheets, turn);
  Mended result;
  for (std::size_t t = 0; t < turn.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    if (turn[t] != 0) result.add((1.0 / 3) * (mesh.points[p[0]] + mesh.points[p[1]] + mesh.points[p[2]]));
  }
  return result;
}

}  // namespace adamas::interfaces
