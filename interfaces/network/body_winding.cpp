#include "interfaces/network/body_winding.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "core/base/parallel.h"
#include "interfaces/network/domain_faces.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

namespace {

/// The number of triangles at which the bodies' parts of the sphere at infinity are measured.
constexpr std::size_t kSamples = 64;
/// The distance of the measured points from these triangles, relative to the root of their area.
constexpr double kInFront = 1e-3;
/// If no interface reaches the domain's boundary, a body with at least this part of the sphere at infinity
/// has all of it.
constexpr double kSurrounds = 0.75;

}  // namespace

BodyWinding::BodyWinding(const InterfaceNetwork& network, const std::optional<Box3>& domain)
    : table_(network.table()) {
  trees_.resize(table_.interface_count());
  parallel_for(trees_.size(), 1, [&](std::size_t i) {
    const auto& interface = network.interface(InterfaceId(i));
    trees_[InterfaceId(i)] =
        WindingTree(network.points(), network.triangles().subspan(interface.first, interface.count));
  });
  if (domain) find_strips(network, *domain);
  find_offsets(network, domain);
}

void BodyWinding::find_strips(const InterfaceNetwork& network, const Box3& domain) {
  center_ = domain.center();
  // Edges with triangles of an interface in both directions are not on its border.
  std::map<std::tuple<InterfaceId, std::uint32_t, std::uint32_t>, int> edges;
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& v = network.triangles()[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = v[i], b = v[(i + 1) % 3];
      if (is_inside_domain(domain, 0.5 * (network.points()[a] + network.points()[b]))) continue;
      edges[{network.interface_of(t), std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto [interface, low, high] = edge;
    const Vec3 &a = network.points()[low], &b = network.points()[high];
    for (int i = 0; i < std::abs(count); ++i)
      strips_.push_back(count > 0 ? Strip{interface, a, b} : Strip{interface, b, a});
  }
}

/// Finds the part of the sphere at infinity that belongs to each body. Beside a triangle the body is known,
/// and the difference between its winding number and the sum of angles is that part. If there are gaps, the
/// samples differ, and their median is taken.
void BodyWinding::find_offsets(const InterfaceNetwork& network, const std::optional<Box3>& domain) {
  struct Sample {
    double area;
    std::array<double, 3> place;
    std::uint32_t triangle;
  };
  std::vector<Sample> samples;
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& c = network.triangle_corners(t);
    const Vec3 middle = (1.0 / 3) * (c[0] + c[1] + c[2]);
    if (domain && !domain->contains(middle)) continue;
    samples.push_back({0.5 * norm(cross(c[1] - c[0], c[2] - c[0])), {middle.x, middle.y, middle.z}, t});
  }
  const std::size_t count = std::min(samples.size(), kSamples);
  std::partial_sort(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count), samples.end(),
                    [](const Sample& a, const Sample& b) {
                      return std::tie(b.area, a.place, a.triangle) < std::tie(a.area, b.place, b.triangle);
                    });
  const std::size_t bodies = table_.body_count();
  offsets_.assign(bodies, 0.0);
  if (count == 0) return;
  IdVector<BodyId, std::vector<double>> left(bodies);
  IdVector<BodyId, double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    const Sample& s = samples[i];
    const Vec3 middle{s.place[0], s.place[1], s.place[2]};
    sum_angles(middle + kInFront * std::sqrt(s.area) * network.normal(s.triangle), numbers);
    numbers[network.interface(network.interface_of(s.triangle)).a] -= 1;
    for (BodyId b(0); b.value < bodies; ++b.value) left[b].push_back(-numbers[b]);
  }
  BodyId greatest(0);
  for (BodyId b(0); b.value < bodies; ++b.value) {
    std::vector<double>& values = left[b];
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    offsets_[b] = *middle;
    if (offsets_[b] > offsets_[greatest]) greatest = b;
  }
  if (!strips_.empty() || offsets_[greatest] < kSurrounds) return;
  offsets_.assign(bodies, 0.0);
  offsets_[greatest] = 1;
}

void BodyWinding::sum_angles(const Vec3& p, IdVector<BodyId, double>& numbers) const {
  numbers.assign(table_.body_count(), 0.0);
  const auto add = [&](InterfaceId i, double behind) {
    const auto& [front, back] = table_.sides(i);
    numbers[front] -= behind;
    numbers[back] += behind;
  };
  for (InterfaceId i(0); i.value < trees_.size(); ++i.value) add(i, trees_[i].at(p));
  for (const Strip& s : strips_) {
    const Vec3 from = s.from - p, to = s.to - p;
    const Vec3 from_infinity = s.from - center_, to_infinity = s.to - center_;
    add(s.interface,
        (solid_angle(to, from, from_infinity) + solid_angle(to, from_infinity, to_infinity)) / (4 * M_PI));
  }
}

void BodyWinding::numbers_at(const Vec3& p, IdVector<BodyId, double>& numbers) const {
  sum_angles(p, numbers);
  for (BodyId b(0); b.value < numbers.size(); ++b.value) numbers[b] += offsets_[b];
}

BodyWinding::Answer BodyWinding::at(const Vec3& p) const {
  thread_local IdVector<BodyId, double> numbers;
  numbers_at(p, numbers);
  // Bodies are in the order of their materials.
  Answer best{BodyId(0), -std::numeric_limits<double>::infinity()};
  for (BodyId b(0); b.value < numbers.size();) {
    const MaterialId material = table_.material(b);
    BodyId greatest = b;
    double sum = 0;
    for (; b.value < numbers.size() && table_.material(b) == material; ++b.value) {
      sum += numbers[b];
      if (numbers[b] > numbers[greatest]) greatest = b;
    }
    if (sum > best.number) best = {greatest, sum};
  }
  return best;
}

}  // namespace adamas::interfaces
