#include "interfaces/mesh/interface_extraction.h"

#include "core/base/parallel.h"

namespace adamas::interfaces {

namespace {
constexpr std::size_t kChunk = 2048;
/// The number of cells per task; it is small because a cell with many bodies takes long.
constexpr std::size_t kExtractionChunk = 32;
}  // namespace

ExtractedInterfaces extract_interfaces(const InterfaceTable& table, const CellSet& cells, const Box3& domain,
                                       Progress& progress) {
  ContactMeshBuilder builder(kWeldTolerance * domain.diagonal());
  constexpr std::size_t kBatch = 1024;
  for (std::size_t begin = 0; begin < cells.count; begin += kBatch * kExtractionChunk) {
    progress.step("extracting interfaces", static_cast<double>(begin) / static_cast<double>(cells.count));
    std::vector<ContactBuffer> buffers(kBatch);
    std::vector<const ContactBuffer*> found;
    const std::size_t count = std::min(kBatch * kExtractionChunk, cells.count - begin);
    parallel_chunks(count, kExtractionChunk, [&](std::size_t first, std::size_t last) {
      CellOwnership ownership;
      for (std::size_t i = first; i < last; ++i) {
        const auto vertices = cells.corners(begin + i);
        cells.ownership(table, vertices, ownership);
        if (ownership.pure()) continue;
        keep_owners(ownership.problem);
        buffers[first / kExtractionChunk].add({vertices[0], vertices[1], vertices[2], vertices[3]},
                                              cells.positions(vertices), ownership.problem);
      }
    });
    for (const ContactBuffer& buffer : buffers) found.push_back(&buffer);
    builder.append(found);
  }
  return finish_extraction(table, builder);
}

ExtractedInterfaces finish_extraction(const InterfaceTable& table, ContactMeshBuilder& builder,
                                      bool with_keys) {
  ExtractedInterfaces result;
  result.mesh = builder.finish(with_keys ? &result.keys : nullptr);
  result.bodies.reserve(result.mesh.triangles.size());
  for (InterfaceTriangle& t : result.mesh.triangles) {
    result.bodies.push_back({BodyId(t.front.value), BodyId(t.back.value)});
    t.front = table.material(result.bodies.back()[0]);
    t.back = table.material(result.bodies.back()[1]);
  }
  return result;
}

std::vector<std::pair<BodyId, double>> owned_volumes(const InterfaceTable& table, const CellSet& cells) {
  using Sum = std::pair<BodyId, double>;
  return parallel_collect<Sum>(cells.count, kChunk, [&](std::size_t first, std::size_t last, auto& sums) {
    CellOwnership ownership;
    std::vector<OwnedTetrahedron> parts;
    const auto add = [&](BodyId body, double volume) {
      if (!sums.empty() && sums.back().first == body) {
        sums.back().second += volume;
      } else {
        sums.emplace_back(body, volume);
      }
    };
    for (std::size_t i = first; i < last; ++i) {
      const auto vertices = cells.corners(i);
      const auto x = cells.positions(vertices);
      const double volume = signed_volume(x[0], x[1], x[2], x[3]);
      cells.ownership(table, vertices, ownership);
      partition_cell(ownership, parts);
      for (const OwnedTetrahedron& part : parts)
        add(BodyId(part.owner), volume * volume_fraction(part.corners));
    }
  });
}

IdVector<BodyId, double> body_volumes(const InterfaceTable& table, const CellSet& cells) {
  IdVector<BodyId, double> volumes(table.body_count(), 0.0);
  for (const auto& [body, volume] : owned_volumes(table, cells)) volumes[body] += volume;
  // Volumes may be negative by round-off if a body owns nearly nothing.
  for (double& volume : volumes) volume = std::max(volume, 0.0);
  return volumes;
}

IdVector<MaterialId, double> material_volumes(const InterfaceTable& table, const CellSet& cells,
                                              std::size_t materials) {
  IdVector<MaterialId, double> volumes(materials, 0.0);
  const auto bodies = body_volumes(table, cells);
  for (BodyId b(0); b.value < bodies.size(); ++b.value) volumes[table.material(b)] += bodies[b];
  return volumes;
}

std::vector<char> cells_with_interfaces(const InterfaceTable& table, const CellSet& cells,
                                        const Progress& progress) {
  std::vector<char> result(cells.count, 0);
  parallel_chunks(cells.count, kChunk, [&](std::size_t begin, std::size_t end) {
    progress.check();
    CellOwnership ownership;
    std::vector<ContactPolygon> contacts;
    for (std::size_t i = begin; i < end; ++i) {
      cells.ownership(table, cells.corners(i), ownership);
      if (ownership.pure()) continue;
      contacts.clear();
      keep_owners(ownership.problem, contacts);
      result[i] = contacts.empty() ? 0 : 1;
    }
  });
  return result;
}

}  // namespace adamas::interfaces
