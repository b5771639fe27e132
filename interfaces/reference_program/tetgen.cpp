#include <tetgen.h>

#include <chrono>
#include <new>
#include <string>

#include "interfaces/reference_program/answers.h"

namespace adamas::interfaces::reference {

namespace {

void fill(const MesherRequest& request, tetgenio& in) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(request.points.size());
  in.pointlist = new double[3 * request.points.size()];
  for (std::size_t i = 0; i < request.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      in.pointlist[3 * i + static_cast<std::size_t>(axis)] = request.points[i][axis];
  }
  in.numberoffacets = static_cast<int>(request.triangles.size());
  in.facetlist = new tetgenio::facet[request.triangles.size()];
  in.facetmarkerlist = new int[request.triangles.size()];
  for (std::size_t t = 0; t < request.triangles.size(); ++t) {
    tetgenio::facet& facet = in.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new int[3];
    for (std::size_t c = 0; c < 3; ++c)
      facet.polygonlist[0].vertexlist[c] = static_cast<int>(request.triangles[t][c]);
    // 0 is the marker of faces that lie on no facet.
    in.facetmarkerlist[t] = static_cast<int>(request.triangle_patches[t]) + 1;
  }
}

void take(const tetgenio& out, MesherReply& reply) {
  reply.points.resize(static_cast<std::size_t>(out.numberofpoints));
  for (std::size_t i = 0; i < reply.points.size(); ++i)
    reply.points[i] = {out.pointlist[3 * i], out.pointlist[3 * i + 1], out.pointlist[3 * i + 2]};
  reply.tetrahedra.resize(static_cast<std::size_t>(out.numberoftetrahedra));
  for (std::size_t t = 0; t < reply.tetrahedra.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c)
      reply.tetrahedra[t][c] = static_cast<std::uint32_t>(out.tetrahedronlist[4 * t + c]);
  }
  for (std::size_t f = 0; f < static_cast<std::size_t>(out.numberoftrifaces); ++f) {
    if (out.trifacemarkerlist[f] <= 0) continue;
    const int* corners = out.trifacelist + 3 * f;
    reply.triangles.push_back({static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[1]),
                               static_cast<std::uint32_t>(corners[2])});
    reply.triangle_patches.push_back(static_cast<std::uint32_t>(out.trifacemarkerlist[f] - 1));
  }
}

std::string failure_text(int code) {
  switch (code) {
    case 1:
      return "TetGen ran out of memory";
    case 3:
      return "TetGen found that triangles intersect";
    case 4:
      return "TetGen found a feature too small for it";
    case 5:
      return "TetGen found triangles too close to each other";
    case 10:
      return "TetGen found its input not sound";
    default:
      return "TetGen stopped with its code " + std::to_string(code);
  }
}

}  // namespace

MesherReply run_tetgen(const MesherRequest& request) {
  MesherReply reply;
  tetgenio in, out;
  fill(request, in);
  std::string switches = request.switches;
  const auto start = std::chrono::steady_clock::now();
  try {
    tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    reply.failure = failure_text(code);
  } catch (const std::bad_alloc&) {
    reply.failure = failure_text(1);
  }
  reply.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!reply.failure.empty()) return reply;
  if (request.kind == MesherKind::kTetGenDiagnosis) {
    // With the switch d TetGen returns the faces that intersect others.
    reply.failure = out.numberoftrifaces > 0 ? "TetGen finds " + std::to_string(out.numberoftrifaces) +
                                                   " triangles that intersect others"
                                             : "TetGen finds no triangles that intersect";
    return reply;
  }
  take(out, reply);
  if (reply.tetrahedra.empty()) reply.failure = "TetGen made no tetrahedra";
  return reply;
}

}  // namespace adamas::interfaces::reference
