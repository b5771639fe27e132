#include "core/data/contact_buffer.h"

#include <algorithm>

#include "core/data/cell_contacts.h"

namespace adamas::inline core {

std::array<std::size_t, 4> ContactBuffer::ascending(const std::array<std::uint64_t, 4>& ids) {
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return ids[a] < ids[b]; });
  return order;
}

ContactBuffer::Key ContactBuffer::digest(const std::array<std::uint64_t, 4>& ids, std::uint8_t zeros,
                                         std::span<const std::uint64_t> functions) {
  Key result;
  for (std::size_t i = 0; i < 4; ++i) {
    if ((zeros >> i & 1u) == 0) result.take(ids[i]);
  }
  result.take(kNoFunction);
  for (const std::uint64_t function : functions) {
    if (function != kNoFunction) result.take(function);
  }
  return result;
}

void ContactBuffer::add(const std::array<std::uint64_t, 4>& vertex_ids, const std::array<Vec3, 4>& positions,
                        const OwnershipProblem& problem) {
  if (problem.candidates.size() < 2) return;
  const std::array<std::size_t, 4> order = ascending(vertex_ids);
  std::array<std::uint64_t, 4> ids;
  std::array<Vec3, 4> places;
  if (problem.candidates.size() == 2 && problem.functions.size() == 2) {
    std::array<LinearFunction, 2> functions{problem.functions[0], problem.functions[1]};
    for (std::size_t i = 0; i < 4; ++i) {
      ids[i] = vertex_ids[order[i]];
      places[i] = positions[order[i]];
      for (std::size_t f = 0; f < 2; ++f) functions[f].values[i] = problem.functions[f].values[order[i]];
    }
    return add_between(ids, places, functions, {problem.candidates[0].owner, problem.candidates[1].owner});
  }
  OwnershipProblem sorted = problem;
  for (std::size_t i = 0; i < 4; ++i) {
    ids[i] = vertex_ids[order[i]];
    places[i] = positions[order[i]];
    for (std::size_t f = 0; f < problem.functions.size(); ++f) {
      sorted.functions[f].values[i] = problem.functions[f].values[order[i]];
    }
  }
  std::vector<ContactPolygon> contacts;
  contact_polygons(sorted, contacts);
  CellContacts(ids, places, sorted, contacts).add_to(*this, ids, places);
}

void ContactBuffer::add_between(const std::array<std::uint64_t, 4>& ids, const std::array<Vec3, 4>& positions,
                                const std::array<LinearFunction, 2>& functions,
                                const std::array<std::uint32_t, 2>& owners) {
  const TetrahedronSection section = section_between(functions[0], functions[1]);
  const std::size_t count = section.count;
  if (count == 0) return;
  polygons_.push_back(
      {owners[0], owners[1], static_cast<std::uint32_t>(corners_.size()), static_cast<std::uint32_t>(count)});
  const std::array<std::uint64_t, 2> keys{std::min(functions[0].key, functions[1].key),
                                          std::max(functions[0].key, functions[1].key)};
  const bool mirrored = signed_volume(positions[0], positions[1], positions[2], positions[3]) < 0;
  for (std::size_t i = 0; i < count; ++i) {
    const TetrahedronSection::Corner& corner = section.corners[mirrored ? count - 1 - i : i];
    const std::uint8_t face = section.corners[mirrored ? (2 * count - 2 - i) % count : i].face;
    Corner& result = corners_.emplace_back();
    result.key = digest(ids, corner.zero_weights(), keys);
    result.leaving = digest(ids, static_cast<std::uint8_t>(1u << face), keys);
    const double low = 1 - corner.t;
    result.position = Vec3{} + low * positions[corner.low];
    result.position += corner.t * positions[corner.high];
    result.crowded = low < kSmallWeight || corner.t < kSmallWeight;
  }
}

bool ContactBuffer::has_polygons_of(const ContactBuffer& other) const {
  const auto same_corner = [](const Corner& a, const Corner& b) {
    return a.key == b.key && a.leaving == b.leaving;
  };
  const auto same_polygon = [](const Polygon& a, const Polygon& b) {
    return a.front == b.front && a.back == b.back && a.count == b.count;
  };
  return std::ranges::equal(corners_, other.corners_, same_corner) &&
         std::ranges::equal(polygons_, other.polygons_, same_polygon);
}

}  // namespace adamas::inline core
