// Smooths the interface between two materials with OpenMesh, of which adamas itself needs only headers for
// this.

#include <adamas/openmesh.h>

#include <OpenMesh/Tools/Smoother/JacobiLaplaceSmootherT.hh>
#include <cmath>
#include <cstdio>

namespace {

/// Returns a square of the plane z = 0 between air, above, and water, with a bump in its middle.
adamas::InterfaceTriangles bumpy_square() {
  adamas::InterfaceTriangles square;
  square.materials = {"air", "water"};
  constexpr std::uint32_t kSide = 9;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i)
      square.points.push_back({i * 1.0, j * 1.0, i == kSide / 2 && j == kSide / 2 ? 1.0 : 0.0});
  }
  for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
      const std::uint32_t p = i + kSide * j;
      square.triangles.push_back({p, p + 1, p + kSide + 1});
      square.triangles.push_back({p, p + kSide + 1, p + kSide});
    }
  }
  square.sides.assign(square.triangles.size(), {0, 1});
  return square;
}

double greatest_height(const adamas::InterfaceTriangles& interfaces) {
  double height = 0;
  for (const adamas::Vec3& p : interfaces.points) height = std::max(height, std::abs(p.z));
  return height;
}

}  // namespace

int main() {
  const adamas::InterfaceTriangles interfaces = bumpy_square();

  // One mesh for each pair of bodies, or of materials where bodies are not known; normals point to `front`.
  // Lines where three of them meet are borders, which the smoother leaves where they are.
  auto meshes = adamas::to_openmesh(interfaces);
  for (auto& [front, back, bodies, mesh, vertex_origin, face_origin] : meshes) {
    std::printf("%s on %s: %zu faces\n", interfaces.materials[front].c_str(),
                interfaces.materials[back].c_str(), mesh.n_faces());
    using Smoother = OpenMesh::Smoother::JacobiLaplaceSmootherT<adamas::OpenMeshSurface>;
    mesh.request_face_normals(), mesh.request_vertex_normals();
    mesh.request_vertex_status();
    mesh.update_normals();
    Smoother smoother(mesh);
    smoother.initialize(Smoother::Tangential_and_Normal, Smoother::C0);
    smoother.smooth(5);
  }
  const adamas::InterfaceTriangles smooth = adamas::from_openmesh(meshes, interfaces.materials);

  std::printf("greatest height %.3f, before %.3f\n", greatest_height(smooth), greatest_height(interfaces));
  const bool same = smooth.triangles == interfaces.triangles && smooth.sides == interfaces.sides;
  return same && greatest_height(smooth) < 0.5 * greatest_height(interfaces) ? 0 : 1;
}
