#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "interfaces/reference/mesher_messages.h"

namespace adamas::interfaces::reference {

/// The complex with its triangles' patches as markers, by TetGen with the request's switches. Failures that
/// the library tells are the reply's; others end the process.
MesherReply run_tetgen(const MesherRequest& request);

/// The patches as surfaces of a polyhedral complex, their borders protected, by CGAL's Mesh_3.
MesherReply run_mesh3(const MesherRequest& request);

/// The image as CGAL's labelled domain, by Mesh_3. It protects nothing.
MesherReply run_mesh3_labels(const MesherRequest& request);

/// Appends the tetrahedra of a complex that Mesh_3 has made, and their regions, to a reply.
template <class Complex>
void take_complex(const Complex& complex, MesherReply& reply) {
  std::unordered_map<typename Complex::Vertex_handle, std::uint32_t> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    std::array<std::uint32_t, 4> corners;
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [entry, fresh] = number.try_emplace(vertex, static_cast<std::uint32_t>(reply.points.size()));
      if (fresh) {
        const auto& p = vertex->point().point();
        reply.points.push_back({p.x(), p.y(), p.z()});
      }
      corners[static_cast<std::size_t>(i)] = entry->second;
    }
    reply.tetrahedra.push_back(corners);
    reply.regions.push_back(static_cast<std::uint32_t>(complex.subdomain_index(cell)));
  }
}

}  // namespace adamas::interfaces::reference
