#include "interfaces/resampling/shown_interfaces.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "interfaces/resampling/cell_evaluation.h"
#include "interfaces/resampling/nearby_comparison.h"

namespace adamas::interfaces {

namespace {

/// Cells of at most these sizes, relative to the target, are not split further: their faults would remain,
/// such as where the input's interfaces have an open border and the approximation closes the gap.
constexpr double kFinestForInput = 1e-3;
constexpr double kFinestForApproximation = 0.25;
constexpr double kFinestForShownJunctions = 0.0625;
/// Points are equal if they are this close, relative to the domain's diagonal.
constexpr double kRoundOff = 1e-14;
/// The number of leaves per task where what they show is put into buffers.
constexpr std::size_t kLeavesPerTask = 64;
/// The greatest number of corners of polygons that are in buffers at one time, but for those of one leaf.
constexpr std::size_t kCornersAtOnce = 1u << 16;

/// What it takes to put what leaves show into buffers and to weld it, per leaf and in relation to finding
/// what a leaf shows; and the part of it that comes before welding.
constexpr double kWeldingWork = 0.25, kBeforeWelding = 0.6;

/// The number of polygons that leaves show, and of their corners.
struct ContactCounts {
  std::size_t polygons = 0, corners = 0;
};

ContactCounts counts_of(const ResamplingState& state, std::span<const TetrahedronId> leaves) {
  ContactCounts counts;
  for (const TetrahedronId t : leaves) {
    const CellContacts& contacts = state.hierarchy.payload(t).contacts;
    counts.polygons += contacts.polygon_count();
    counts.corners += contacts.corner_count();
  }
  return counts;
}

}  // namespace

void ShownInterfaces::measure(bool each) {
  extract();
  measure_extracted(each);
}

void ShownInterfaces::measure_extracted(bool each) {
  // Which triangles are too far only matters if cells may be split for them.
  each = each || !state_.budget_spent;
  // How much of it has to be measured again after changes is not known before.
  const StageWork work =
      each && comparison_.knows_each()
          ? StageWork{}
          : StageWork{.items = comparison_.work_of_measuring(extracted_.mesh), .of_loops = false};
  const LoopProgress stage(state_.progress, state_.stage("measuring interfaces"), work);
  comparison_.measure(extracted_.mesh, state_.progress, each);
}

/// Calls visit(buffers) with what leaves show, in their order, for some of them after others.
void ShownInterfaces::for_each_batch(const std::vector<TetrahedronId>& leaves,
                                     const std::function<void(std::span<const ContactBuffer>)>& visit) const {
  std::vector<ContactBuffer> buffers;
  for (std::size_t first = 0, last = 0; first < leaves.size(); first = last) {
    for (std::size_t corners = 0; last < leaves.size() && corners <= kCornersAtOnce; ++last)
      corners += state_.hierarchy.payload(leaves[last]).contacts.corner_count();
    buffers.resize((last - first + kLeavesPerTask - 1) / kLeavesPerTask);
    parallel_chunks(last - first, kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      ContactBuffer& buffer = buffers[begin / kLeavesPerTask];
      buffer.clear();
      const auto [polygons, corners] =
          counts_of(state_, std::span(leaves).subspan(first + begin, end - begin));
      buffer.reserve(polygons, corners);
      for (std::size_t i = begin; i < end; ++i) state_.add_contacts(leaves[first + i], buffer);
    });
    visit(buffers);
  }
}

/// Returns a builder with what these leaves show.
ContactMeshBuilder ShownInterfaces::builder_for(const std::vector<TetrahedronId>& leaves) const {
  ContactMeshBuilder builder(kWeldTolerance * state_.source.box.diagonal());
  const auto [polygons, corners] = counts_of(state_, leaves);
  builder.reserve(polygons, corners);
  for_each_batch(leaves, [&](std::span<const ContactBuffer> buffers) {
    std::vector<const ContactBuffer*> contacts;
    for (const ContactBuffer& buffer : buffers) contacts.push_back(&buffer);
    builder.append(contacts);
  });
  return builder;
}

/// Only leaves that are new or have changed are computed.
ExtractedInterfaces ShownInterfaces::extract() {
  const std::vector<TetrahedronId> leaves = state_.leaves();
  const auto all = static_cast<double>(leaves.size());
  const auto unknown = static_cast<double>(std::ranges::count_if(
      leaves, [&](TetrahedronId t) { return !state_.hierarchy.payload(t).has_contacts; }));
  const double found = unknown / (unknown + kWeldingWork * all);
  const LoopProgress stage(state_.progress, state_.stage("extracting interfaces"));
  LoopProgress::begin_part(found, all);
  find_contacts(state_, leaves);
  LoopProgress::begin_part(found + kBeforeWelding * (1 - found), all);
  ContactMeshBuilder builder = builder_for(leaves);
  ++number_;
  return std::exchange(extracted_,
                       finish_extraction(state_.source.network->table(), builder, state_.options.conserve));
}

void ShownInterfaces::go_back(ExtractedInterfaces extracted) {
  extracted_ = std::move(extracted);
  ++number_;
}

void ShownInterfaces::go_back(Measured measured) {
  comparison_ = std::move(measured.comparison);
  go_back(std::move(measured.extracted));
}

void ShownInterfaces::measure_moved(const Measured& before) {
  const LoopProgress stage(state_.progress, state_.stage("measuring interfaces"));
  extracted_ = before.extracted;
  std::vector<Vec3>& points = extracted_.mesh.points;
  DigestNumbers numbers;
  numbers.add(extracted_.keys);
  struct Place {
    std::uint32_t number;
    Vec3 position;
  };
  // The same point has the same position in all leaves, up to round-off.
  const double least = kRoundOff * state_.source.box.diagonal();
  for_each_batch(state_.leaves(), [&](std::span<const ContactBuffer> buffers) {
    const auto places = parallel_collect<Place>(
        buffers.size(), 1, [&](std::size_t begin, std::size_t end, std::vector<Place>& list) {
          for (std::size_t b = begin; b < end; ++b) {
            buffers[b].for_each_polygon([&](auto, auto, std::span<const ContactBuffer::Corner> corners) {
              for (const auto& corner : corners) {
                if (const auto number = numbers.find(corner.key)) list.push_back({*number, corner.position});
              }
            });
          }
        });
    for (const auto& [number, position] : places) {
      if (distance(points[number], position) > least) points[number] = position;
    }
  });
  ++number_;
  comparison_ = before.comparison;
  comparison_.measure_moved(extracted_.mesh, state_.progress);
}

void ShownInterfaces::measure_after_moves() {
  const ExtractedInterfaces before = extract();
  const LoopProgress stage(state_.progress, state_.stage("measuring interfaces"));
  DigestNumbers numbers;
  numbers.add(before.keys);
  std::vector<std::uint32_t> points_before;
  points_before.reserve(extracted_.keys.size());
  for (const ContactBuffer::Key& key : extracted_.keys)
    points_before.push_back(numbers.find(key).value_or(InterfaceComparison::kNoPoint));
  comparison_.measure_moved(extracted_.mesh, points_before, state_.progress);
}

InterfaceCertificate ShownInterfaces::finish() {
  const LoopProgress stage(state_.progress, state_.stage("certifying distances"));
  return comparison_.finish(state_.progress);
}

std::vector<TetrahedronId> ShownInterfaces::failing_leaves() const {
  state_.report("finding cells to split");
  const double target = state_.options.interface_error;
  std::vector<TetrahedronId> result = leaves_with_far_input();
  for (const std::uint32_t t : comparison_.far_shown())
    state_.add_leaf_at(extracted_.mesh.centroid(t), kFinestForApproximation * target, result);
  const auto& [input, shown] = comparison_.far_junctions();
  for (const Vec3& p : input) state_.add_leaf_at(p, kFinestForInput * target, result);
  for (const Vec3& p : shown) state_.add_leaf_at(p, kFinestForShownJunctions * target, result);
  return result;
}

/// Returns leaves with points of a material's boundary in the input that are too far from the shown boundary.
std::vector<TetrahedronId> ShownInterfaces::leaves_with_far_input() const {
  const std::vector<TetrahedronId> all = state_.leaves();
  std::vector<char> bad(all.size(), 0);
  std::vector<std::atomic<bool>> explained(state_.source.network->triangles().size());
  parallel_for(all.size(), 256, [&](std::size_t i) {
    for (const std::uint32_t t : state_.hierarchy.payload(all[i]).triangles) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (!comparison_.too_far(t, side) || !comparison_.has_far_point(t, side, state_.frame(all[i])))
          continue;
        bad[i] = 1;
        explained[t] = true;
      }
    }
  });
  // If a triangle is too far only between the points that were checked, all of its cells are taken.
  parallel_for(all.size(), 256, [&](std::size_t i) {
    for (const std::uint32_t t : state_.hierarchy.payload(all[i]).triangles) {
      if ((comparison_.too_far(t, 0) || comparison_.too_far(t, 1)) && !explained[t]) bad[i] = 1;
    }
  });
  std::vector<TetrahedronId> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (bad[i] != 0 && state_.frame(all[i]).diameter() > kFinestForInput * state_.options.interface_error)
      result.push_back(all[i]);
  }
  return result;
}

/// Extracts what is shown within the target of these leaves.
InterfaceMesh ShownInterfaces::extract_near(const std::vector<TetrahedronId>& leaves) const {
  const std::vector<TetrahedronId> near = state_.leaves_near(leaves, comparison_.target());
  find_contacts(state_, near);
  ContactMeshBuilder builder = builder_for(near);
  return finish_extraction(state_.source.network->table(), builder).mesh;
}

/// Adds those of these leaves that show points that are too far from the input's interfaces.
void ShownInterfaces::add_leaves_with_far_shown(const std::vector<TetrahedronId>& among,
                                                std::vector<TetrahedronId>& failing) const {
  const InterfaceTable& table = state_.source.network->table();
  InterfaceMesh triangles;
  std::vector<TetrahedronId> leaf_of;
  ContactBuffer shown;
  for (const TetrahedronId t : among) {
    shown.clear();
    state_.add_contacts(t, shown);
    shown.for_each_polygon([&](auto front, auto back, std::span<const ContactBuffer::Corner> corners) {
      const auto first = static_cast<std::uint32_t>(triangles.points.size());
      for (const ContactBuffer::Corner& corner : corners) triangles.points.push_back(corner.position);
      for (std::uint32_t c = 2; c < corners.size(); ++c) {
        triangles.triangles.push_back(
            {{first, first + c - 1, first + c}, table.material(BodyId(front)), table.material(BodyId(back))});
        leaf_of.push_back(t);
      }
    });
  }
  const double finest = kFinestForApproximation * state_.options.interface_error;
  for (const std::uint32_t t : comparison_.far_among(triangles, state_.progress)) {
    if (state_.frame(leaf_of[t]).diameter() > finest) failing.push_back(leaf_of[t]);
  }
}

std::vector<TetrahedronId> ShownInterfaces::failing_among(const std::vector<TetrahedronId>& leaves) const {
  state_.report("measuring new cells");
  const double target = state_.options.interface_error;
  const NearbyComparison nearby(comparison_, extract_near(leaves));
  struct Far {
    bool input = false;
    std::vector<Vec3> input_junctions, shown_junctions;
  };
  std::vector<Far> far(leaves.size());
  parallel_for(leaves.size(), 16, [&](std::size_t i) {
    const Tetrahedron cell = state_.frame(leaves[i]);
    far[i].input = cell.diameter() > kFinestForInput * target &&
                   std::ranges::any_of(state_.hierarchy.payload(leaves[i]).triangles,
                                       [&](std::uint32_t t) { return nearby.has_far_point(t, cell); });
    const Box3 box = state_.box(leaves[i]);
    far[i].input_junctions = nearby.far_input_junctions(box);
    far[i].shown_junctions = nearby.far_shown_junctions(box);
  });
  std::vector<TetrahedronId> failing;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (far[i].input) failing.push_back(leaves[i]);
    for (const Vec3& p : far[i].input_junctions) state_.add_leaf_at(p, kFinestForInput * target, failing);
    for (const Vec3& p : far[i].shown_junctions)
      state_.add_leaf_at(p, kFinestForShownJunctions * target, failing);
  }
  add_leaves_with_far_shown(leaves, failing);
  return failing;
}

}  // namespace adamas::interfaces
